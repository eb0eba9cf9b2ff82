"""Links about any axes, by one pass outward, of motions, and two inward, of moments and masses.

Each vector is along its own link's axes. The passes are those of Newton and Euler and of composite
bodies (Featherstone, Rigid Body Dynamics Algorithms, 5 and 6) for augmented bodies: what hangs on
a link is a mass at its hinge, and mass on the axis of a hinge is the parent's, so most is constant.
A body turning needs K r of each of its particles, K = alpha x + omega x omega x.
"""

from dataclasses import dataclass, field

from sympy import Expr, Integer, Matrix, Symbol, zeros

from derive.lecture.turning import unit_vector
from derive.mechanics.bulk import Bulk
from derive.mechanics.frames import ZERO
from derive.mechanics.links import BASE, Link, Links
from derive.mechanics.mass_matrix import MassMatrix


def recursion(machine: Links) -> MassMatrix:
    """Return the mass matrix of links and its right side."""
    return Recursion(machine, MassMatrix()).assembled()


def driven(machine: Links) -> dict[Symbol, Expr]:
    """Return the moments that drive links as they are known to move, with what is on the way."""
    own = Recursion(machine, MassMatrix())
    own.follow()
    moments = own.moments()
    found = {
        u: sign * (moments[k] - machine.motors.get(k, Integer(0)))
        for k, (u, sign) in machine.drives.items()
    }
    return {**own.system.definitions, **found}


