"""An event that ends a motion: an equation such as ``theta = 0``, met between two steps."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from derive.scene import SceneError
from derive.scene.escape import brief
from derive.scene.formula import Formula, evaluate, symbols
from derive.scene.functions import FUNCTIONS, PLAIN
from derive.scene.scope import Scope, measured
from derive.scene.unit import BESIDE_SI, NONE, Dimension, dimension, spelled
from derive.scene.wanted import moves
from derive.solve.instrument import Instrument
from derive.solve.told import met

HALVINGS = 60
"""Of a step: what is left of it is below the roundings of any time in it."""
CASADI = {
    "number": float,
    **PLAIN,
    "power": lambda base, exponent: base**exponent,
    **{name: getattr(casadi, name) for name in FUNCTIONS},
}


@dataclass(frozen=True)
class Event:
    """What is zero when it happens: a formula, and the answers in it with their functions."""

    text: str
    left: Formula
    functions: Mapping[str, str]


def event(found: Instrument, given: Mapping[str, float], text: object) -> Event:
    """Return the event that an equation of what is known along a motion tells.

    Raises SceneError for what is no equation, for other names, for sides of different units.
    """
    label = f"scene '{found.name}': stop"
    sides = text.split("=") if isinstance(text, str) else []
    if not isinstance(text, str) or len(sides) != 2:
        raise SceneError(f"{label} must be an equation such as 'theta = 0', not {met(text)}")
    functions = answers_along(found, given)
    scope = Scope(_dimensions(found, functions), {}, "")
    (left, one), (right, other) = (measured(side.strip(), label, scope) for side in sides)
    alone = "number" in (left.operator, right.operator)
    if one is not None and other is not None and one != other and not alone:
        says = f"'{brief(left)}' is in {spelled(one)}, but '{brief(right)}' in {spelled(other)}"
        raise SceneError(f"{label}: {says}")
    states = {c for q in found.library.vocabulary.states for c in q.components}
    used = symbols(left - right)
    if unset := [n for n in used if n not in {*states, *given, *functions, "pi"}]:
        raise SceneError(f"{label} uses '{unset[0]}', which is not set")
    if states.isdisjoint(used) and not {*used} & functions.keys():
        raise SceneError(f"{label} '{brief(text)}' holds nothing that changes on the way")
    return Event(text.strip(), left - right, functions)


def answers_along(found: Instrument, given: Mapping[str, float]) -> dict[str, str]:
    """Return the answers that are known along a motion, each with the function that gives it."""
    states = [c for q in found.library.vocabulary.states for c in q.components]
    scene = found.library.scene
    apart = (*scene.steady, "linearised")
    functions = [name for name in scene.wanted if not moves(name) and name not in apart]
    return {
        c: name
        for name in reversed(functions)
        if {*found.needed(name)} <= {*given, *states} and not found.library[name].sparsity
        for q in found.library[name].outputs
        if q.unit and q.unit not in BESIDE_SI
        for c in q.components
    }


def _dimensions(found: Instrument, functions: Mapping[str, str]) -> dict[str, Dimension]:
    answers = (q for name in functions.values() for q in found.library[name].outputs)
    every = (*answers, *found.quantities())
    return {"pi": NONE} | {c: dimension(q.unit) for q in every for c in q.components if q.unit
                           and q.unit not in BESIDE_SI}  # fmt: skip


def residual(found: Instrument, given: Mapping[str, float], names: Sequence[str], of: Event) -> Any:
    """Return what is zero when an event happens, as a CasADi function of the state."""
    x = casadi.SX.sym("x", len(names))
    values: dict[str, Any] = dict(given) | {n: x[k] for k, n in enumerate(names)}
    known = dict(values)
    for name in dict.fromkeys(of.functions[n] for n in symbols(of.left) if n in of.functions):
        known |= found.answer(name, values)
    return casadi.Function("event", [x], [evaluate(of.left, known | values, CASADI)])


def first_met(left: Any, columns: NDArray[np.float64], moved: Any, step: float) -> Any:
    """Return how many states stand before an event, the time since the last, the state then.

    left : the residual       moved : the state after a time, of the state and that time
    None if it does not happen; a sign that changes where the residual grows beyond both ends is
    that of a pole. A residual that turns back within a step is followed to where it turns.
    """
    values = np.array(left.map(columns.shape[1])(columns)).ravel()
    way = _along(left, moved)
    for k, part in _brackets(values, columns, way, step):
        start, before, low, high = columns[:, k - 1], values[k - 1], 0.0, part
        beyond = max(abs(before), abs(float(way[0](start, high))))
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            if float(way[0](start, middle)) * before > 0:
                low = middle
            else:
                high = middle
        state = np.array(moved(start, high)).ravel()
        if abs(float(left(state))) <= beyond:
            return k, high, state
    return None


InTime = tuple[Any, Any]


def _along(left: Any, moved: Any) -> InTime:
    """Return a residual and its slope in time, of the state before a step and the time since."""
    x, h = casadi.SX.sym("x", moved.size1_in(0)), casadi.SX.sym("h")
    value = left(moved(x, h))
    return (
        casadi.Function("value", [x, h], [value]),
        casadi.Function("slope", [x, h], [casadi.jacobian(value, h)]),
    )


def _brackets(
    values: NDArray[np.float64], columns: NDArray[np.float64], way: InTime, step: float
) -> Iterator[tuple[int, float]]:
    """Yield the steps, counted from one, and the times in them by which a residual has crossed."""
    slopes = [
        np.array(way[1].map(len(values))(columns, np.full(len(values), time))).ravel()
        for time in (0.0, step)
    ]
    for k in range(1, len(values)):
        before, after = values[k - 1], values[k]
        if before * after < 0 or (after == 0 and before != 0):
            yield k, step
        elif before * slopes[0][k - 1] < 0 < after * slopes[1][k - 1]:
            turn = _turn(columns[:, k - 1], way, step)
            if float(way[0](columns[:, k - 1], turn)) * before <= 0:
                yield k, turn


def _turn(start: NDArray[np.float64], way: InTime, step: float) -> float:
    """Return the time within a step at which a residual turns back."""
    first, low, high = float(way[1](start, 0.0)), 0.0, step
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if float(way[1](start, middle)) * first > 0:
            low = middle
        else:
            high = middle
    return high
