"""Every balance that a machine offers: forces on any bodies, moments about any point, any axis.

Whole vectors are valued at trial points in common axes, so that thousands of balances can be
looked at; only those that are chosen are written out.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations
from typing import Any

from mpmath import mp
from numpy.typing import NDArray
from sympy import Expr, Integer, Matrix, Symbol

from derive.lecture.stated import by_law
from derive.mechanics.balance import Balance, ValuedBalance
from derive.mechanics.bodies import carries, moment_about
from derive.mechanics.constraints import Tie
from derive.mechanics.enforced import enforced, row_valued
from derive.mechanics.frames import ZERO, Frames, Located
from derive.mechanics.loads import Wrench
from derive.mechanics.own_axes import frame_called
from derive.mechanics.probe import DIGITS, NOTHING
from derive.mechanics.sheet import AXES
from derive.mechanics.told_by import hang_together
from derive.mechanics.valued import Sides, Valued, sides, trial_probes

MOST_TOGETHER = 6


@dataclass
class Balances:
    """The efforts and loads of a machine, and the balances made of them.

    expressions : of balances that were written out before
    single      : whether there are those of single bodies, about mass centres, alone
    """

    frames: Frames
    expressions: dict[ValuedBalance, Expr] = field(default_factory=dict)
    single: bool = False

    @cached_property
    def sides(self) -> Sides:
        """Return what the motion of the bodies needs and what acts on them."""
        return sides(self.frames)

    @cached_property
    def unknowns(self) -> tuple[Symbol, ...]:
        """Return the unknowns in order of their names' places."""
        return self.sides.unknowns

    @cached_property
    def rows(self) -> tuple[ValuedBalance, ...]:
        """Return every balance that holds anything, plainest first."""
        if self.held:
            return self.telling
        most = min(len(self.sides.efforts), MOST_TOGETHER)
        return (*self.alone, *self._every(range(2, most + 1)))

    @cached_property
    def alone(self) -> tuple[ValuedBalance, ...]:
        """Return the balances of single bodies."""
        return self._every(range(1, 2))

    @cached_property
    def spanning(self) -> tuple[ValuedBalance, ...]:
        """Return balances of single bodies that all others are sums of, at every place.

        They are those of forces and of moments about the mass centre, or all where it has no place.
        """
        found: list[ValuedBalance] = []
        with mp.workdps(DIGITS):
            for name, own in self.sides.efforts.items():
                if self.reachable(own.centre[0], (name,)):
                    found += self.about((name,), own.centre, own.frame)
                else:
                    found += self._on((name,), self._valued)
        return tuple(row for row in found if not row.empty)

    @property
    def held(self) -> tuple[Tie, ...]:
        """Return what the constraints of the machine ask for."""
        return self.sides.held.kept

    @cached_property
    def enforced(self) -> tuple[ValuedBalance, ...]:
        """Return the second rates of constraints, and what has no virtual power; of some alone."""
        if not self.held:
            return ()
        found = enforced(self.sides, self.held, trial_probes(self.frames))
        self.expressions |= dict(found)
        return tuple(row for row, _ in found)

    @cached_property
    def telling(self) -> tuple[ValuedBalance, ...]:
        """Return rows that all others are sums of; generalized forces act on no body."""
        if any(c.generalized and c.factor is not None for c in self.held):
            return self.enforced
        return (*self.enforced, *self.spanning)

    @property
    def in_any_axes(self) -> tuple[ValuedBalance, ...]:
        """Return balances of single bodies in all axes, where those in their own do not tell."""
        return self.alone if self.telling != self.enforced else ()

    def about(
        self, bodies: tuple[str, ...], place: Located, *frames: str
    ) -> Iterator[ValuedBalance]:
        """Yield balances of forces and of moments about one point, along the axes of frames."""
        axes = self._valued[0].distinct((f, axis) for f in frames for axis in AXES)
        spot = f"the origin of {frame_called(place[0])}"
        forces = [v.force(bodies) for v in self._valued]
        moments = [v.moment(bodies, place) for v in self._valued]
        for frame, axis in axes:
            yield self._row(Balance(bodies, "force", None, "", frame, axis), self._valued, forces)
            moment = Balance(bodies, "moment", place, spot, frame, axis)
            yield self._row(moment, self._valued, moments)

    @cached_property
    def _valued(self) -> list[Valued]:
        return [Valued(self.sides, probe) for probe in trial_probes(self.frames)]

    def _every(self, sizes: range) -> tuple[ValuedBalance, ...]:
        """Return the balances of so many bodies together that hold anything."""
        own = {name: effort.frame for name, effort in self.sides.efforts.items()}
        with mp.workdps(DIGITS):
            return tuple(
                row
                for size in sizes
                for bodies in filter(self._together, combinations(own, size))
                if all(self.frames.linked(own[bodies[0]], own[b]) for b in bodies)
                for row in self._on(bodies, self._valued)
                if not row.empty
            )

    def _together(self, bodies: tuple[str, ...]) -> bool:
        return hang_together(self.frames.machine, bodies)

    def _on(self, bodies: tuple[str, ...], valued: Sequence[Valued]) -> Iterator[ValuedBalance]:
        axes = self._axes(bodies, valued[0])
        forces = [v.force(bodies) for v in valued]
        for frame, axis in axes:
            yield self._row(Balance(bodies, "force", None, "", frame, axis), valued, forces)
        for spot, place in self._points(bodies, valued[0]):
            moments = [v.moment(bodies, place) for v in valued]
            central = self._central(bodies, place, valued[0])
            for frame, axis in axes:
                balance = Balance(bodies, "moment", place, spot, frame, axis, central)
                yield self._row(balance, valued, moments)

    def _row(
        self,
        balance: Balance,
        valued: Sequence[Valued],
        vectors: Sequence[NDArray[Any]],
    ) -> ValuedBalance:
        values = tuple(
            v.direction(balance.frame, balance.axis) @ vector
            for v, vector in zip(valued, vectors, strict=True)
        )
        return ValuedBalance(balance, values)

    def _central(self, bodies: tuple[str, ...], place: Located, valued: Valued) -> bool:
        """Tell whether a point is the mass centre of the one body, whatever it is called."""
        centre = self.sides.efforts[bodies[0]].centre
        if len(bodies) > 1 or not self.reachable(centre[0], bodies):
            return False
        return bool(max(abs(valued.place(centre) - valued.place(place))) < NOTHING)

    def _frames_of(self, bodies: tuple[str, ...]) -> list[str]:
        """Return the frames whose axes and origins are near at hand for these bodies."""
        efforts = [self.sides.efforts[b] for b in bodies]
        own = [effort.frame for effort in efforts]
        found = dict.fromkeys([*own, *(name for effort in efforts for name in effort.force)])
        found |= dict.fromkeys(w.along for w in self.sides.wrenches if w.body in bodies)
        found |= dict.fromkeys(w.point[0] for w in self.sides.wrenches if w.body in bodies)
        for name in [*found]:
            found |= dict.fromkeys(self.frames.chain(name))
        return [name for name in found if self.frames.linked(own[0], name)]

    def _axes(self, bodies: tuple[str, ...], valued: Valued) -> list[tuple[str, str]]:
        members = [self.frames.machine.body(name) for name in bodies]
        spun = [(m.frame, m.name) for m in members if m.spin_axis is not None]
        whole = [(frame, axis) for frame in self._frames_of(bodies) for axis in AXES]
        return valued.distinct([*whole, *spun])

    def _points(self, bodies: tuple[str, ...], valued: Valued) -> list[tuple[str, Located]]:
        """Return the points that moments of these bodies may be taken about."""
        acting = [w for w in self.sides.wrenches if w.body in bodies and w.force != ZERO]
        inner = {w.load for w in acting if sum(v.load == w.load for v in acting) > 1}
        alone = bodies if len(bodies) == 1 else ()
        near: list[tuple[str, Located]] = [
            *(
                (f"the origin of {frame_called(frame)}", (frame, ZERO))
                for frame in self._frames_of(bodies)
            ),
            *((f"the mass centre of {b}", self.sides.efforts[b].centre) for b in alone),
            *((f"the point of {w.load}", w.point) for w in acting if w.load not in inner),
        ]
        found: list[tuple[str, Located]] = []
        seen: list[NDArray[Any]] = []
        for spot, place in near:
            if not self.reachable(place[0], bodies):
                continue
            at = valued.place(place)
            if not any(max(abs(at - other)) < NOTHING for other in seen):
                found.append((spot, place))
                seen.append(at)
        return found

    def reachable(self, frame: str, bodies: tuple[str, ...]) -> bool:
        """Tell whether all that acts on bodies has a known place from a frame's origin."""
        ends = [self.sides.efforts[b].centre[0] for b in bodies]
        ends += [w.point[0] for w in self.sides.wrenches if w.body in bodies and w.force != ZERO]
        return all(self.frames.placed(frame, e) and self.frames.linked(frame, e) for e in ends)

    def written(self, row: ValuedBalance) -> Expr:
        """Return a balance as an expression that is zero, without unknowns that drop out of it."""
        if row not in self.expressions:
            self.expressions[row] = self._written(row)
        return self.expressions[row]

    def _written(self, row: ValuedBalance) -> Expr:
        frames, balance = self.frames, row.balance
        e = frames.direction(balance.axis)
        total: Expr = Integer(0)
        for body in balance.bodies:
            own = self.sides.efforts[body]
            if balance.point is not None and carries(frames, body, balance.point):
                moment = moment_about(frames, body, balance.point[1])
                total += (e.T * frames.carried(moment, own.frame, balance.frame))[0]
                continue
            force = sum((frames.carried(part, name, balance.frame)
                         for name, part in own.force.items()), ZERO)  # fmt: skip
            vector = force
            if balance.kind == "moment":
                vector = frames.carried(own.moment, own.frame, balance.frame)
                vector = vector + self._shift(balance, own.centre, force)
            total += (e.T * vector)[0]
        for w in self.sides.wrenches:
            if w.body in balance.bodies:
                total -= (e.T * self._load(balance, w))[0]
        return self.without_what_drops_out(row, total)

    def without_what_drops_out(self, row: ValuedBalance, total: Expr) -> Expr:
        """Return a balance that is zero, its coefficients named, without unknowns it holds not."""
        sheet = self.frames.sheet
        rest, slopes = sheet.split(total)
        kept = {u: c for u, c in slopes.items() if self.unknowns.index(u) in row.holds}
        return sheet.linear("balance", rest + sum((c * u for u, c in kept.items()), Integer(0)))

    def body_by_body(self) -> "Balances":
        """Return the balances of single bodies, about their mass centres only."""
        if self.held:
            return self
        fewer = Balances(self.frames, self.expressions, single=True)
        fewer.alone = self.alone
        fewer.rows = tuple(r for r in self.alone if r.balance.kind == "force" or r.balance.central)
        return fewer

    def at(self, row: ValuedBalance, valued: Valued) -> NDArray[Any]:
        """Return the coefficients of a balance at another place: the rest, then the unknowns."""
        b = row.balance
        if b.kind in ("constraint", "virtual power"):
            there: NDArray[Any] = row_valued(self.sides, self.expressions[row], valued.probe)
            return there
        vector = valued.force(b.bodies) if b.point is None else valued.moment(b.bodies, b.point)
        found: NDArray[Any] = valued.direction(b.frame, b.axis) @ vector
        return found

    def carried_vectors(self, balance: Balance) -> int:
        """Return how many vectors must be carried to other axes to write a balance."""
        efforts = [self.sides.efforts[b] for b in balance.bodies]
        own = [name for effort in efforts for name in (effort.frame, *effort.force)]
        own += [w.along for w in self.sides.wrenches if w.body in balance.bodies]
        return sum(frame != balance.frame for frame in own)

    def _shift(self, balance: Balance, place: Located, force: Matrix) -> Matrix:
        """Return the moment of a force at a place about the point of a balance."""
        assert balance.point is not None  # noqa: S101
        if force == ZERO:
            return ZERO
        arm = self.frames.apart(balance.point, place, balance.frame)
        known = {"M_G": ZERO, "rho_G": self.frames.sheet.column("arm", arm), "F": force}
        return by_law("moment_about_any_point", known)

    def _load(self, balance: Balance, w: Wrench) -> Matrix:
        force = self.frames.carried(w.force, w.along, balance.frame)
        if balance.kind == "force":
            return force
        return self.frames.carried(w.couple, w.along, balance.frame) + self._shift(
            balance, w.point, force
        )
