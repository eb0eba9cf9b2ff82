"""The answers of a machine by its cloud: every unknown that the particles determine."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from mpmath import mp, mpf

from derive.scene import Scene
from derive.scene.constraint import distances
from derive.scene.formula import Formula
from derive.scene.results import written_out
from derive.verify.cloud.balance import at_instant, left_over, potential_energy
from derive.verify.cloud.held import Allowed, distances_of, generalized, second_rates
from derive.verify.cloud.history import History
from derive.verify.cloud.series import DIGITS, crossed, each, series

NOTHING, REDUNDANT = mpf(10) ** (8 - DIGITS), mpf(10) ** -30


@dataclass
class CloudAnswers:
    """A machine at given values; unknowns, energies and momenta as the cloud has them."""

    machine: Scene
    given: Mapping[str, Any]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Return the unknowns: reactions, then accelerations."""
        free = [m.unknown for m in (*self.machine.coordinates, *self.machine.speeds) if m.free]
        return (*(u.name for u in self.machine.unknowns), *free)

    def history(self, found: Mapping[str, Any]) -> History:
        """Return the machine in motion with unknowns as they are found, others zero."""
        history = History(
            self.machine, dict(self.given) | dict.fromkeys(self.names, mpf(0)) | dict(found)
        )
        for u in self.machine.unknowns:
            history.scalars[u.name] = series(history.values[u.name])
        return history

    @cached_property
    def _matrix(self) -> tuple[list[list[Any]], list[Any]]:
        """Return the six equations a body, which are linear in the unknowns."""
        rest = self._left_over(self.history({}))
        columns = [self._left_over(self.history({n: mpf(1)})) for n in self.names]
        rows = [[column[r] - rest[r] for column in columns] for r in range(len(rest))]
        return rows, [-x for x in rest]

    def _left_over(self, history: History) -> list[Any]:
        """Return what of all equations is left: of bodies, of powers, and of constraints.

        A generalized force acts on no body in particular: then powers alone tell.
        """
        if not self.machine.constraints:
            return left_over(history)
        rows = [] if generalized(self.machine) else left_over(history)
        return [*rows, *self.allowed.left_over(history), *second_rates(history)]

    @property
    def _nothing(self) -> Any:
        """Return what is less than anything: of redundant constraints, which states just fulfil."""
        return REDUNDANT if self.machine.constraints else NOTHING

    @cached_property
    def allowed(self) -> Allowed:
        """Return the velocities that the frames allow."""
        return Allowed(self.machine, self.given, self.history)

    @cached_property
    def _reduced(self) -> tuple[dict[int, list[Any]], Any]:
        """Return a row for each unknown that has a pivot, and the largest contradiction."""
        rows, right = self._matrix
        table = [[*row, b] for row, b in zip(rows, right, strict=True)]
        table = [[x / (max(map(abs, row)) or 1) for x in row] for row in table]
        pivots: dict[int, list[Any]] = {}
        for k in range(len(self.names)):
            free = [row for row in table if not any(row is p for p in pivots.values())]
            pivot = max(free, key=lambda row: abs(row[k]), default=None)
            if pivot is None or abs(pivot[k]) < self._nothing:
                continue
            pivot[:] = [x / pivot[k] for x in pivot]
            for row in table:
                if row is not pivot and row[k]:
                    row[:] = [x - row[k] * p for x, p in zip(row, pivot, strict=True)]
            pivots[k] = pivot
        left = [abs(row[-1]) for row in table if not any(row is p for p in pivots.values())]
        return pivots, max(left, default=mpf(0))

    @property
    def contradiction(self) -> Any:
        """Return how far the balances that no unknown enters are from zero, beside their terms."""
        with mp.workdps(DIGITS):
            return self._reduced[1]

    @cached_property
    def unknowns(self) -> dict[str, Any]:
        """Return the value of every unknown that the particles determine."""
        with mp.workdps(DIGITS):
            pivots, _ = self._reduced
            found = {}
            for k, row in pivots.items():
                others = [abs(x) for n, x in enumerate(row[:-1]) if n != k]
                if max(others, default=mpf(0)) < self._nothing:
                    found[self.names[k]] = row[-1]
            return found

    @property
    def some(self) -> dict[str, Any]:
        """Return values of all unknowns that satisfy the balances; zero where any value does."""
        with mp.workdps(DIGITS):
            return {self.names[k]: row[-1] for k, row in self._reduced[0].items()}

    @cached_property
    def momenta(self) -> dict[str, Any]:
        """Return energies and angular momentum, summed over the particles."""
        with mp.workdps(DIGITS):
            history, place = self.history({}), self.machine.momentum
            about = at_instant(history.place(place.frame, place.at))
            energy, momentum = mpf(0), 0 * about
            for body in self.machine.bodies:
                for m, at in history.particles(body.name):
                    v = each(lambda x: x.velocity, at)
                    energy += m * (v @ v) / 2
                    if body.name in place.of:
                        momentum = momentum + m * crossed(at_instant(at) - about, v)
            along = at_instant(history.rotations[place.frame]).T @ momentum
            names = (f"angular_momentum_{axis}" for axis in "xyz")
            height = potential_energy(history)
            energies = {"kinetic_energy": energy, "potential_energy": height}
            energies["energy"] = energy + height
            return energies | self.distances | dict(zip(names, along, strict=True))

    @cached_property
    def distances(self) -> dict[str, Any]:
        """Return what is 0 where the constraints hold."""
        names = [name for name, _ in distances(self.machine.constraints)]
        with mp.workdps(DIGITS):
            return dict(zip(names, distances_of(self.history({})), strict=True))

    @cached_property
    def momentum_rate(self) -> dict[str, Any]:
        """Return the rate of the angular momentum relative to its point, in the inertial frame."""
        with mp.workdps(DIGITS):
            history, place = self.history(self.unknowns), self.machine.momentum
            point, total = history.place(place.frame, place.at), np.array([mpf(0)] * 3)
            for body in place.of:
                for m, at in history.particles(body):
                    a = each(lambda x: x.rate().velocity, at - point)
                    total = total + m * crossed(at_instant(at - point), a)
            along = at_instant(history.rotations[place.frame]).T @ total
            return dict(zip((f"rate_absolute_{axis}" for axis in "xyz"), along, strict=True))

    def rate(self, name: str) -> Any:
        """Return the rate of a state, None if it is none or an acceleration is not determined."""
        free = [m.unknown for m in (*self.machine.coordinates, *self.machine.speeds) if m.free]
        if not set(free) <= set(self.unknowns):
            return None
        with mp.workdps(DIGITS):
            scalars = self.history(self.unknowns).scalars
            attitudes = tuple(f"{f.attitude}_" for f in self.machine.frames if f.attitude)
            known = name in scalars and not name.startswith(attitudes)
            return scalars[name].velocity if known else None

    def result(self, formula: Formula, also: Mapping[str, Any] | None = None) -> Any:
        """Return the value of a formula of answers, and of what is ``also`` known by name."""
        with mp.workdps(DIGITS):
            history = self.history(self.unknowns)
            known = self.unknowns | self.momenta | dict(also or {})
            history.scalars.update({n: series(v) for n, v in known.items()})
            return history.value(written_out(formula, self.machine.results)).value


def answers(machine: Scene, given: Mapping[str, float]) -> CloudAnswers:
    """Return what the cloud of ``machine`` answers at values of all that is given."""
    with mp.workdps(DIGITS):
        return CloudAnswers(machine, {name: mpf(x) for name, x in given.items()})
