"""The balances of all that a frame carries, about its origin: few, and enough for links.

The moment along the axis of a hinge holds no reaction there, nor any outboard of it. They are
written by one pass outward, of accelerations, and one inward, of forces and moments (Newton and
Euler), so that each takes no more than what hangs on its frame needs beside the frames before.
"""

from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace

from mpmath import mp
from sympy import Expr, Integer, Matrix

from derive.lecture.stated import by_law
from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.bodies import centre, mass
from derive.mechanics.frames import ZERO
from derive.mechanics.probe import DIGITS
from derive.scene.machine import INERTIAL

Outboard = Mapping[ValuedBalance, str]


def outboard(balances: Balances) -> Outboard:
    """Return these balances along each frame's axes and its parent's, with the frame of each."""
    with mp.workdps(DIGITS):
        every = [(row, f) for f in balances.frames.each for row in _beyond(balances, f)]
        return {row: frame for row, frame in every if not row.empty}


def _beyond(balances: Balances, frame: str) -> Iterator[ValuedBalance]:
    frames = balances.frames
    if not all(n == INERTIAL or _hung(balances, n) for n in frames.chain(frame)):
        return
    bodies = tuple(_carried(balances, frame))
    every = [n for n in frames.each if frame in frames.chain(n)]
    if frame == INERTIAL or not bodies or not all(_hung(balances, n) for n in every):
        return
    if balances.reachable(frame, bodies):
        rows = balances.about(bodies, (frame, ZERO), frame, frames.each[frame].parent)
        yield from (replace(row, outboard=True) for row in rows)


def _hung(balances: Balances, frame: str) -> bool:
    """Tell whether a frame is at a place of its parent, and turned in it."""
    frames = balances.frames
    parent = frames.each[frame].parent
    return frames.rotations[frame] is not None and frames.placed(frame, parent)


def _carried(balances: Balances, frame: str) -> Iterator[str]:
    """Yield the bodies that a frame carries, on whatever frames."""
    frames = balances.frames
    return (b for b in balances.sides.efforts if frame in frames.chain(frames.own(b)))


def write_out(balances: Balances, rows: Sequence[ValuedBalance], of: Outboard) -> None:
    """Write balances of outboard bodies out."""
    for row, e in zip(rows, needed_by(balances, rows, held_beyond(of), of), strict=True):
        balances.expressions[row] = balances.without_what_drops_out(row, e)


def held_beyond(of: Outboard) -> Mapping[str, AbstractSet[int]]:
    """Return which unknowns are in the balances of each frame; all others drop out."""
    return {frame: _held(of, frame) for frame in dict.fromkeys(of.values())}


def needed_by(
    balances: Balances, rows: Sequence[ValuedBalance], held: Mapping[str, AbstractSet[int]],
    of: Outboard,
) -> Iterator[Expr]:  # fmt: skip
    """Yield what balances of outboard bodies need, less what acts, where ``held`` is held."""
    passes = _Passes(balances, held)
    for row in rows:
        needed, about = passes.needed(of[row])
        vector = needed if row.balance.point is None else about
        vector = balances.frames.carried(vector, of[row], row.balance.frame)
        yield (balances.frames.direction(row.balance.axis).T * vector)[0]


def _held(of: Outboard, frame: str) -> frozenset[int]:
    return frozenset(k for row, own in of.items() if own == frame for k in row.holds)


@dataclass
class _Passes:
    """Accelerations of origins; forces and moments about them, each along its frame's axes.

    held : which unknowns are in the balances of a frame; all others drop out
    """

    balances: Balances
    held: Mapping[str, AbstractSet[int]]
    a: dict[str, Matrix] = field(default_factory=lambda: {INERTIAL: ZERO})
    done: dict[str, tuple[Matrix, Matrix]] = field(default_factory=dict)

    def acceleration(self, name: str) -> Matrix:
        """Return the acceleration of a frame's origin."""
        frames = self.balances.frames
        if name not in self.a:
            frame = frames.each[name]
            seen = frames.acceleration_seen(frame.parent, frames.words.column(frame.origin))
            whole = frames.sheet.column(f"{name}.a", self.acceleration(frame.parent) + seen)
            self.a[name] = frames.carried(whole, frame.parent, name)
        return self.a[name]

    def needed(self, name: str) -> tuple[Matrix, Matrix]:
        """Return what motion needs of all that a frame carries, less what acts on it."""
        if name not in self.done:
            frames, total, about = self.balances.frames, ZERO, ZERO
            for body in self.balances.sides.efforts:
                if frames.own(body) == name:
                    own_force, own_moment = self._body(body, name)
                    total, about = total + own_force, about + own_moment
            for w in self.balances.sides.wrenches:
                if frames.own(w.body) == name:
                    acting = frames.carried(w.force, w.along, name)
                    couple = frames.carried(w.couple, w.along, name)
                    arm = frames.apart((name, ZERO), w.point, name)
                    known = {"M_G": couple, "rho_G": arm, "F": acting}
                    total = total - acting
                    about = about - by_law("moment_about_any_point", known)
            for child, frame in frames.each.items():
                if child != INERTIAL and frame.parent == name and child in self.held:
                    own_force, own_moment = (
                        frames.carried(v, child, name) for v in self.needed(child)
                    )
                    arm = frames.words.column(frame.origin)
                    known = {"M_G": own_moment, "rho_G": arm, "F": own_force}
                    total = total + own_force
                    about = about + by_law("moment_about_any_point", known)
            self.done[name] = (
                self._column(name, "F", total),
                self._column(name, "M", about),
            )
        return self.done[name]

    def _body(self, body: str, name: str) -> tuple[Matrix, Matrix]:
        frames, at = self.balances.frames, centre(self.balances.frames, body)[1]
        a_G = self.acceleration(name) + frames.acceleration_seen(name, at)
        known = {"m": mass(frames, body), "a_G": frames.sheet.column(f"{body}.a_G", a_G)}
        force = frames.sheet.column(f"{body}.F", by_law("mass_centre_motion", known))
        moment = self.balances.sides.efforts[body].moment
        about = {"M_G": moment, "rho_G": at, "F": force}
        return force, by_law("moment_about_any_point", about)

    def _column(self, name: str, label: str, vector: Matrix) -> Matrix:
        """Return a column with every coefficient named, without unknowns that drop out."""
        unknowns = self.balances.unknowns
        gone = {u: Integer(0) for k, u in enumerate(unknowns) if k not in self.held[name]}
        return self.balances.frames.sheet.column(f"{name}.{label}", vector.xreplace(gone))
