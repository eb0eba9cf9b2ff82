"""A scene described along other axes fixed in its body: what happens to every value.

Vectors and quaternions turn, the tensor turns, wheels trade places. Only scenes whose parameters
are the moments and products themselves can be described anew.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.mechanics.specialise import Specialised
from derive.program.added import added
from derive.program.program import Quantity
from derive.scene.formula import FLOATS, Formula, evaluate, symbols
from derive.verify.sample import Values, varying

Rows = tuple[tuple[float, float, float], ...]
TURN: Rows = ((0.36, 0.48, -0.8), (-0.8, 0.6, 0.0), (0.48, 0.64, 0.6))
CYCLE: Rows = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))  # x -> y -> z -> x
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
WHEELS = ("wheel_speeds", "wheel_accelerations", "wheel_torques")


@dataclass(frozen=True)
class Turning:
    """New components = ``rows`` @ old components; wheel n becomes wheel ``wheels[n]``."""

    known: Specialised
    rows: Rows
    wheels: tuple[int, ...]

    def turns(self, q: Quantity) -> bool:
        """Tell whether it is known how a quantity turns."""
        along = q.shape == (3,) and q.frame in ("B", "N") and not self.known.scene.coordinates
        vector = along or (q.shape == (3,) and q.frame == "B")
        return vector or q.shape == () or q.name in WHEELS or q.shape == (4,)

    def turned(self, values: Values) -> Values:
        """Return the same body in the same motion, described along the turned axes."""
        moved = dict(values)
        for q in varying(self.known):
            if self.turns(q):
                moved |= self.quantity(q, values)
        return moved | self._tensor(values) | self._axial_moments(values)

    def quantity(self, q: Quantity, values: Mapping[str, float]) -> Values:
        """Return the new components of a quantity."""
        old = [values[c] for c in q.components]
        if q.name in WHEELS:
            return {q.components[self.wheels[n]]: x for n, x in enumerate(old)}
        if q.shape == ():
            return {q.components[0]: old[0]}
        parts = _applied(self.rows, old[-3:])
        return dict(zip(q.components, [*old[:-3], *parts], strict=True))

    def _tensor(self, values: Values) -> Values:
        """Return the moments and products along the turned axes: R I R^T."""
        inertia = self.known.scene.body.inertia
        entry = dict(zip(PLACES, (_value(f, values) for f in inertia), strict=True))
        signed = [
            [entry[min(i, k), max(i, k)] * (1 if i == k else -1) for k in range(3)]
            for i in range(3)
        ]
        half = [_applied(self.rows, column) for column in zip(*signed, strict=True)]
        whole = [_applied(self.rows, row) for row in zip(*half, strict=True)]
        return {
            f.name: whole[i][k] * (1 if i == k else -1)
            for f, (i, k) in zip(inertia, PLACES, strict=True)
            if f.operator == "symbol"
        }

    def _axial_moments(self, values: Values) -> Values:
        wheels = self.known.scene.wheels
        return {
            wheels[to].axial.name: values[wheel.axial.name]
            for wheel, to in zip(wheels, self.wheels, strict=True)
        }


def _applied(rows: Rows, old: Sequence[float]) -> list[float]:
    return [added(r * x for r, x in zip(row, old, strict=True)) for row in rows]


def _value(formula: Formula, values: Mapping[str, float]) -> float:
    return float(evaluate(formula, values, FLOATS))


def turnings(known: Specialised) -> Iterator[tuple[str, Turning | None, str]]:
    """Yield the name of each check with its turning, or with the reason why there is none."""
    for check, rows in (("rotation of axes", TURN), ("cyclic relabelling", CYCLE)):
        reason = _not_turned(known, rows)
        if reason:
            yield check, None, reason
        else:
            yield check, Turning(known, rows, _wheels(known, rows) or ()), ""


def _not_turned(known: Specialised, rows: Rows) -> str:
    """Return why a scene cannot be described along turned axes; empty if it can."""
    scene, free = known.scene, {q.name for q in known.words.parameters}
    entered = [f.name for f in scene.body.inertia if f.operator == "symbol" and f.name in free]
    needed = {"general": 6, "principal": 3}.get(scene.body.kind, 0)
    if not needed or len(set(entered)) != needed or (needed == 3 and rows is TURN):
        return "the tensor along other axes is not one that the scene's parameters can describe"
    if not scene.axes.fixed_in_body or scene.point.kind == "moving":
        return "the axes are not the body's alone"
    if any(scene.known[name].formulas is not None for name in ("moment", "force")):
        return "moment or force are formulas along the scene's own axes"
    return (
        "" if _wheels(known, rows) is not None else "the wheels' axes do not turn into each other"
    )


def _wheels(known: Specialised, rows: Rows) -> tuple[int, ...] | None:
    """Return which wheel each wheel becomes; nothing if its new axis is no wheel's."""
    wheels = known.scene.wheels
    if any(symbols(f) for w in wheels for f in w.axis) or any(
        w.axial.operator != "symbol" for w in wheels
    ):
        return None
    axes = [[_value(f, {}) for f in w.axis] for w in wheels]
    moved = [_applied(rows, axis) for axis in axes]
    if any(axis not in axes for axis in moved):
        return None
    return tuple(axes.index(axis) for axis in moved)
