"""An event that ends a motion: an equation such as ``theta = 0``, met between two steps."""

from collections.abc import Mapping, Sequence
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
from derive.solve.crossing import crossed_in
from derive.solve.instrument import Instrument
from derive.solve.told import met

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
    states = [c for q in found.library.vocabulary.states for c in q.components]
    used = symbols(left - right)
    if unset := [n for n in used if n not in {*states, *given, *functions, "pi"}]:
        raise SceneError(f"{label} uses '{unset[0]}', which is not set")
    sought = Event(text.strip(), left - right, functions)
    if not casadi.depends_on(*_residual(found, given, states, sought)):
        raise SceneError(f"{label} '{brief(text)}' holds nothing that changes on the way")
    return sought


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
    left, x = _residual(found, given, names, of)
    return casadi.Function("event", [x], [left])


def _residual(
    found: Instrument, given: Mapping[str, float], names: Sequence[str], of: Event
) -> tuple[casadi.SX, casadi.SX]:
    """Return what is zero when an event happens, and the state that it is made of."""
    x = casadi.SX.sym("x", len(names))
    values: dict[str, Any] = dict(given) | {n: x[k] for k, n in enumerate(names)}
    known = dict(values)
    for name in dict.fromkeys(of.functions[n] for n in symbols(of.left) if n in of.functions):
        known |= found.answer(name, values)
    return casadi.SX(evaluate(of.left, known | values, CASADI)), x


@dataclass
class _Alone:
    """A motion within a step: the state, the residual of it, and the state after a time."""

    state: NDArray[np.float64]
    left: Any
    moved: Any

    def on(self, length: float) -> None:
        """Go on by so many seconds."""
        self.state = np.array(self.moved(self.state, length)).ravel()

    def residual(self) -> NDArray[np.float64]:
        """Return what is zero when the event happens."""
        return np.array(self.left(self.state)).ravel()

    def here(self) -> NDArray[np.float64]:
        """Return the state as it is."""
        return self.state

    def to(self, places: NDArray[np.float64], which: NDArray[np.bool_]) -> None:
        """Be where the motion was."""
        if which.all():
            self.state = places


def has_value(left: Any, columns: NDArray[np.float64]) -> bool:
    """Tell whether a residual is a number at any of these states."""
    return bool(np.isfinite(np.array(left.map(columns.shape[1])(columns))).any())


def no_value(scene: str, of: Event) -> str:
    """Return the sentence on an event that nothing can tell of, as there is never a number."""
    return f"scene '{scene}': stop '{brief(of.text)}' has no value anywhere on the way"


def first_met(left: Any, columns: NDArray[np.float64], moved: Any, step: float) -> Any:
    """Return how many states stand before an event, the time since the last, the state then.

    left : the residual       moved : the state after a time, of the state and that time
    None if it does not happen; a sign that changes where the residual grows beyond both ends is
    that of a pole. A residual that turns back within a step is followed to where it turns.
    """
    values = np.array(left.map(columns.shape[1])(columns)).ravel()
    slopes = _slopes(left, columns, moved, step)
    for k in range(1, len(values)):
        before, after = values[k - 1], values[k]
        crosses = before * after < 0 or (after == 0 and before != 0)
        turns = not crosses and before * slopes[0][k - 1] < 0 < after * slopes[1][k - 1]
        if not (turns or crosses):
            continue
        way = _Alone(columns[:, k - 1], left, moved)
        (rest,), (met,) = crossed_in(way, values[k - 1 : k], step, np.array([bool(turns)]))
        if met and abs(way.residual()[0]) <= max(abs(before), abs(after)):
            return k, rest, way.state
    return None


def _slopes(
    left: Any, columns: NDArray[np.float64], moved: Any, step: float
) -> list[NDArray[np.float64]]:
    """Return the slopes in time of a residual at the start of the step from each state, and end."""
    x, h = casadi.SX.sym("x", len(columns)), casadi.SX.sym("h")
    slope = casadi.Function("slope", [x, h], [casadi.jacobian(left(moved(x, h)), h)])
    many = columns.shape[1]
    each = slope.map(many)
    return [np.array(each(columns, np.full((1, many), t))).ravel() for t in (0.0, step)]
