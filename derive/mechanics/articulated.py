"""Links about any axes by articulated bodies, so that each link takes the same.

The moments about all axes while nothing unknown accelerates come from the passes of ``recursion``;
what moves then is found from the leaves on. A link with all that hangs on it answers how its hinge
turns and moves by a moment and a force: N = J alpha + V a, F = V^T alpha + M a, less what acts;
a free joint takes one direction off (Featherstone, Rigid Body Dynamics Algorithms, 7).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from sympy import Expr, Integer, Matrix, Symbol, eye, zeros

from derive.mechanics.frames import ZERO
from derive.mechanics.links import Link, Links
from derive.mechanics.mass_matrix import MassMatrix
from derive.mechanics.recursion import Recursion


@dataclass(frozen=True)
class HungLinks:
    """What a hinge answers with: J, V, M, and the moment and force that it takes at rest."""

    turning: Matrix
    coupled: Matrix
    mass: Matrix
    moment: Matrix
    force: Matrix

    def __add__(self, other: "HungLinks") -> "HungLinks":
        """Return both as one."""
        return HungLinks(
            self.turning + other.turning,
            self.coupled + other.coupled,
            self.mass + other.mass,
            self.moment + other.moment,
            self.force + other.force,
        )


@dataclass(frozen=True)
class FreeTurn:
    """How a link turns about its own axis: ``rest`` less slopes times how its hinge goes."""

    rest: Expr
    by_turning: Matrix
    by_moving: Matrix


def articulated(machine: Links, order: Sequence[Symbol]) -> dict[Symbol, Expr]:
    """Return what links accelerate by.

    order : in which unknowns are solved for that turn nothing
    """
    return _FromTheLeaves(machine, Recursion(machine, MassMatrix()).acted()).solved(order)


@dataclass
class _FromTheLeaves:
    machine: Links
    system: MassMatrix
    free: dict[int, FreeTurn] = field(default_factory=dict)

    def solved(self, order: Sequence[Symbol]) -> dict[Symbol, Expr]:
        links = self.machine.links
        whole = [_alone(link) for link in links]
        for k, link in reversed(list(enumerate(links))):
            own = self._seen(link, self._freed(k, whole[k]))
            if link.drift is None:
                whole[link.parent] += self._shifted(link.hinge, own)
                continue
            each = list(link.drift.slopes.items())
            for n, (u, d) in enumerate(each):
                self.system.act(u, -d.dot(own.force))
                for v, other in each[n:]:
                    self.system.add(u, v, d.dot(own.mass * other))
        self.system, base = self.system.solved([u for u in order if u in self.system.right])
        own_turns = self._outward(base)
        return {**self.system.definitions, **base, **own_turns}

    def _freed(self, k: int, own: HungLinks) -> HungLinks:
        """Return what a hinge answers with while its link turns freely about it."""
        system, link = self.system, self.machine.links[k]
        e, acting = link.axis, self.system.right[link.unknown]
        J, V = self._named("turning", own.turning), self._named("coupled", own.coupled)
        M = self._named("heavy", own.mass)
        moment, force = system.column("effort", own.moment), system.column("pull", own.force)
        inverse = system.cut("inverse", 1 / J[e, e])
        others = Matrix([0 if n == e else J[n, e] for n in range(3)])
        across = V[e, :].T
        by_turning = system.column("slope", others * inverse)
        by_moving = system.column("slope", across * inverse)
        left = system.cut("left", acting - moment[e])
        self.free[k] = FreeTurn(system.cut("rest", left * inverse), by_turning, by_moving)
        moment, force = moment + by_turning * left, force + by_moving * left
        moment[e] = acting
        J, V = J - by_turning * others.T, V - by_turning * across.T
        for n in range(3):
            J[n, e] = J[e, n] = V[e, n] = Integer(0)
        return HungLinks(J, V, M - by_moving * across.T, moment, force)

    def _named(self, name: str, values: Matrix) -> Matrix:
        """Return a matrix with every entry by a symbol, equal ones by one."""
        found: dict[Expr, Expr] = {}
        for value in values:
            if value not in found:
                found[value] = self.system.cut(name, value)
        return values.applyfunc(lambda value: found[value])

    def _symmetric(self, name: str, values: Matrix) -> Matrix:
        found = zeros(3, 3)
        for i in range(3):
            for j in range(i, 3):
                found[i, j] = found[j, i] = self.system.cut(name, values[i, j])
        return found

    def _seen(self, link: Link, own: HungLinks) -> HungLinks:
        """Return the same along the axes of the link's parent."""
        J = self._turned(link, self._symmetric("turning", own.turning))
        M = self._turned(link, self._symmetric("heavy", own.mass))
        V = self._turned(link, self._named("coupled", own.coupled))
        moment, force = (self._out(link, v) for v in (own.moment, own.force))
        return HungLinks(J, V, M, moment, force)

    def _turned(self, link: Link, T: Matrix) -> Matrix:
        """Return a tensor along the parent's axes."""
        cut, c, s, e = self.system.cut, link.cosine, link.sine, link.axis
        i, j = (e + 1) % 3, (e + 2) % 3
        twice = 2 * T[i, j] if T[i, j] == T[j, i] else T[i, j] + T[j, i]
        u = cut("spread", s * (T[j, j] - T[i, i]) - c * cut("twice", twice))
        w, v = cut("spread", s * u), cut("spread", c * u)
        found = zeros(3, 3)
        found[i, i], found[j, j], found[e, e] = T[i, i] + w, T[j, j] - w, T[e, e]
        found[i, j], found[j, i] = -v - T[j, i], -v - T[i, j]
        along, across = self._out(link, T[:, e]), self._out(link, T[e, :].T)
        for n in (i, j):
            found[n, e], found[e, n] = along[n], across[n]
        return self._named("turned", found)

    def _shifted(self, hinge: Matrix, own: HungLinks) -> HungLinks:
        """Return what a place that carries a hinge answers with."""
        arm = _crossing(hinge)
        V = self._named("coupled", own.coupled + arm * own.mass)
        J = own.turning + V * arm.T + arm * own.coupled.T
        for n, m in ((0, 1), (0, 2), (1, 2)):
            J[m, n] = J[n, m]
        return HungLinks(J, V, own.mass, own.moment + hinge.cross(own.force), own.force)

    def _outward(self, base: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
        """Return how angles accelerate."""
        system, turning, moving = self.system, list[Matrix](), list[Matrix]()
        found: dict[Symbol, Expr] = {}
        for k, link in enumerate(self.machine.links):
            if link.drift is None:
                alpha, a = turning[link.parent], moving[link.parent]
                alpha, a = alpha, a + alpha.cross(link.hinge)
            else:
                alpha, a = ZERO, ZERO
                for u, d in link.drift.slopes.items():
                    a += d * base[u]
            alpha, a = self._in(link, alpha), self._in(link, a)
            own, e = self.free[k], link.axis
            whole = own.rest - own.by_turning.dot(alpha) - own.by_moving.dot(a)
            whole = system.cut("whole", whole)
            found[link.unknown] = whole - alpha[e]
            alpha[e] = whole
            turning.append(system.column("alpha", alpha))
            moving.append(system.column("a", a))
        return found

    def _in(self, link: Link, vector: Matrix) -> Matrix:
        return self._rotated(link, vector, -link.sine)

    def _out(self, link: Link, vector: Matrix) -> Matrix:
        return self._rotated(link, vector, link.sine)

    def _rotated(self, link: Link, vector: Matrix, s: Expr) -> Matrix:
        c, e = link.cosine, link.axis
        i, j = (e + 1) % 3, (e + 2) % 3
        vector = self.system.column("part", vector)
        found = {i: c * vector[i] - s * vector[j], j: s * vector[i] + c * vector[j], e: vector[e]}
        return self.system.column("turned", Matrix([found[n] for n in range(3)]))


def _alone(link: Link) -> HungLinks:
    """Return what a link alone answers with."""
    second = link.bulk.second
    turning = (second.trace() * eye(3) - second).applyfunc(lambda x: x.expand())
    return HungLinks(turning, _crossing(link.bulk.first), link.bulk.mass * eye(3), ZERO, ZERO)


def _crossing(v: Matrix) -> Matrix:
    """Return the matrix that a column is crossed with by."""
    x, y, z = v
    return Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
