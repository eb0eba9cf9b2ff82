"""Links about parallel axes solved for the accelerations of their absolute angles.

Turned by absolute angles, two links of one chain push each other by the cosine and the sine of the
angle between them alone, times constants: what hangs on a link is one mass at its hinge
(augmented bodies: Wittenburg, Dynamics of Multibody Systems, 5.3). The mass matrix is symmetric,
its diagonal is constant; L D L^T from one end divides by what is positive, as masses are.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from sympy import Expr, Integer, Symbol

from derive.lower.arrange.arrangement import Definition
from derive.lower.arrange.block import unused_symbol
from derive.mechanics.links import BASE, NO_VECTOR, Drift, Links, Push, Triad

Turned = tuple[Expr, Expr]  # the cosine and the sine of an angle
NOT_TURNED: Turned = (Integer(1), Integer(0))


@dataclass
class Named:
    """What is computed on the way, in order, each by a symbol."""

    definitions: list[Definition] = field(default_factory=list)

    def cut(self, name: str, value: Expr) -> Expr:
        """Return a symbol for a value, unless it is plain."""
        if value.is_Symbol or value.is_Number or (-value).is_Symbol:
            return value
        symbol = unused_symbol(name, {d.symbol for d in self.definitions})
        self.definitions.append(Definition("cut", symbol, value))
        return symbol


Augmented = tuple[Expr, Triad, Expr]  # mass, first and second moment about the hinge


@dataclass
class AbsoluteAngles:
    """The mass matrix and the right side of a machine of links, by unknown."""

    machine: Links
    named: Named = field(default_factory=Named)
    mass: dict[tuple[Symbol, Symbol], Expr] = field(default_factory=dict)
    right: dict[Symbol, Expr] = field(default_factory=dict)
    between: dict[tuple[int, int], Turned] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Assemble both sides."""
        links = self.machine.links
        self.bodies = _augmented(self.machine)
        self.speeds: list[Expr] = []
        for link in links:
            above = Integer(0) if link.parent == BASE else self.speeds[link.parent]
            self.speeds.append(self.named.cut("omega", above + link.rate))
        self.squares = [self.named.cut("omega^2", omega**2) for omega in self.speeds]
        for k, link in enumerate(links):
            self._add(link.unknown, link.unknown, self.bodies[k][2])
            for inner, outer in self._pairs(k):
                self._pair(inner, outer, k)
            self._drifts(k)
        for m, drift in self.machine.carried:
            self._translated(m, drift)
        for push in self.machine.pushes:
            self._pushed(push)
            if push.link != BASE:
                self._act(links[push.link].unknown, push.couple)

    def _pairs(self, k: int) -> Iterator[tuple[int, int]]:
        """Yield each link that carries link ``k``, and its own link on the way to that."""
        path = self.machine.path(k)
        return ((inner, outer) for outer, inner in pairwise(path))

    def _pair(self, inner: int, outer: int, k: int) -> None:
        """Add how link ``k`` and one that carries it accelerate each other."""
        links = self.machine.links
        x, y, _ = links[outer].hinge
        u, v, _ = self.bodies[k][1]
        c, s = self.turned(inner, k)
        dot, cross = x * u + y * v, x * v - y * u
        own, other = links[inner].unknown, links[k].unknown
        self._add(own, other, self.named.cut("along", dot * c - cross * s))
        across = self.named.cut("across", dot * s + cross * c)
        self._act(other, -across * self.squares[inner])
        self._act(own, across * self.squares[k])

    def _drifts(self, k: int) -> None:
        """Add how a link and what carries its chain through space accelerate each other."""
        links = self.machine.links
        root = self.machine.path(k)[-1]
        drift = links[root].drift
        assert drift is not None  # noqa: S101
        u, v, _ = _rotated(self.turned(BASE, k), self.bodies[k][1])
        known = _less(drift.rest, self.machine.gravity)
        self._act(links[k].unknown, v * known[0] - u * known[1])
        for unknown, (dx, dy, _) in drift.slopes.items():
            self._add(unknown, links[k].unknown, self.named.cut("along", u * dy - v * dx))
            self._act(unknown, (u * dx + v * dy) * self.squares[k])
        if k == root:
            self._translated(self.bodies[k][0], drift)

    def _translated(self, m: Expr, drift: Drift) -> None:
        """Add a mass that is carried through space."""
        known = _less(drift.rest, self.machine.gravity)
        each = list(drift.slopes.items())
        for n, (unknown, d) in enumerate(each):
            self._act(unknown, -m * _dot(d, known))
            for other, d_other in each[n:]:
                self._add(unknown, other, m * _dot(d, d_other))

    def _pushed(self, push: Push) -> None:
        """Add the moments of a force about each hinge on the way to the base, and its power."""
        links, arm, drift = self.machine.links, push.arm, push.drift
        if push.force == NO_VECTOR:
            return
        for k in self.machine.path(push.link):
            here = self._carried(push.force, push.along, k)
            self._act(links[k].unknown, arm[0] * here[1] - arm[1] * here[0])
            arm, drift = links[k].hinge, links[k].drift
        assert drift is not None  # noqa: S101
        for unknown, d in drift.slopes.items():
            self._act(unknown, _dot(d, self._carried(push.force, push.along, BASE)))

    def _carried(self, vector: Triad, start: int, end: int) -> Triad:
        """Return a vector along the axes of another link."""
        if start == end or vector[0] == 0 == vector[1]:
            return vector
        c, s = self.turned(BASE, start)
        here = _rotated((c, s), vector)
        c, s = self.turned(BASE, end)
        return _rotated((c, -s), here)

    def turned(self, inner: int, outer: int) -> Turned:
        """Return the cosine and sine of the angle from a link to one that it carries."""
        if inner == outer:
            return NOT_TURNED
        if (inner, outer) not in self.between:
            link = self.machine.links[outer]
            c, s = self.turned(inner, link.parent)
            p, q = link.cosine, link.sine
            self.between[inner, outer] = (
                self.named.cut("cos", c * p - s * q), self.named.cut("sin", s * p + c * q)
            )  # fmt: skip
        return self.between[inner, outer]

    def _add(self, a: Symbol, b: Symbol, value: Expr) -> None:
        for pair in dict.fromkeys(((a, b), (b, a))):
            self.mass[pair] = self.mass.get(pair, Integer(0)) + value

    def _act(self, unknown: Symbol, value: Expr) -> None:
        self.right[unknown] = self.right.get(unknown, Integer(0)) + value