@dataclass
class Recursion:
    """The passes of a machine, outward and inward."""

    machine: Links
    system: MassMatrix
    omega: list[Matrix] = field(default_factory=list)
    K: list[Matrix] = field(default_factory=list)
    a: list[Matrix] = field(default_factory=list)

    def acted(self) -> MassMatrix:
        """Return all but the mass matrix of links: its right side, and masses that do not turn."""
        machine, system = self.machine, self.system
        self.follow()
        for link, moment in zip(machine.links, self.moments(), strict=True):
            system.act(link.unknown, -moment)
        for k, link in enumerate(machine.links):
            if link.drift is not None:
                rest = self.bodies[k].mass * (link.drift.rest - machine.gravity)
                for u, d in link.drift.slopes.items():
                    system.act(u, -d.dot(rest))
        for m, drift in machine.carried:
            system.translate(m, drift, machine.gravity)
        for k, moment in machine.motors.items():
            system.act(machine.links[k].unknown, moment)
        return system

    def assembled(self) -> MassMatrix:
        """Return the mass matrix and its right side."""
        self.acted()
        self._masses()
        return self.system

    def follow(self) -> None:
        """Follow the links outward."""
        self.bodies = _without_mass_on_axes(self.machine)
        alphas: list[Matrix] = []
        for link in self.machine.links:
            self._moves(link, alphas)

    def _moves(self, link: Link, alphas: list[Matrix]) -> None:
        """Add how a link moves while nothing unknown accelerates, gravity taken off."""
        system, e = self.system, unit_vector("xyz"[link.axis])
        if link.drift is not None:
            above, omega, alpha = link.drift.rest - self.machine.gravity, ZERO, ZERO
        else:
            p = link.parent
            above = self.a[p] + self.K[p] * link.hinge
            omega, alpha = self._in(link, self.omega[p]), self._in(link, alphas[p])
        self.a.append(self._in(link, above))
        turning = omega.cross(e) * link.rate + e * link.known
        alphas.append(system.column("alpha", alpha + turning))
        self.omega.append(system.column("turning", omega + e * link.rate))
        self.K.append(self._turning(self.omega[-1], alphas[-1]))

    def _turning(self, omega: Matrix, alpha: Matrix) -> Matrix:
        """Return K, of which each entry takes an operation once its products are there."""
        cut, (x, y, z) = self.system.cut, omega
        xx, yy, zz = (cut("square", w**2) for w in omega)
        xy, xz, yz = cut("product", x * y), cut("product", x * z), cut("product", y * z)
        a, b, c = alpha
        K = Matrix([[-yy - zz, xy - c, xz + b], [xy + c, -xx - zz, yz - a],
                    [xz - b, yz + a, -xx - yy]])  # fmt: skip
        return K.applyfunc(lambda entry: cut("K", entry))

    def moments(self) -> list[Expr]:
        """Return the moment about each axis of all outboard, without what unknowns need."""
        links, system = self.machine.links, self.system
        forces, moments = [[ZERO] * len(links) for _ in range(2)]
        about = [Integer(0)] * len(links)
        for push in self.machine.pushes:
            if push.link == BASE:
                force = self._carried(push.force, push.along, BASE)
                for u, d in push.drift.slopes.items() if push.drift else ():
                    system.act(u, d.dot(force))
                continue
            force = self._carried(push.force, push.along, push.link)
            forces[push.link] -= force
            moments[push.link] -= push.arm.cross(force)
            moments[push.link] -= self._carried(push.couple, push.along, push.link)
        for k, link in reversed(list(enumerate(links))):
            bulk, K = self.bodies[k], self.K[k]
            own = _crossed(bulk.second, K) + bulk.first.cross(self.a[k])
            moment = system.column("effort", own + moments[k])
            about[k] = moment[link.axis]
            force = self._out(link, system.column("pull", K * bulk.first + forces[k]))
            if link.drift is not None:
                for u, d in link.drift.slopes.items():
                    system.act(u, -d.dot(force))
                continue
            forces[link.parent] += force
            moments[link.parent] += self._out(link, moment) + link.hinge.cross(force)
        return about

    def _masses(self) -> None:
        """Add what the acceleration of each joint alone takes at it and at all inboard."""
        links, system = self.machine.links, self.system
        whole = list(self.bodies)
        for k, link in reversed(list(enumerate(links))):
            first = system.column("first", whole[k].first)
            second = self._symmetric(whole[k].second)
            e = unit_vector("xyz"[link.axis])
            moment = (second.trace() * e - second * e).applyfunc(lambda x: x.expand())
            system.add(link.unknown, link.unknown, moment[link.axis])
            force = e.cross(first)
            self._inboard(k, force, moment)
            if link.drift is not None:
                system.carry(whole[k].mass, link.drift)
                continue
            arm = self._out(link, first)
            spread = self._turned(link, second)
            offset = link.hinge * arm.T
            more = Bulk(Integer(0), arm, spread + offset + offset.T)
            whole[link.parent] = whole[link.parent] + more

    def _inboard(self, k: int, force: Matrix, moment: Matrix) -> None:
        links, system = self.machine.links, self.system
        for n in self.machine.path(k):
            link = links[n]
            if n != k:
                system.add(links[n].unknown, links[k].unknown, moment[link.axis])
            force = self._out(link, force)
            if link.drift is not None:
                for u, d in link.drift.slopes.items():
                    system.add(u, links[k].unknown, system.cut("along", d.dot(force)))
                return
            moment = system.column("effort", self._out(link, moment) + link.hinge.cross(force))

    def _symmetric(self, values: Matrix) -> Matrix:
        found = zeros(3, 3)
        for i in range(3):
            for j in range(i, 3):
                found[i, j] = found[j, i] = self.system.cut("second", values[i, j])
        return found

    def _turned(self, link: Link, P: Matrix) -> Matrix:
        """Return second moments along the parent's axes, by two products of sine and cosine."""
        cut, c, s, e = self.system.cut, link.cosine, link.sine, link.axis
        i, j = (e + 1) % 3, (e + 2) % 3
        u = cut("spread", s * (P[j, j] - P[i, i]) - 2 * c * P[i, j])
        w = cut("spread", s * u)
        found = zeros(3, 3)
        found[i, i], found[j, j], found[e, e] = P[i, i] + w, P[j, j] - w, P[e, e]
        found[i, j] = found[j, i] = -c * u - P[i, j]
        along = self._out(link, P[:, e])
        for n in (i, j):
            found[n, e] = found[e, n] = along[n]
        return found

    def _carried(self, vector: Matrix, start: int, end: int) -> Matrix:
        """Return a vector along the axes of another link."""
        inward, outward = (self.machine.path(k) for k in (start, end))
        for k in (k for k in inward if k not in outward):
            vector = self._out(self.machine.links[k], vector)
        for k in reversed([k for k in outward if k not in inward]):
            vector = self._in(self.machine.links[k], vector)
        return vector

    def _in(self, link: Link, vector: Matrix) -> Matrix:
        """Return a vector along a link's axes by that along its parent's."""
        return self._rotated(link, vector, -link.sine)

    def _out(self, link: Link, vector: Matrix) -> Matrix:
        """Return a vector along the axes of a link's parent."""
        return self._rotated(link, vector, link.sine)

    def _rotated(self, link: Link, vector: Matrix, s: Expr) -> Matrix:
        c, e = link.cosine, link.axis
        i, j = (e + 1) % 3, (e + 2) % 3
        vector = self.system.column("part", vector)
        found = {i: c * vector[i] - s * vector[j], j: s * vector[i] + c * vector[j], e: vector[e]}
        return self.system.column("turned", Matrix([found[n] for n in range(3)]))


def _crossed(P: Matrix, K: Matrix) -> Matrix:
    """Return the sum of m r x (K r)."""
    M = P * K.T
    return Matrix([M[1, 2] - M[2, 1], M[2, 0] - M[0, 2], M[0, 1] - M[1, 0]])


def _without_mass_on_axes(machine: Links) -> list[Bulk]:
    """Return augmented links, mass along the axis of each hinge added to the parent instead."""
    found = [k.bulk for k in machine.links]
    for n, link in reversed(list(enumerate(machine.links))):
        e = unit_vector("xyz"[link.axis])
        own = found[n]
        along, spread = own.first[link.axis], own.second[link.axis, link.axis]
        line = Bulk(own.mass, along * e, spread * e * e.T)
        found[n] = Bulk(own.mass, own.first - line.first, own.second - line.second)
        if link.parent != BASE:
            h = link.hinge
            offset = along * h * e.T
            moved = line.mass * h * h.T + offset + offset.T + line.second
            found[link.parent] += Bulk(line.mass, line.mass * h + line.first, moved)
    return found
