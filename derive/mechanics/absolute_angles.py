"""Links about parallel axes, by the accelerations of their absolute angles.

Turned by absolute angles, two links of one chain push each other by the cosine and the sine of the
angle between them alone, times constants: what hangs on a link is one mass at its hinge
(augmented bodies: Wittenburg, Dynamics of Multibody Systems, 5.3). So the diagonal is constant.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

from sympy import Expr, Integer, Matrix, Symbol, cos, sin

from derive.mechanics.frames import ZERO
from derive.mechanics.implied import Implied, Turned
from derive.mechanics.links import BASE, Links, Push
from derive.mechanics.mass_matrix import MassMatrix

Rotation = tuple[Expr, Expr]  # the cosine and the sine of an angle
NOT_TURNED: Rotation = (Integer(1), Integer(0))


def absolute_angles(machine: Links) -> "AbsoluteAngles | None":
    """Return the equations of links about parallel axes, None if some are not parallel."""
    if not machine.plain or len({link.axis for link in machine.links}) != 1:
        return None
    found = AbsoluteAngles(machine, MassMatrix())
    found.assemble()
    return found


def relative(machine: Links, found: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
    """Return the unknowns, those of angles less what their parents turn by."""
    absolute = {link.unknown: link for link in machine.links}
    made = {}
    for u, value in found.items():
        parent = absolute[u].parent if u in absolute else BASE
        less = Integer(0) if parent == BASE else found[machine.links[parent].unknown]
        made[u] = value - less
    return made


@dataclass
class AbsoluteAngles:
    """A mass matrix with its right side, and what it is made of.

    between : the cosine and sine of the angle from a link to one that it carries
    """

    machine: Links
    system: MassMatrix
    between: dict[tuple[int, int], Rotation] = field(default_factory=dict)

    def assemble(self) -> None:
        """Set up the mass matrix."""
        links, system = self.machine.links, self.system
        self.axis = links[0].axis
        self.bodies = self.machine.augmented()
        self.speeds: list[Expr] = []
        for link in links:
            above = Integer(0) if link.parent == BASE else self.speeds[link.parent]
            self.speeds.append(system.cut("speed", above + link.rate))
        self.squares = [system.cut("square", omega**2) for omega in self.speeds]
        for k, link in enumerate(links):
            x, y, _ = self._plane(Matrix(self.bodies[k].second.diagonal()))
            system.add(link.unknown, link.unknown, x + y)
            for inner, outer in self._pairs(k):
                self._pair(inner, outer, k)
            self._drifts(k)
        system.still(self.machine)
        for push in self.machine.pushes:
            self._pushed(push)
        for k, moment in self.machine.motors.items():
            system.act(links[k].unknown, moment)
            if links[k].parent != BASE:
                system.act(links[links[k].parent].unknown, -moment)

    def told(self, implied: Implied) -> Implied:
        """Return what slopes follow from with those by absolute angles, if these stand open."""
        links = self.machine.links
        slopes: list[dict[Symbol, Expr]] = [{} for _ in links]
        for (inner, outer), (c, s) in self.between.items():
            slopes[outer] |= {c: -s, s: c}
            if inner != BASE:
                slopes[inner] |= {c: s, s: -c}
        every = [*self.speeds, *(e for turn in self.between.values() for e in turn)]
        plain = len({e for e in every if e.is_Symbol}) == len(every)
        if not plain or any(k.cosine.func is not cos for k in links):
            return implied
        if any(k.sine != sin(*k.cosine.args) for k in links):
            return implied
        angles = (Turned(k.unknown, k.cosine.args[0], by, k.parent)
                  for k, by in zip(links, slopes, strict=True))  # fmt: skip
        rates = (Turned(k.unknown, k.rate, {omega: Integer(1)}, k.parent)
                 for k, omega in zip(links, self.speeds, strict=True))  # fmt: skip
        return replace(implied, angles=tuple(angles), rates=tuple(rates))

    def _plane(self, v: Matrix) -> tuple[Expr, Expr, Expr]:
        """Return the components that turn, then that along the axis."""
        return v[(self.axis + 1) % 3], v[(self.axis + 2) % 3], v[self.axis]

    def _pairs(self, k: int) -> Iterator[tuple[int, int]]:
        """Yield each link that carries link ``k``, and its own link on the way to that."""
        return ((inner, outer) for outer, inner in pairwise(self.machine.path(k)))

    def _pair(self, inner: int, outer: int, k: int) -> None:
        """Add how link ``k`` and one that carries it accelerate each other."""
        links, system = self.machine.links, self.system
        x, y, _ = self._plane(links[outer].hinge)
        u, v, _ = self._plane(self.bodies[k].first)
        c, s = self._turned(inner, k)
        dot, cross = x * u + y * v, x * v - y * u
        own, other = links[inner].unknown, links[k].unknown
        system.add(own, other, system.cut("along", dot * c - cross * s))
        across = system.cut("across", dot * s + cross * c)
        system.act(other, -across * self.squares[inner])
        system.act(own, across * self.squares[k])

    def _drifts(self, k: int) -> None:
        """Add how a link and what carries its chain through space accelerate each other."""
        links, system = self.machine.links, self.system
        root = self.machine.path(k)[-1]
        drift = links[root].drift
        assert drift is not None  # noqa: S101
        u, v, _ = self._plane(self._rotated(self._turned(BASE, k), self.bodies[k].first))
        x, y, _ = self._plane(drift.rest - self.machine.gravity)
        system.act(links[k].unknown, v * x - u * y)
        for unknown, d in drift.slopes.items():
            dx, dy, _ = self._plane(d)
            system.add(unknown, links[k].unknown, system.cut("along", u * dy - v * dx))
            system.act(unknown, (u * dx + v * dy) * self.squares[k])
        if k == root:
            system.translate(self.bodies[k].mass, drift, self.machine.gravity)

    def _pushed(self, push: Push) -> None:
        """Add the moments of a load about each hinge on the way to the base, and its power."""
        links, arm, drift = self.machine.links, push.arm, push.drift
        if push.link != BASE:
            self.system.act(links[push.link].unknown, push.couple[self.axis])
        if push.force == ZERO:
            return
        for k in self.machine.path(push.link):
            here = self._carried(push.force, push.along, k)
            self.system.act(links[k].unknown, arm.cross(here)[self.axis])
            arm, drift = links[k].hinge, links[k].drift
        assert drift is not None  # noqa: S101
        for unknown, d in drift.slopes.items():
            self.system.act(unknown, d.dot(self._carried(push.force, push.along, BASE)))

    def _carried(self, vector: Matrix, start: int, end: int) -> Matrix:
        """Return a vector along the axes of another link."""
        if start == end:
            return vector
        c, s = self._turned(BASE, end)
        return self._rotated((c, -s), self._rotated(self._turned(BASE, start), vector))

    def _rotated(self, turn: Rotation, vector: Matrix) -> Matrix:
        (c, s), (x, y, z) = turn, self._plane(vector)
        found = {(self.axis + 1) % 3: c * x - s * y, (self.axis + 2) % 3: s * x + c * y,
                 self.axis: z}  # fmt: skip
        return Matrix([found[k] for k in range(3)])

    def _turned(self, inner: int, outer: int) -> Rotation:
        """Return the cosine and sine of the angle from a link to one that it carries."""
        if inner == outer:
            return NOT_TURNED
        if (inner, outer) not in self.between:
            link = self.machine.links[outer]
            c, s = self._turned(inner, link.parent)
            p, q = link.cosine, link.sine
            self.between[inner, outer] = (
                self.system.cut("cos", c * p - s * q), self.system.cut("sin", s * p + c * q)
            )  # fmt: skip
        return self.between[inner, outer]
