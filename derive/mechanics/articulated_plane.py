"""Links about parallel axes by articulated bodies, so that each link takes the same.

A hinge that turns freely passes on a force alone; what hangs on it answers how the hinge moves by a
symmetric mass matrix, two by two, and a force (Featherstone, Rigid Body Dynamics Algorithms, 7).
One pass inward finds these, one outward all that accelerates. All are along a link's own axes.
Where a link's mass is in line with its two hinges, it is a mass at each and a moment of inertia.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations_with_replacement

from sympy import Expr, Integer, Matrix, Symbol, cancel, eye, zeros

from derive.mechanics.links import BASE, Link, Links, Push
from derive.mechanics.mass_matrix import MassMatrix

NO_FORCE = zeros(2, 1)


@dataclass(frozen=True)
class Answering:
    """The force that a hinge takes: ``mass`` times its acceleration, and ``rest``."""

    mass: Matrix
    rest: Matrix


@dataclass(frozen=True)
class Beam:
    """A link in line with its two hinges: masses at both, a moment of inertia between them.

    along  : the place, 0 or 1, of the axis they are on      length : from one to the other, signed
    across : what moves the other hinge along the other axis while the link turns by one
    """

    along: int
    length: Expr
    across: Expr
    near: Expr
    far: Expr
    inertia: Expr


@dataclass(frozen=True)
class Swing:
    """How a link accelerates: by ``rest``, and by ``slope`` times how its hinge does."""

    rest: Expr
    slope: Matrix


def articulated_plane(machine: Links, order: Sequence[Symbol]) -> dict[Symbol, Expr] | None:
    """Return what links about parallel axes accelerate by, None if some are not parallel.

    order : in which unknowns are solved for that turn nothing
    """
    if not machine.plain or len({link.axis for link in machine.links}) != 1:
        return None
    return _Articulated(machine, MassMatrix(), machine.links[0].axis).solved(order)


@dataclass
class _Articulated:
    machine: Links
    system: MassMatrix
    axis: int
    squares: list[Expr] = field(default_factory=list)
    beams: list[Beam | None] = field(default_factory=list)
    hung: dict[int, list[tuple[Link, Answering]]] = field(default_factory=dict)
    turned: dict[int, Swing] = field(default_factory=dict)
    ends: dict[int, Expr] = field(default_factory=dict)
    a: list[Matrix] = field(default_factory=list)

    def solved(self, order: Sequence[Symbol]) -> dict[Symbol, Expr]:
        links, system = self.machine.links, self.system
        speeds: list[Expr] = []
        for link in links:
            above = Integer(0) if link.parent == BASE else speeds[link.parent]
            speeds.append(system.cut("speed", above + link.rate))
        self.squares = [system.cut("square", omega**2) for omega in speeds]
        self.beams = [self._beam(k) for k in range(len(links))]
        self._act()
        for k in reversed(range(len(links))):
            self._inward(k)
        system.still(self.machine)
        self.system, base = system.solved([u for u in order if u in system.right])
        own = self._outward(base)
        return {**self.system.definitions, **base, **own}

    def _beam(self, k: int) -> Beam | None:
        """Return a link as a beam if it carries one other, and both are where that is simple."""
        hung = [link for link in self.machine.links if link.parent == k]
        if len(hung) != 1:
            return None
        hinge, first = self._plane(hung[0].hinge), self._plane(self._first(k))
        on = [n for n in (0, 1) if hinge[n] != 0]
        if len(on) != 1 or first[1 - on[0]] != 0 or hinge[on[0]].is_nonzero is not True:
            return None
        length, sign = hinge[on[0]], (1, -1)[on[0]]
        far = cancel(first[on[0]] / length)
        if far.as_numer_denom()[1].free_symbols:
            return None
        inertia = cancel(self._inertia(k) / length**2 - far)
        return Beam(on[0], length, sign * length, self._mass(k) - far, far, inertia)

    def _inertia(self, k: int) -> Expr:
        """Return the moment of inertia of a link about its hinge."""
        x, y = self._plane(Matrix(self.machine.links[k].bulk.second.diagonal()))
        return x + y

    def _mass(self, k: int) -> Expr:
        return self.machine.links[k].bulk.mass

    def _first(self, k: int) -> Matrix:
        return self.machine.links[k].bulk.first

    def _plane(self, v: Matrix) -> Matrix:
        """Return the two components of a vector that turn."""
        return Matrix([v[(self.axis + 1) % 3], v[(self.axis + 2) % 3]])

    def _act(self) -> None:
        """Set forces at hinges, and moments about them, by all that is known to act."""
        links = self.machine.links
        self.force = [NO_FORCE for _ in links]
        self.moment = [Integer(0) for _ in links]
        for push in self.machine.pushes:
            self._pushed(push)
        for k, motor in self.machine.motors.items():
            self.moment[k] += motor
            if links[k].parent != BASE:
                self.moment[links[k].parent] -= motor

    def _pushed(self, push: Push) -> None:
        force = self._carried(self._plane(push.force), push.along, push.link)
        if push.link == BASE:
            for u, d in push.drift.slopes.items() if push.drift else ():
                self.system.act(u, self._plane(d).dot(force))
            return
        self.force[push.link] += force
        x, y = self._plane(push.arm)
        self.moment[push.link] += push.couple[self.axis] + x * force[1] - y * force[0]

    def _carried(self, vector: Matrix, start: int, end: int) -> Matrix:
        """Return a vector along the axes of another link."""
        inward, outward = (self.machine.path(k) for k in (start, end))
        for k in (k for k in inward if k not in outward):
            vector = self._out(self.machine.links[k], vector)
        for k in reversed([k for k in outward if k not in inward]):
            vector = self._in(self.machine.links[k], vector)
        return vector

    def _out(self, link: Link, v: Matrix) -> Matrix:
        c, s = link.cosine, link.sine
        x, y = self.system.column("part", v)
        return Matrix([c * x - s * y, s * x + c * y])

    def _in(self, link: Link, v: Matrix) -> Matrix:
        c, s = link.cosine, link.sine
        x, y = self.system.column("part", v)
        return Matrix([c * x + s * y, c * y - s * x])

    def _inward(self, k: int) -> None:
        """Let what a link's hinge answers with act on its parent."""
        link, system, beam = self.machine.links[k], self.system, self.beams[k]
        own = self._eliminated(k) if beam is None else self._beam_eliminated(k, beam)
        near = self._mass(k) if beam is None else beam.near
        own = self._seen(link, Answering(own.mass + near * eye(2), own.rest))
        if link.drift is None:
            self.hung.setdefault(link.parent, []).append((link, own))
            return
        slopes = {u: self._plane(d) for u, d in link.drift.slopes.items()}
        above = own.mass * self._plane(link.drift.rest - self.machine.gravity) + own.rest
        for u, d in slopes.items():
            system.act(u, -d.dot(above))
        for (u, d), (v, other) in combinations_with_replacement(slopes.items(), 2):
            system.add(u, v, d.dot(own.mass * other))

    def _eliminated(self, k: int) -> Answering:
        """Return what a hinge answers with while its link turns freely."""
        cut, column = self.system.cut, self.system.column
        square, first = self.squares[k], self._plane(self._first(k))
        mass, rest = zeros(2, 2), -square * first - self.force[k]
        across, inertia, moment = _across(first), self._inertia(k), -self.moment[k]
        for link, own in self.hung.get(k, []):
            hinge = self._plane(link.hinge)
            pulled = column("pull", own.rest - own.mass * (square * hinge))
            heavy = column("heavy", own.mass * _across(hinge))
            mass, rest, across = mass + own.mass, rest + pulled, across + heavy
            inertia += _across(hinge).dot(heavy)
            moment += _across(hinge).dot(pulled)
        across, inverse = column("across", across), cut("inverse", 1 / inertia)
        slope = column("slope", across * inverse)
        moment = cut("effort", moment)
        self.turned[k] = Swing(cut("rest", inverse * moment), slope)
        mass = mass - across * slope.T
        own = _symmetric(column("mass", Matrix(mass.diagonal())), cut("mass", mass[0, 1]))
        return Answering(own, column("rest", rest - slope * moment))

    def _beam_eliminated(self, k: int, beam: Beam) -> Answering:
        """Return the same of a beam: of the other hinge, a part of what it answers with."""
        cut, (a, b) = self.system.cut, (beam.along, 1 - beam.along)
        ((_, own),) = self.hung[k]
        square = cut("outward", self.squares[k] * beam.length)
        mass = own.mass + beam.far * eye(2)
        along, across = self.system.column("pull", own.rest - square * mass[:, a])[:: 1 - 2 * a]
        driven = self.moment[k] / beam.across
        inverse = cut("inverse", 1 / (beam.inertia + mass[b, b]))
        slope, left = cut("slope", inverse * mass[a, b]), cut("left", beam.inertia * inverse)
        moment = cut("effort", across - driven)
        rest = cut("rest", inverse * moment)
        self.turned[k] = Swing(rest, _placed(a, slope, left))
        both = cut("mass", left * mass[a, b])
        far = cut("mass", mass[a, a] - slope * mass[a, b]), cut("mass", left * mass[b, b])
        forces = _placed(a, along - slope * moment, beam.inertia * rest + driven) - self.force[k]
        return Answering(_symmetric(_placed(a, *far), both), self.system.column("rest", forces))

    def _seen(self, link: Link, own: Answering) -> Answering:
        """Return the same along the axes of the link's parent."""
        cut, c, s, ((x, xy), (_, y)) = self.system.cut, link.cosine, link.sine, own.mass.tolist()
        u = cut("spread", s * (y - x) - 2 * c * xy)
        w = cut("spread", s * u)
        diagonal = cut("mass", x + w), cut("mass", y - w)
        rest = self.system.column("rest", self._out(link, own.rest))
        return Answering(_symmetric(Matrix(diagonal), cut("mass", -c * u - xy)), rest)

    def _outward(self, base: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
        """Return how angles accelerate, each less what its parent turns by."""
        links, system = self.machine.links, self.system
        found: dict[Symbol, Expr] = {}
        alphas: list[Expr] = []
        for k, link in enumerate(links):
            if link.drift is None:
                above, less = self._carried_on(link, alphas[link.parent]), alphas[link.parent]
            else:
                above, less = self._plane(link.drift.rest - self.machine.gravity), Integer(0)
                for u, d in link.drift.slopes.items():
                    above += self._plane(d) * base[u]
            here = system.column("above", self._in(link, above))
            alphas.append(system.cut("alpha", self._turns(k, here)))
            self.a.append(here)
            found[link.unknown] = alphas[k] - less
        return found

    def _turns(self, k: int, here: Matrix) -> Expr:
        """Return how a link turns whose hinge accelerates."""
        own, beam = self.turned[k], self.beams[k]
        if beam is None:
            return -own.rest - own.slope.dot(here)
        a, b = beam.along, 1 - beam.along
        across = own.slope[b] * here[b] - own.slope[a] * here[a] - own.rest
        self.ends[k] = self.system.cut("across", across)
        return (self.ends[k] - here[b]) / beam.across

    def _carried_on(self, link: Link, alpha: Expr) -> Matrix:
        """Return how a link's hinge accelerates, along its parent's axes."""
        here, hinge = self.a[link.parent], self._plane(link.hinge)
        beam = self.beams[link.parent]
        if beam is None:
            return here + alpha * _across(hinge) - self.squares[link.parent] * hinge
        outward = self.squares[link.parent] * beam.length
        return _placed(beam.along, here[beam.along] - outward, self.ends[link.parent])


def _across(v: Matrix) -> Matrix:
    """Return how a point moves where what it is on turns by one."""
    return Matrix([-v[1], v[0]])


def _placed(along: int, first: Expr, second: Expr) -> Matrix:
    """Return a column whose component at a place is the first of two."""
    return Matrix([first, second][:: 1 - 2 * along])


def _symmetric(diagonal: Matrix, both: Expr) -> Matrix:
    return Matrix([[diagonal[0], both], [both, diagonal[1]]])