def _augmented(machine: Links) -> list[Augmented]:
    """Return the moments of each link with all that hangs on it as a mass at its own hinge."""
    found: list[Augmented] = [(k.mass, k.first, k.second) for k in machine.links]
    for n, link in reversed(list(enumerate(machine.links))):
        if link.parent != BASE:
            m, first, second = found[link.parent]
            hung, (x, y, z) = found[n][0], link.hinge
            first = (first[0] + hung * x, first[1] + hung * y, first[2] + hung * z)
            found[link.parent] = (m + hung, first, second + hung * (x**2 + y**2))
    return found


def solved(system: AbsoluteAngles, order: Sequence[Symbol]) -> list[Definition]:
    """Return definitions that yield the unknowns, by L D L^T in an order."""
    named = Named(list(system.named.definitions))
    A, b = dict(system.mass), {u: named.cut("b", system.right.get(u, Integer(0))) for u in order}
    left, factors, inverses = list(order), dict[tuple[Symbol, Symbol], Expr](), []
    for u in order:
        left.remove(u)
        inverse = named.cut("inverse", 1 / A[u, u])
        inverses.append(inverse)
        held = [n for n in left if A.get((n, u), 0) != 0]
        for n in held:
            factors[n, u] = named.cut("factor", A[n, u] * inverse)
            b[n] = named.cut("b", b[n] - factors[n, u] * b[u])
        for place, n in enumerate(held):
            for m in held[place:]:
                entry = named.cut("a", A.get((n, m), Integer(0)) - factors[n, u] * A[m, u])
                A[n, m] = A[m, n] = entry
    found: dict[Symbol, Expr] = {}
    for u, inverse in reversed(list(zip(order, inverses, strict=True))):
        rest = sum((e * found[n] for (n, k), e in factors.items() if k == u), Integer(0))
        found[u] = named.cut("x", b[u] * inverse - rest)
    return [*named.definitions, *_relative(system.machine, found)]


def _relative(machine: Links, found: Mapping[Symbol, Expr]) -> list[Definition]:
    """Return the unknowns, those of angles less what their parents turn by."""
    absolute = {link.unknown: link for link in machine.links}
    made = []
    for u, value in found.items():
        parent = absolute[u].parent if u in absolute else BASE
        less = Integer(0) if parent == BASE else found[machine.links[parent].unknown]
        made.append(Definition("let", u, value - less))
    return made


def orders(machine: Links, unknowns: Sequence[Symbol]) -> list[tuple[Symbol, ...]]:
    """Return orders to solve in: from the leaves, with what does not turn last or first."""
    leaves = [link.unknown for link in reversed(machine.links)]
    others = [u for u in unknowns if u not in leaves]
    return list(dict.fromkeys([(*leaves, *others), (*others, *leaves), (*others, *leaves[::-1])]))


def _rotated(turn: Turned, vector: Triad) -> Triad:
    (c, s), (x, y, z) = turn, vector
    return c * x - s * y, s * x + c * y, z


def _less(a: Triad, b: Triad) -> Triad:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: Triad, b: Triad) -> Expr:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
