"""What a scene may ask for, and in what form: functions of the lecture, motions, attitudes."""

from collections.abc import Iterable, Iterator
from itertools import permutations

from derive.scene.declaration import SceneError
from derive.scene.table import nearest

EQUATIONS = (
    "angular_momentum",
    "angular_momentum_rate",
    "moment",
    "acceleration",
    "state_rate",
    "kinetic_energy",
)
"""What the lecture states; each may be wanted with its Jacobian."""

SPLITTINGS = {"step_split2": 2, "step_split": 4, "step_split6": 6}
TAYLOR = {"step_taylor": 20} | {f"step_taylor{order}": order for order in range(12, 20)}
STEP_FUNCTIONS = (
    "step_rk4",
    "step_rk4_unit",
    "step_lie",
    *SPLITTINGS,
    "step_dmv",
    *TAYLOR,
    "flow_exact",
)
"""Motion in time: steps of the whole state, and the exact torque-free rotation."""

COMPENSATED = tuple(f"{name}_compensated" for name in ("step_rk4", "step_lie", *SPLITTINGS))
STEP_DERIVATIVES = (
    *(
        f"{name}_{kind}"
        for name in ("step_rk4", "step_rk4_unit")
        for kind in ("jacobian", "tangent", "sensitivity")
    ),
    *(f"step_lie_{kind}" for kind in ("jacobian", "tangent")),
)
TORQUE_FREE = ("step_dmv", "flow_exact")
OF_MACHINES = (
    "step_rk4",
    "step_rk4_compensated",
    "step_rk4_jacobian",
    "step_rk4_tangent",
    "step_rk4_sensitivity",
    *TAYLOR,
    "step_rk4_unit",
    "step_rk4_unit_jacobian",
    "step_rk4_unit_tangent",
    "step_rk4_unit_sensitivity",
)
"""Those that need nothing but the rate of a state, so that machines may ask for them."""
ROTATIONAL = (*TORQUE_FREE, *SPLITTINGS, *(f"{name}_compensated" for name in SPLITTINGS))
"""Those that move a free rotation, attitude and omega, and nothing else."""

IN_PAIRS = ("step_rk4", "step_rk4_unit", "step_lie", *STEP_DERIVATIVES, *SPLITTINGS)
"""Those that can work on pairs of floats, as the accurate form does."""

SEQUENCES = tuple(
    first + middle + last
    for first, middle in permutations("xyz", 2)
    for last in "xyz"
    if last != middle
)
"""The twelve ways to turn through three angles: x-y-x to z-y-z."""

ATTITUDES = (
    *(f"quaternion_{name}" for name in ("product", "exp", "log", "normalise")),
    *("quaternion_error", "quaternion_error_tangent"),
    *("quaternion_rotate", "quaternion_rotate_back"),
    *(f"quaternion_{way}_{other}" for other in ("matrix", "mrp") for way in ("to", "from")),
    *(f"quaternion_{way}_euler_{s}" for s in SEQUENCES for way in ("to", "from")),
)
"""Formulas for attitudes, which need no body."""

JACOBIAN, SENSITIVITY = "_jacobian", "_sensitivity"
"""How the name of a function with derivatives ends: by what varies; by state and parameters."""

JACOBIANS = tuple(f"{name}{JACOBIAN}" for name in EQUATIONS)
MOTIONS = (*STEP_FUNCTIONS, *COMPENSATED, *STEP_DERIVATIVES)
WANTED = (*EQUATIONS, *JACOBIANS, *MOTIONS, *ATTITUDES)


def resembling(name: str, known: Iterable[str]) -> str:
    """Return a hint at what may be meant by a name that is not known."""
    if name.startswith("step_taylor"):
        return " (step_taylor is of order 20, step_taylor12 to step_taylor19 of what they say)"
    return nearest(name, known)


def check_form(wanted: Iterable[str], form: str, emission: str) -> None:
    """Refuse the accurate form for steps that have none; formulas for attitudes need none."""
    moving = [name for name in wanted if moves(name)]
    if form != "accurate" or not moving:
        return
    if emission == "compact":
        rule = "works in pairs of floats, which loops over stages do not"
        raise SceneError(f"form = 'accurate' {rule}: '{moving[0]}' needs emission = 'fast'")
    for name in moving:
        if name not in IN_PAIRS:
            raise SceneError(
                f"form = 'accurate' is not for '{name}', which {_own_way(name)}; "
                f"of the steps it is for {', '.join(s for s in STEP_FUNCTIONS if s in IN_PAIRS)} "
                "and derivatives"
            )


def _own_way(name: str) -> str:
    """Return why a step has no accurate form."""
    if name in COMPENSATED or name == "step_dmv":
        return "carries what rounding leaves already"
    return "is a closed form of its own" if name == "flow_exact" else "runs loops over its series"


def attitudes_only(value: object) -> bool:
    """Tell whether a file asks for formulas of attitudes and nothing else, so needs no body."""
    return isinstance(value, list) and bool(value) and all(name in ATTITUDES for name in value)


def moves(name: str) -> bool:
    """Tell whether a wanted function moves the state in time."""
    return name in MOTIONS


def step_of(name: str) -> str:
    """Return the step that a compensated step or a derivative belongs to.

    >>> step_of("step_rk4_unit_jacobian"), step_of("step_split6_compensated")
    ('step_rk4_unit', 'step_split6')
    """
    if name in COMPENSATED or name in STEP_DERIVATIVES:
        return name.rpartition("_")[0]
    return name


def without_ending(name: str) -> str:
    """Return the function of the lecture that a function with derivatives belongs to.

    >>> [without_ending(name) for name in ("state_rate_jacobian", "omega_sensitivity", "moment")]
    ['state_rate', 'omega', 'moment']
    """
    return name.removesuffix(JACOBIAN).removesuffix(SENSITIVITY)


def with_column(name: str) -> bool:
    """Tell whether a wanted function may have a column by the step's length."""
    return name in STEP_DERIVATIVES and not name.endswith(SENSITIVITY)


def idle_times(motion: Iterable[str], wanted: Iterable[str]) -> Iterator[str]:
    """Yield a sentence for each entry of a scene's table ``motion`` that nothing wanted takes."""
    moving = [name for name in wanted if moves(name)]
    flows = [name for name in moving if name.startswith("flow_")]
    takers = {"time": flows, "time_step": [name for name in moving if name not in flows]}
    takers["column"] = list(filter(with_column, moving))
    for entry in motion:
        if not takers[entry]:
            yield f"motion.{entry} is given, but nothing that is wanted takes it"
