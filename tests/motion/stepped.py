"""Steps of free bodies as programs and as compiled loops, and how wrong a run of them ends."""

import ctypes
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import mpmath as mp
import numpy as np

from derive.check.compiler import compiled, find_compiler
from derive.emit.c import text as c_text
from derive.emit.c.sines import own_sines
from derive.emit.sines import TOGETHER
from derive.motion.exact.inertia import Inertia
from derive.motion.moser_veselov import plan_dmv, step_dmv
from derive.motion.splitting import Start, step_split
from derive.program.arithmetic import extended
from derive.program.precision import PRECISIONS, Precision
from derive.program.program import Program, Quantity
from derive.program.recorded import needed
from derive.program.run import run
from derive.program.tape import Number, Tape, number

TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")
BITS = 140
MANY: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "number": lambda q: mp.mpf(q.numerator) / q.denominator,
    "sqrt": mp.sqrt,
    "sin": mp.sin,
    "cos": mp.cos,
    "abs": abs,
    "less": lambda a, b: a < b,
    "at_most": lambda a, b: a <= b,
    "both": lambda a, b: a and b,
    "either": lambda a, b: a or b,
    "select": lambda condition, yes, no: yes if condition else no,
    "power_of_two": lambda x: mp.mpf(2) ** mp.floor(mp.log(x, 2)),
    "splitter": lambda: mp.mpf(2) ** (BITS // 2) + 1,
}
"""Arithmetic of many digits; its precision is set where it is used."""


@dataclass(frozen=True)
class Stepper:
    """The programs of a step: its set-up, the plan of a motion, and the step from state to state.

    The state is attitude (4), omega (3) and, for some, a remainder (7).
    """

    setup: Program
    plan: Program
    step: Program
    width: int

    def constants(self, dtype: type, tensor: Sequence[float]) -> list[Any]:
        """Return set-up's constants of one body, each rounded once."""
        pairs = [(dtype(x), dtype(0)) for x in tensor]
        with np.errstate(invalid="ignore"):  # a root of zero, whose residual is not taken
            return [high for high, _ in run(self.setup, extended(dtype), pairs)]

    def planned(
        self, table: Mapping[str, Any], constants: Sequence[Any], omega: Sequence[Any], h: Any
    ) -> list[Any]:
        """Return the plan of a motion in an arithmetic."""
        return run(self.plan, table, [*constants, *omega, h])

    def moved(self, tensor: Sequence[Any], state: Sequence[Any], h: Fraction, steps: int) -> Any:
        """Return the state (7,) after some steps, in many digits."""
        with mp.workprec(BITS):
            entries = [MANY["number"](Fraction(x)) for x in tensor]
            now = [MANY["number"](Fraction(x)) for x in state] + [mp.mpf(0)] * (self.width - 7)
            h = MANY["number"](h)
            constants = run(self.setup, MANY, entries)
            plan = self.planned(MANY, constants, now[4:7], h)
            for _ in range(steps):
                now = run(self.step, MANY, [*constants, *plan, h, *now])
            return now[:7]

    def ran(
        self, dtype: type, tensor: Sequence[float], state: Sequence[float], h: float, steps: int
    ) -> list[Any]:
        """Return the state after many steps of compiled C, remainders added, in many digits."""
        return self._ran(dtype, tensor, state, h, (steps, self.width))

    def ran_forgetting(
        self, dtype: type, tensor: Sequence[float], state: Sequence[float], h: float, steps: int
    ) -> list[Any]:
        """Return the same where every step begins without a remainder."""
        return self._ran(dtype, tensor, state, h, (steps, 7))

    def _ran(
        self,
        dtype: type,
        tensor: Sequence[float],
        state: Sequence[float],
        h: float,
        counts: tuple[int, int],
    ) -> list[Any]:
        library = _library(self)
        names = {np.float64: ("f64", ctypes.c_double), np.float32: ("f32", ctypes.c_float)}
        scalar, c_scalar = names[dtype]
        constants = np.array([*self.constants(dtype, tensor), 0], dtype)
        now = np.array([*state, *[0] * (self.width - 7)], dtype)
        pointers = [x.ctypes.data_as(ctypes.POINTER(c_scalar)) for x in (constants, now)]
        longs = map(ctypes.c_long, counts)
        getattr(library, f"many_{scalar}")(*pointers, c_scalar(h), *longs)
        with mp.workprec(BITS):
            found = [mp.mpf(float(x)) for x in now]
            return [x + (found[7 + i] if self.width > 7 else 0) for i, x in enumerate(found[:7])]


