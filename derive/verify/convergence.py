"""The order of convergence of every step, against the motion that the lecture's equations give.

The true motion is found from the equations of the state's rate alone, solved in balls as they
stand: Gragg's midpoint rule with extrapolation (Bulirsch and Stoer 1966). It shares nothing with
the steps, their structure or their exact solutions. Errors at two lengths of step give the order.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, ctx

from derive.library.library import Library
from derive.program.largest import largest
from derive.program.program import placed
from derive.program.run import results_by_name
from derive.scene.wanted import SPLITTINGS, TAYLOR, step_of
from derive.verify.equations import equations_of
from derive.verify.operators import LONG_FLOATS
from derive.verify.reference import BALLS
from derive.verify.solution import solution

BITS = 500
LEVELS = 18
CLAIMED = {"step_rk4": 4, "step_rk4_unit": 4, "step_lie": 4, "step_dmv": 10} | SPLITTINGS | TAYLOR
TURN = {"step_dmv": 0.3} | dict.fromkeys(
    ("step_rk4", "step_rk4_unit", "step_lie", "step_split2"), 0.02
)
USUAL_TURN = 0.2
"""Turn in rad in the longer of two steps: small for a low order, large where a loop ends at u.

Order 20 has errors near 1e-40 there, far above the digits of the true motion."""

BELOW, ABOVE = 0.3, 0.7
"""So far from the order may be what two errors give, as the error's next term has a part in them:
less than a whole order either way, and more above, where that term may be the larger."""

CLOSED_FORM = 1e-40
"""A relative error that only a motion in closed form has; the catalogue's largest is 4e-56."""

NOTHING = 1e-100
"""A relative error that is none, in 500 bits: the motion is a polynomial, and the step has it."""

ROUNDED = 1e-17
"""A relative error that rounding covers: a closed form may end there, with its series."""

StateVector = list[Any]
RightHandSide = Callable[[StateVector], StateVector]


@dataclass(frozen=True)
class Order:
    """The errors of one step at a length and at half of it, and the order that follows.

    closed : the step is the motion in closed form, so that it has no order, only rounding
    """

    claimed: int
    errors: tuple[float, float]
    closed: bool

    @property
    def measured(self) -> float:
        """Return the order: how often half the step halves the error of a step, less one."""
        longer, shorter = self.errors
        return math.log2(longer / shorter) - 1 if longer and shorter else math.inf

    @property
    def holds(self) -> bool:
        """Tell whether the order is what is claimed, or a closed form is the motion."""
        if self.closed:
            return largest(self.errors) < ROUNDED
        if 0 < largest(self.errors) < NOTHING:
            return True
        return self.claimed - BELOW <= self.measured <= self.claimed + ABOVE

    def __str__(self) -> str:
        if self.closed:
            return f"{largest(self.errors):.1g}"
        return "exact" if largest(self.errors) < NOTHING else f"{self.measured:.2f}"


def right_hand_side(library: Library, values: Mapping[str, Any]) -> RightHandSide:
    """Return the rate of the state as the lecture's equations give it, other inputs held."""
    mechanism = library.mechanism
    problem = library.problems.get("state_rate") or mechanism.problem("state_rate")
    equations = equations_of(mechanism, problem)
    states = _states(library)
    rates = [c for q in problem.outputs for c in q.components]

    def rate(state: StateVector) -> StateVector:
        given = {**values, **dict(zip(states, state, strict=True))}
        found = solution(equations, given, (), BALLS).unknowns()
        return [found[name].value.mid() for name in rates]

    return rate


def extrapolated(rate: RightHandSide, state: StateVector, time: Any, levels: int) -> StateVector:
    """Return the state after ``time`` by extrapolation from 2, 4, ... 2 ``levels`` substeps."""
    rows: list[StateVector] = []
    for level in range(1, levels + 1):
        row = [_midpoint(rate, state, time, 2 * level)]
        for k, before in enumerate(rows[-1] if rows else []):
            factor = arb(level) ** 2 / arb(level - k - 1) ** 2 - 1
            latest = row[-1]
            row.append([a + (a - b) / factor for a, b in zip(latest, before, strict=True)])
        rows.append(row)
    return [x.mid() for x in rows[-1][-1]]


def _midpoint(rate: RightHandSide, state: StateVector, time: Any, steps: int) -> StateVector:
    """Return Gragg's midpoint rule with so many substeps, an even number."""
    h = time / steps
    before, here = state, [(x + h * v).mid() for x, v in zip(state, rate(state), strict=True)]
    for _ in range(steps - 1):
        slope = rate(here)
        after = [(x + 2 * h * v).mid() for x, v in zip(before, slope, strict=True)]
        before, here = here, after
    ends = zip(before, here, rate(here), strict=True)
    return [((a + b + h * v) / 2).mid() for a, b, v in ends]


