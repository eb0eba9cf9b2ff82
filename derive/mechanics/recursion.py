"""Links about any axes, by one pass outward, of motions, and two inward, of moments and masses.

Each vector is along its own link's axes. The passes are those of Newton and Euler and of composite
bodies (Featherstone, Rigid Body Dynamics Algorithms, 5 and 6) for augmented bodies: what hangs on
a link is a mass at its hinge, and mass on the axis of a hinge is the parent's, so most is constant.
A body turning needs K r of each of its particles, K = alpha x + omega x omega x.
"""

from dataclasses import dataclass, field

from sympy import Expr, Integer, Matrix, Symbol, eye, zeros

from derive.mechanics.bulk import Bulk, at_point
from derive.mechanics.frames import ZERO
from derive.mechanics.links import BASE, Link, Links, Rotor, without_mass_on_axes
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
        u: sign * (moments[k][machine.links[k].axis] - machine.motors.get(k, Integer(0)))
        for k, (u, sign) in machine.drives.items()
    }
    return {**own.system.definitions, **found}


@dataclass
class Recursion:
    """The passes of a machine, outward and inward.

    above : how hinges accelerate while nothing unknown does, gravity taken off, along the axes of
            the parent; ``a`` the same along the link's
    """

    machine: Links
    system: MassMatrix
    omega: list[Matrix] = field(default_factory=list)
    alpha: list[Matrix] = field(default_factory=list)
    K: list[Matrix] = field(default_factory=list)
    above: list[Matrix] = field(default_factory=list)
    a: list[Matrix] = field(default_factory=list)

    def acted(self) -> MassMatrix:
        """Return all but the mass matrix of links: its right side, and masses that do not turn."""
        machine, system = self.machine, self.system
        self.follow()
        for link, moment in zip(machine.links, self.moments(), strict=True):
            for u, e in link.turning.slopes.items():
                system.act(u, -e.dot(moment))
        for k, link in enumerate(machine.links):
            if link.drift is not None:
                rest = self.bodies[k].mass * self.above[k]
                for u, d in link.drift.slopes.items():
                    system.act(u, -d.dot(rest))
        for k, moment in machine.motors.items():
            for u, e in machine.links[k].turning.slopes.items():
                system.act(u, e[machine.links[k].axis] * moment)
        for wheel in (w for w in machine.wheels if w.link != BASE):
            self._spun(wheel)
        system.still(machine)
        return system

    def assembled(self) -> MassMatrix:
        """Return the mass matrix and its right side."""
        self.acted()
        self._masses()
        return self.system

    def follow(self) -> None:
        """Follow the links outward."""
        self.bodies = without_mass_on_axes(self.machine)
        parts = [p for b in self.bodies for p in (b.mass, *b.first, *b.second)]
        self.data = frozenset(s for p in parts for s in p.free_symbols)
        for k in range(len(self.machine.links)):
            self._moves(k)

    def _moves(self, k: int) -> None:
        """Add how a link moves while nothing unknown accelerates, gravity taken off."""
        system, link, p = self.system, self.machine.links[k], self.machine.links[k].parent
        omega, alpha = ZERO, ZERO
        if p != BASE:
            omega, alpha = self._in(link, self.omega[p]), self._in(link, self.alpha[p])
        self.above.append(self._hinge(k))
        self.a.append(self._in(link, self.above[k]))
        turning = omega.cross(link.spin) + link.turning.rest
        self.alpha.append(system.column("alpha", alpha + turning))
        self.omega.append(system.column("turning", omega + link.spin))
        self.K.append(self._turning(self.omega[-1], self.alpha[-1]))

    def _hinge(self, k: int) -> Matrix:
        """Return how a hinge moves while nothing unknown accelerates, gravity taken off."""
        link, p = self.machine.links[k], self.machine.links[k].parent
        if link.drift is None:
            return self.a[p] + self.K[p] * link.hinge
        if p == BASE:
            return link.drift.rest - self._gravity(k)
        seen = link.drift.rest + 2 * self.omega[p].cross(link.going)
        hinge = self.system.column("hinge", link.hinge)
        return self.system.column("above", self.a[p] + self.K[p] * hinge + seen)

    def _gravity(self, k: int) -> Matrix:
        """Return gravity along the axes of the base, which a link turns in that it hangs on."""
        level, gravity = self.machine.level, self.machine.gravity
        if level == k:
            return self._out(self.machine.links[k], gravity)
        return gravity if level == BASE else ZERO

    def _turning(self, omega: Matrix, alpha: Matrix) -> Matrix:
        """Return K, of which each entry takes an operation once its products are there."""
        cut, (x, y, z) = self.system.cut, omega
        xx, yy, zz = (cut("square", w**2) for w in omega)
        xy, xz, yz = cut("product", x * y), cut("product", x * z), cut("product", y * z)
        a, b, c = alpha
        K = Matrix([[-yy - zz, xy - c, xz + b], [xy + c, -xx - zz, yz - a],
                    [xz - b, yz + a, -xx - yy]])  # fmt: skip
        return K.applyfunc(lambda entry: cut("K", entry))

    def moments(self) -> list[Matrix]:
        """Return the moments at each hinge of all outboard, without what unknowns need."""
        links, system = self.machine.links, self.system
        forces, moments = [[ZERO] * len(links) for _ in range(2)]
        about = [ZERO] * len(links)
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
        for wheel in (w for w in self.machine.wheels if w.link != BASE):
            moments[wheel.link] += self._whirled(wheel)
        for k, link in reversed(list(enumerate(links))):
            bulk, K = self.bodies[k], self.K[k]
            own = _crossed(bulk.second, K) + bulk.first.cross(self.a[k])
            about[k] = system.column("effort", own + moments[k])
            force = self._out(link, system.column("pull", K * bulk.first + forces[k]))
            for u, d in link.drift.slopes.items() if link.drift else ():
                system.act(u, -d.dot(force))
            if link.parent == BASE:
                continue
            force += ZERO if link.drift is None else bulk.mass * self.above[k]
            forces[link.parent] += force
            moments[link.parent] += self._out(link, about[k]) + link.hinge.cross(force)
        return about

    def _whirled(self, wheel: Rotor) -> Matrix:
        """Return the moment that the spin of a wheel takes, without what unknowns need."""
        whirl = self.system.column("whirl", wheel.inertia * wheel.spin)
        return wheel.inertia * wheel.spinning.rest + self.omega[wheel.link].cross(whirl)

    def _spun(self, wheel: Rotor) -> None:
        """Add what a wheel takes by its spin."""
        turned = self.alpha[wheel.link] + self.omega[wheel.link].cross(wheel.spin)
        for u, d in wheel.spinning.slopes.items():
            self.system.act(u, -wheel.inertia * d.dot(turned + wheel.spinning.rest))

    def _masses(self) -> None:
        """Add what the acceleration of each joint alone takes at it and at all inboard."""
        links, system = self.machine.links, self.system
        whole = list(self.bodies)
        for wheel in (w for w in self.machine.wheels if w.link != BASE):
            each = [*wheel.spinning.slopes.items()]
            system.alike(each, [wheel.inertia * d for _, d in each])
            for u, d in each:
                self._at(wheel.link, u, ZERO, wheel.inertia * d)
        for k, link in reversed(list(enumerate(links))):
            first = system.column("first", whole[k].first)
            second = self._symmetric(whole[k].second)
            turns = [*link.turning.slopes.items()]
            inertia = second.trace() * eye(3) - second
            moments = [(inertia * w).applyfunc(lambda x: x.expand()) for _, w in turns]
            system.alike(turns, moments)
            for (u, w), moment in zip(turns, moments, strict=True):
                self._inboard(k, u, w.cross(first), moment)
            if link.drift is not None:
                slides, m = [*link.drift.slopes.items()], whole[k].mass
                system.alike(slides, [m * d for _, d in slides])
                arm = self._out(link, first)
                for u, d in slides:
                    self._beyond(k, u, m * d, arm.cross(d))
            if link.parent != BASE:
                augmented = self.bodies[k].mass if link.drift is None else Integer(0)
                m = whole[k].mass - augmented
                whole[link.parent] += self._hung(link, m, first, second)

    def _hung(self, link: Link, m: Expr, first: Matrix, second: Matrix) -> Bulk:
        """Return what a link adds to its parent, which has all mass at fixed hinges but ``m``."""
        spread = self._turned(link, second)
        arm = self._out(link, first)
        offset = link.hinge * arm.T
        return Bulk(Integer(0), arm, spread + offset + offset.T) + at_point(m, link.hinge)

    def _both(self, u: Symbol, v: Symbol, value: Expr) -> None:
        """Add what two motions of different places take, which may be by one unknown."""
        self.system.add(u, v, 2 * value if u == v else value)

    def _at(self, k: int, u: Symbol, force: Matrix, moment: Matrix) -> None:
        """Add what an unknown takes beyond a link, at it and at all inboard, along its axes."""
        for v, w in self.machine.links[k].turning.slopes.items():
            self._both(u, v, w.dot(moment))
        self._inboard(k, u, force, moment)

    def _inboard(self, k: int, u: Symbol, force: Matrix, moment: Matrix) -> None:
        """Add what an unknown takes at the hinge of a link, and at all inboard."""
        link = self.machine.links[k]
        force = self._out(link, force)
        for v, d in link.drift.slopes.items() if link.drift else ():
            self._both(u, v, self.system.cut("along", d.dot(force)))
        if link.parent != BASE:
            self._beyond(k, u, force, self._out(link, moment))

    def _beyond(self, k: int, u: Symbol, force: Matrix, moment: Matrix) -> None:
        """Add what an unknown takes inboard of a hinge, along the axes of its parent."""
        link = self.machine.links[k]
        if link.parent == BASE:
            return
        moment = self.system.column("effort", moment + link.hinge.cross(force))
        self._at(link.parent, u, force, moment)

    def _symmetric(self, values: Matrix) -> Matrix:
        found = zeros(3, 3)
        for i in range(3):
            for j in range(i, 3):
                constant, varying = values[i, j].as_independent(
                    *self._varying(values[i, j]), as_Add=True
                )
                found[i, j] = found[j, i] = constant + self.system.cut("second", varying)
        return found

    def _varying(self, value: Expr) -> list[Symbol]:
        """Return what in a value is no datum of a link."""
        return sorted(value.free_symbols - self.data, key=str)

    def _turned(self, link: Link, P: Matrix) -> Matrix:
        """Return second moments along the parent's axes, by two products of sine and cosine."""
        if link.sine == 0:
            return P
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
        if link.attitude is not None:
            return link.attitude.T * self.system.column("part", vector)
        return self._rotated(link, vector, -link.sine)

    def _out(self, link: Link, vector: Matrix) -> Matrix:
        """Return a vector along the axes of a link's parent."""
        if link.attitude is not None:
            return link.attitude * self.system.column("part", vector)
        return self._rotated(link, vector, link.sine)

    def _rotated(self, link: Link, vector: Matrix, s: Expr) -> Matrix:
        if s == 0:
            return vector
        c, e = link.cosine, link.axis
        i, j = (e + 1) % 3, (e + 2) % 3
        vector = self.system.column("part", vector)
        found = {i: c * vector[i] - s * vector[j], j: s * vector[i] + c * vector[j], e: vector[e]}
        return self.system.column("turned", Matrix([found[n] for n in range(3)]))


def _crossed(P: Matrix, K: Matrix) -> Matrix:
    """Return the sum of m r x (K r), each entry of K once."""
    M = P * K.T
    crossed = Matrix([M[1, 2] - M[2, 1], M[2, 0] - M[0, 2], M[0, 1] - M[1, 0]])
    every = sorted({s for entry in K for s in entry.free_symbols}, key=str)
    return crossed.applyfunc(lambda e: sum((e.expand().coeff(k) * k for k in every), Integer(0)))