def body(kind: str, entries: Sequence[Number]) -> Inertia:
    """Return what is known of a body of a kind; a body of revolution has its axis along z."""
    x, y, z, *products = entries
    none = [number(0)] * 3
    made = {
        "general": (x, y, z, *products),
        "principal": (x, y, z, *none),
        "axisymmetric": (x, x, z, *none),
        "spherical": (x, x, x, *none),
    }[kind]
    axis = "z" if kind == "axisymmetric" else None
    return Inertia(made, kind, axis)  # type: ignore[arg-type]


@cache
def dmv(kind: str) -> Stepper:
    """Return the Moser-Veselov step of a body of a kind."""
    setup = Tape("p")
    inertia = body(kind, [setup.input(name) for name in TENSOR])
    first, second = Tape("t", below=setup), Tape("t", below=setup)
    omega, h = [first.input(f"w{i}") for i in range(3)], first.input("h")
    planned = plan_dmv(first, inertia, omega, h)
    names = [name for name, _, _ in planned]
    plan = {name: second.input(f"plan_{name}") for name in names}
    state = [second.input(f"s{i}") for i in range(14)]
    after = step_dmv(second, inertia, plan, state[:4], state[4:7], state[7:])
    ends = [value for _, value, _ in planned], after
    return _stepper(setup, (first, second), [f"plan_{n}" for n in names], ends)


Moment = Callable[[list[Number]], Sequence[Number]]


@cache
def split(kind: str, order: int, moment: Moment | None = None) -> Stepper:
    """Return the splitting of an order, for a body of a kind."""
    return _split(kind, order, moment, 7)


@cache
def split_compensated(kind: str, order: int) -> Stepper:
    """Return the splitting with remainders."""
    return _split(kind, order, None, 14)


def _split(kind: str, order: int, moment: Moment | None, width: int) -> Stepper:
    setup = Tape("p")
    inertia = body(kind, [setup.input(name) for name in TENSOR])
    first, second = Tape("t", below=setup), Tape("t", below=setup)
    s, h = [second.input(f"s{i}") for i in range(width)], second.input("h")
    after = step_split(second, inertia, order, Start(s[:4], s[4:7], moment, h, s[7:]))
    return _stepper(setup, (first, second), [], ([], after))


def _stepper(
    setup: Tape,
    tapes: tuple[Tape, Tape],
    plan: Sequence[str],
    ends: tuple[Sequence[Number], Sequence[Number]],
) -> Stepper:
    sources = tuple(setup.names)
    constants = quantity("constants", [setup.names[x][0] for x in sources])
    constants = replace(constants, role="constants")
    planned, state = quantity("plan", plan), quantity("state", _named("s", len(ends[1])))
    step = Quantity("h", ("h",), (), "", "", None, None, "")
    omega = quantity("omega", ["w0", "w1", "w2"])
    first, second = (tuple(number(x).operand for x in end) for end in ends)
    return Stepper(
        Program(
            "setup", "", (quantity("inertia", TENSOR),), (constants,),
            needed(setup.ops, sources), sources, arithmetic="pairs",
        ),
        Program(
            "plan", "", (constants, omega, step), (planned,),
            needed(tapes[0].ops, first), first,
        ),
        Program(
            "step", "", (constants, planned, step, state), (quantity("next", state.components),),
            needed(tapes[1].ops, second), second,
        ),
        len(ends[1]),
    )  # fmt: skip


def quantity(name: str, components: Sequence[str]) -> Quantity:
    return Quantity(name, tuple(components), (len(components),), "", "", None, None, "")


def _named(letter: str, count: int) -> list[str]:
    return [f"{letter}{i}" for i in range(count)]