@dataclass(frozen=True)
class Course:
    """The true motion from one state: what is given, two lengths of step, and where they end."""

    given: Mapping[str, Any]
    lengths: tuple[Any, Any]
    ends: tuple[StateVector, StateVector]


def course(library: Library, name: str, values: Mapping[str, float]) -> Course:
    """Return the true motion over a step that suits ``name`` and over half of it."""
    with ctx.workprec(BITS):
        given = unit_attitude(library, {c: arb(x) for c, x in values.items()})
        rate = right_hand_side(library, given)
        start = [given[c] for c in _states(library)]
        h = arb(TURN.get(step_of(name), USUAL_TURN) / _turning(library, rate(start), start))
        ends = extrapolated(rate, start, h, LEVELS), extrapolated(rate, start, h / 2, LEVELS)
        return Course(given, (h, h / 2), ends)


def order(library: Library, name: str, true: Course) -> Order:
    """Return the order of a step, from its errors over the two lengths of a course."""
    with ctx.workprec(BITS):
        errors = []
        for h, should in zip(true.lengths, true.ends, strict=True):
            found = stepped(library, name, true.given, h)
            errors.append(_distance([found[f"{c}_next"] for c in _states(library)], should))
    return Order(CLAIMED[step_of(name)], (errors[0], errors[1]), closed(library, name))


def closed(library: Library, name: str) -> bool:
    """Tell whether a step is the motion itself: without torque, of a body with equal moments.

    Two equal moments do for splittings and ``step_dmv``; a sphere keeps omega, so that
    ``step_lie`` turns it by the exponential of a constant.
    """
    base = step_of(name)
    if base not in (*SPLITTINGS, "step_dmv", "step_lie"):
        return False
    turning = library.mechanism.rotation()
    if turning is None or any(turning.moment) or not turning.tensor.is_diagonal():
        return False
    tensor = turning.tensor
    distinct = len({tensor[k, k].expand() for k in range(3)})
    return distinct < (2 if base == "step_lie" else 3)


def _states(library: Library) -> list[str]:
    return [c for q in library.vocabulary.states for c in q.components]


def exactness(library: Library, values: Mapping[str, float]) -> float:
    """Return the relative error of the exact flow over half a turn of the state or so."""
    with ctx.workprec(BITS):
        given = unit_attitude(library, {c: arb(x) for c, x in values.items()})
        states = _states(library)
        rate = right_hand_side(library, given)
        start = [given[c] for c in states]
        here, pieces = start, 8
        time = arb(3.0 / _turning(library, rate(start), start))
        for _ in range(pieces):
            here = extrapolated(rate, here, time / pieces, LEVELS)
        found = stepped(library, "flow_exact", given, time)
        return _distance([found[f"{c}_next"] for c in states], here)


def unit_attitude(library: Library, values: dict[str, Any]) -> dict[str, Any]:
    """Return the values with every quaternion of the state brought to length one."""
    for q in library.vocabulary.states:
        if q.is_quaternion:
            size = sum((values[c] ** 2 for c in q.components), arb(0)).sqrt()
            values = values | {c: (values[c] / size).mid() for c in q.components}
    return values


def _turning(library: Library, rates: StateVector, state: StateVector) -> float:
    """Return the fastest relative rate, 1/s, among the quantities of the state."""
    fastest = 1e-30
    for _, own in placed(library.vocabulary.states):
        fast, size = (max(abs(float(x)) for x in each[own]) for each in (rates, state))
        fastest = max(fastest, fast / size if size else 0.0)
    return fastest


def stepped(library: Library, name: str, values: Mapping[str, Any], h: Any) -> dict[str, Any]:
    """Return what a step gives at a length ``h``, in balls, from the scene's parameters on."""
    known = dict(values) | {"time_step": h, "time": h}
    known |= results_by_name(library.setup, LONG_FLOATS, known)
    for program in library.motions:
        if program.name in (f"plan_{name.removeprefix('step_')}", name):
            carried = [q for q in program.inputs if q.role == "remainder"]
            known |= {c: arb(0) for q in carried for c in q.components}
            known |= results_by_name(program, LONG_FLOATS, known)
    return known


def _distance(found: Sequence[Any], should: Sequence[Any]) -> float:
    size = largest(map(abs, should))
    gaps = [(a - b).mid() for a, b in zip(found, should, strict=True)]
    return largest(map(abs, gaps)) / size if math.isfinite(size) else math.inf
