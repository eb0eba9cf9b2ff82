"""The problems of the bench: what goes in, what comes out, and which scene of ours solves it."""

from dataclasses import dataclass, replace

AXES = ("x", "y", "z")
TENSOR = ("I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")


def along(name: str) -> tuple[str, ...]:
    """Return the names of a vector's components.

    >>> along("omega")
    ('omega_x', 'omega_y', 'omega_z')
    """
    return tuple(f"{name}_{axis}" for axis in AXES)


OMEGA, MOMENT, FORCE = along("omega"), along("moment"), along("force")
POSITION, VELOCITY = along("position"), along("velocity")
ATTITUDE = ("attitude_w", *along("attitude"))
ANGLES, WHEEL_SPEEDS = ("phi", "theta", "psi"), ("s_1", "s_2", "s_3")
RIGID_STATE = POSITION + ATTITUDE + VELOCITY + OMEGA
OMEGA_DOT = along("omega_dot")
RIGID_RATE = (
    *along("position_rate"),
    *("attitude_rate_w", *along("attitude_rate")),
    *along("velocity_rate"),
    *OMEGA_DOT,
)
RATE_OF = dict(zip(RIGID_STATE, RIGID_RATE, strict=True))


@dataclass(frozen=True)
class Block:
    """Outputs whose error is taken together, as the norm of one vector."""

    name: str
    places: tuple[int, ...]


@dataclass(frozen=True)
class Problem:
    """One function that every tool is asked for.

    scene, function : where ours stands in ``generated/``
    outputs : components in order; a Jacobian follows as ``pattern``, in compressed-column order
    """

    name: str
    says: str
    scene: str
    function: str
    parameters: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    blocks: tuple[Block, ...]
    pattern: tuple[tuple[str, str], ...] = ()

    @property
    def width(self) -> int:
        """Return the number of values that come out."""
        return len(self.outputs) + len(self.pattern)


def _block(name: str, start: int, stop: int) -> Block:
    return Block(name, tuple(range(start, stop)))


def _dot(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{name}_dot" for name in names)


def _rigid_pattern() -> tuple[tuple[str, str], ...]:
    """Return (row, column) of the 66 nonzeros of the rigid body's Jacobian, column by column."""
    rows = {
        **{c: (*(r for r in ATTITUDE if r != c), *VELOCITY) for c in ATTITUDE},
        **{v: (p,) for v, p in zip(VELOCITY, POSITION, strict=True)},
        **dict.fromkeys(OMEGA, ATTITUDE + OMEGA),
        **dict.fromkeys(FORCE, VELOCITY),
        **dict.fromkeys(MOMENT, OMEGA),
    }
    return tuple((RATE_OF[row], column) for column, of in rows.items() for row in of)


def _jacobian_blocks(pattern: tuple[tuple[str, str], ...], start: int) -> tuple[Block, ...]:
    """Return a block for each pair of vectors, such as velocity_rate by attitude."""
    blocks: dict[str, list[int]] = {}
    for place, (row, column) in enumerate(pattern):
        name = f"{row.rpartition('_')[0]} by {column.rpartition('_')[0]}"
        blocks.setdefault(name, []).append(start + place)
    return tuple(Block(name, tuple(places)) for name, places in blocks.items())


FREE_BODY = Problem(
    "free_body",
    "omega_dot, full tensor",
    "free_body",
    "acceleration",
    TENSOR,
    OMEGA + MOMENT,
    OMEGA_DOT,
    (_block("omega_dot", 0, 3),),
)

PRINCIPAL = Problem(
    "free_body_principal",
    "omega_dot, principal axes",
    "free_body_principal",
    "acceleration",
    TENSOR[:3],
    OMEGA + MOMENT,
    OMEGA_DOT,
    (_block("omega_dot", 0, 3),),
)

HEAVY_TOP = Problem(
    "heavy_top",
    "heavy top in the nutation frame, 6 states",
    "heavy_top",
    "state_rate",
    ("A", "C", "m", "g", "l"),
    ("psi", "theta", "phi", *OMEGA),
    (*_dot(("psi", "theta", "phi")), *OMEGA_DOT),
    (_block("angle rates", 0, 3), _block("omega_dot", 3, 6)),
)

GYROSTAT = Problem(
    "gyrostat",
    "carrier and 3 wheels, 9 states",
    "gyrostat",
    "state_rate",
    (*TENSOR, "C_1", "C_2", "C_3"),
    (*ANGLES, *OMEGA, *WHEEL_SPEEDS, *MOMENT, "u_1", "u_2", "u_3"),
    (*_dot(ANGLES), *OMEGA_DOT, *_dot(WHEEL_SPEEDS)),
    (_block("angle rates", 0, 3), _block("omega_dot", 3, 6), _block("s_dot", 6, 9)),
)

RIGID_BLOCKS = (
    _block("position_rate", 0, 3),
    _block("attitude_rate", 3, 7),
    _block("velocity_rate", 7, 10),
    _block("omega_dot", 10, 13),
)

RIGID_BODY = Problem(
    "rigid_body",
    "free body, 13 states",
    "rigid_body",
    "state_rate",
    ("m", *TENSOR),
    RIGID_STATE + FORCE + MOMENT,
    RIGID_RATE,
    RIGID_BLOCKS,
)

RIGID_JACOBIAN = Problem(
    "rigid_body_jacobian",
    "the same with its Jacobian, 66 nonzeros",
    "rigid_body",
    "state_rate_jacobian",
    ("m", *TENSOR),
    RIGID_STATE + FORCE + MOMENT,
    RIGID_RATE,
    RIGID_BLOCKS + _jacobian_blocks(_rigid_pattern(), len(RIGID_STATE)),
    _rigid_pattern(),
)

_WHOLE = tuple((row, column) for column in RIGID_JACOBIAN.inputs for row in RIGID_RATE)

RIGID_DENSE = replace(
    RIGID_JACOBIAN,
    name="rigid_body_jacobian_dense",
    says="the same, the whole matrix, 247 entries",
    function="state_rate_jacobian_dense",
    blocks=RIGID_BLOCKS + _jacobian_blocks(_WHOLE, len(RIGID_STATE)),
    pattern=_WHOLE,
)

PROBLEMS = (FREE_BODY, PRINCIPAL, HEAVY_TOP, GYROSTAT, RIGID_BODY, RIGID_JACOBIAN, RIGID_DENSE)