# By the identity of a stepper, which is kept so that no other can have it.
_LIBRARIES: dict[int, tuple[Stepper, ctypes.CDLL]] = {}


def _library(stepper: Stepper) -> ctypes.CDLL:
    """Return a stepper's loops in both precisions, compiled once."""
    if id(stepper) not in _LIBRARIES:
        loops = "".join(_loop(stepper, p) for p in PRECISIONS)
        sines = "\n".join(own_sines("many", p) for p in PRECISIONS) if TOGETHER in loops else ""
        text = f"#include <math.h>\n{sines}\n{loops}"
        made = compiled({"many.c": text}, "many.c", Path(mkdtemp()), find_compiler())
        _LIBRARIES[id(stepper)] = stepper, ctypes.CDLL(str(made))
    return _LIBRARIES[id(stepper)][1]


def _loop(stepper: Stepper, precision: Precision) -> str:
    s, p = precision.scalar, precision.name
    names = [c for q in stepper.setup.outputs for c in q.components]
    fields = "".join(f"{s} {name}; " for name in (*names, "none"))
    plan = "\n".join(c_text.float_body(stepper.plan, "many", precision))
    step = "\n".join(c_text.float_body(stepper.step, "many", precision))
    width = max(1, len(stepper.plan.results))
    head = f"const struct constants_{p} *constants"
    unused = "(void)constants; (void)plan; (void)h;"
    return f"""
struct constants_{p} {{ {fields}}};
void many_{p}({head}, {s} *state, {s} h, long steps, long kept);
static void plan_{p}({head}, const {s} *omega, {s} h, {s} *plan)
{{ {unused} (void)omega;
{plan}
}}
static void step_{p}({head}, const {s} *plan, {s} h, const {s} *state, {s} *next)
{{ {unused}
{step}
}}
void many_{p}({head}, {s} *state, {s} h, long steps, long kept)
{{
    {s} plan[{width}];
    plan_{p}(constants, state + 4, h, plan);
    for (long i = 0; i < steps; ++i) {{
        step_{p}(constants, plan, h, state, state);
        for (long j = kept; j < {stepper.width}; ++j) {{
            state[j] = 0;
        }}
    }}
}}
"""


def invariants(tensor: Sequence[float], state: Sequence[Any]) -> tuple[Any, Any]:
    """Return twice the energy and the length of the angular momentum, in many digits."""
    with mp.workprec(BITS):
        xx, yy, zz, xy, xz, yz = (mp.mpf(x) for x in tensor)
        a, b, c = (mp.mpf(x) for x in state[4:7])
        p, q, r = xx * a + xy * b + xz * c, xy * a + yy * b + yz * c, xz * a + yz * b + zz * c
        return p * a + q * b + r * c, mp.sqrt(p * p + q * q + r * r)


def apart(found: Sequence[Any], true: Sequence[Any]) -> tuple[float, float]:
    """Return the angle in rad between two attitudes, and the relative difference of two rates."""
    with mp.workprec(BITS):
        sign = 1 if sum(f * t for f, t in zip(found[:4], true[:4], strict=True)) > 0 else -1
        q = mp.sqrt(sum((f - sign * t) ** 2 for f, t in zip(found[:4], true[:4], strict=True)))
        w = mp.sqrt(sum((f - t) ** 2 for f, t in zip(found[4:], true[4:], strict=True)))
        return float(2 * q), float(w / mp.sqrt(sum(t * t for t in true[4:])))


def measured_order(
    stepper: Stepper, tensor: Sequence[Any], reference: Sequence[Any], halvings: Sequence[int]
) -> list[float]:
    """Return the orders that runs over half a second show, from one step size to the next."""
    errors = []
    for k in halvings:
        found = stepper.moved(tensor, START, Fraction(1, 2 * k), k)
        errors.append(max(abs(f - t) for f, t in zip(found, reference, strict=True)))
    return [float(mp.log(a / b, 2)) for a, b in pairwise(errors)]


START = (1.0, 0.0, 0.0, 0.0, 1.0, 0.5, 2.0)
