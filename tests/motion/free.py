"""Free bodies to move: their programs run in both precisions, and what their ends must be."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import flint
import numpy as np
from numpy.typing import NDArray

from derive.motion.exact import flow_exact
from derive.motion.exact.inertia import Inertia
from derive.program.arithmetic import MANTISSA, extended, paired, working
from derive.program.program import Program
from derive.program.recorded import needed
from derive.program.run import run
from derive.program.tape import Number, Tape
from tests.motion.stepped import TENSOR, body, quantity

Rows = NDArray[Any]
STATE = ("q0", "q1", "q2", "q3", "wx", "wy", "wz", "t")
DATA = Path(__file__).parent.parent / "data" / "rotations.json"
DIGITS = 220  # bits: reference values have 40 digits
FACTOR = {np.float64: 2, np.float32: 4}  # of kappa u: what the rounding of a motion may add
LEAST = 16  # u: the rounding of the last few operations, however well conditioned the state is


@dataclass(frozen=True)
class Flow:
    """The exact motion of one kind of body: its set-up and its function."""

    setup: Program
    function: Program

    def constants(self, dtype: type, tensors: Rows) -> list[Any]:
        """Return the constants (one array each) of bodies (n, 6)."""
        with np.errstate(all="ignore"):
            found = run(self.setup, extended(dtype), paired(list(tensors.astype(dtype).T)))
        return [np.broadcast_to(high, len(tensors)) for high, _ in found]

    def ends(self, dtype: type, tensors: Rows, states: Rows) -> Rows:
        """Return attitudes and rates (n, 7) of bodies (n, 6) after states (n, 8) with times."""
        given = [*self.constants(dtype, tensors), *states.astype(dtype).T]
        with np.errstate(all="ignore"):
            found = run(self.function, working(dtype), given)
        return np.stack([np.broadcast_to(x, len(states)) for x in found], axis=1)


def recorded(made: Callable[[list[Number]], Inertia]) -> Flow:
    """Return the motion of a body that is made of the six entries of its tensor."""
    setup = Tape("p")
    tape = Tape("t", below=setup)
    given = [tape.input(name) for name in STATE]
    inertia = made([setup.input(name) for name in TENSOR])
    attitude, omega = flow_exact(inertia, given[:4], given[4:7], given[7])
    results = tuple(x.operand for x in (*attitude, *omega))
    sources, names = list(setup.names), [name for name, _ in setup.names.values()]
    constants = replace(quantity("constants", names), role="constants")
    return Flow(
        Program(
            "setup", "", (quantity("inertia", TENSOR),), (constants,),
            needed(setup.ops, sources), tuple(sources), arithmetic="pairs",
        ),
        Program(
            "flow_exact", "", (constants, quantity("state", STATE)),
            (quantity("end", STATE[:7]),), needed(tape.ops, results), results,
        ),
    )  # fmt: skip


@cache
def flow(kind: str) -> Flow:
    """Return the motion of a body of a kind; a body of revolution has its axis along z."""
    return recorded(partial(body, kind))


@dataclass(frozen=True)
class Case:
    """A body, a state and a time, what they must end in, and how much they magnify errors."""

    name: str
    tensor: tuple[float, ...]
    state: tuple[float, ...]
    end: tuple[flint.arb, ...]
    kappa: tuple[float, float]
    exact_in_float: bool

    @property
    def kind(self) -> str:
        return "general" if any(self.tensor[3:]) else "principal"


@cache
def cases() -> tuple[Case, ...]:
    """Return the reference cases on which no moment acts."""
    rows = json.loads(DATA.read_text(encoding="utf-8"))["cases"]
    return tuple(_case(row) for row in rows if "cond_angle_rad_per_unit_rel_input" in row)


def _case(row: dict[str, Any]) -> Case:
    tensor = [[float.fromhex(x) for x in line] for line in row["inertia_hex"]]
    places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    start = [float.fromhex(x) for x in (*row["q0_hex"], *row["omega0_hex"])]
    with flint.ctx.workprec(DIGITS):
        end = tuple(flint.arb(x) for x in (*row["q_T"], *row["omega_T"]))
    kappa = row["cond_angle_rad_per_unit_rel_input"], row["cond_omega_rel_per_unit_rel_input"]
    return Case(
        row["id"],
        tuple(tensor[i][j] for i, j in places),
        (*start, float(row["T"])),
        end,
        (float(kappa[0]), float(kappa[1])),
        row["inputs_exact_in_float32"],
    )


def errors(found: Sequence[Any], true: Sequence[flint.arb]) -> tuple[float, float]:
    """Return the angle between two attitudes, up to 2 pi: signs count; and rates' relative error.

    A quaternion and its negative are one attitude, but not one continuous motion.
    """
    with flint.ctx.workprec(DIGITS):
        return apart([flint.arb(float(x)) for x in found], true)


def apart(got: Sequence[flint.arb], true: Sequence[flint.arb]) -> tuple[float, float]:
    """Return the same of numbers of many digits, in the precision that is set."""
    (a, b, c, d), (p, q, r, s) = true[:4], got[:4]
    w = a * p + b * q + c * r + d * s
    x, y, z = (
        a * q - b * p - c * s + d * r,
        a * r - c * p - d * q + b * s,
        a * s - d * p - b * r + c * q,
    )
    angle = 2 * flint.arb.atan2((x * x + y * y + z * z).mid().sqrt(), w)
    wrong = sum(((g - t) ** 2 for g, t in zip(got[4:], true[4:], strict=True)), flint.arb(0))
    size = sum((t * t for t in true[4:]), flint.arb(0))
    return float(angle.mid()), float((wrong / size).sqrt().mid())


def share(case: Case, dtype: type, found: Sequence[Any]) -> float:
    """Return how much of the error allowed an end uses up, the worse of attitude and rates."""
    u = 2.0 ** -MANTISSA[dtype]
    allowed = [max(FACTOR[dtype] * k, LEAST) * u for k in case.kappa]
    return max(e / a for e, a in zip(errors(found, case.end), allowed, strict=True))


def share_of(case: Case, dtype: type, motion: Flow) -> float:
    """Return the share that a motion uses up."""
    ends = motion.ends(dtype, np.array([case.tensor]), np.array([case.state]))
    return share(case, dtype, ends[0])
