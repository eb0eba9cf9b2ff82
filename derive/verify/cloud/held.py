"""What constraints ask of a cloud of particles: positions that fulfil them, and no power lost.

Conditions are formulas and places as series in time; allowed velocities are differences of those of
two clouds, of which one moves by a rate more. Where a generalized force enforces a condition, it is
told by d'Alembert's principle: on no velocity have masses times accelerations another power than
what acts, and the force's own is that of the condition's rate.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from mpmath import mpf
from numpy.typing import NDArray

from derive.scene import Input, Scene
from derive.scene.constraint import Constraint, Meeting
from derive.scene.formula import Formula, evaluate
from derive.verify.cloud.balance import acting, at_instant
from derive.verify.cloud.history import History
from derive.verify.cloud.series import ARITHMETIC, Series, crossed, each, motion_series, series

MakeHistory = Callable[[Mapping[str, Any]], History]


def conditions_of(history: History) -> list[tuple[Constraint, Series]]:
    """Return every scalar that stays zero, as a series in time."""
    return [(one, s) for one in history.machine.constraints for s in _series(history, one)]


def _series(history: History, one: Constraint) -> list[Series]:
    if one.meeting is None:
        return [history.value(one.zero)]
    meeting = one.meeting
    here, there = (history.place(meeting.frame, meeting.at),
                   history.place(meeting.to_frame, meeting.to))  # fmt: skip
    apart = here - there
    if one.of_rates:
        apart = _particle(history, meeting.on, here)
        if meeting.against:
            apart = apart - _particle(history, meeting.against, there)
    axes = history.rotations[meeting.along]
    return [(axes @ history.column(direction)) @ apart for direction in meeting.directions]


def _particle(history: History, body: str, place: NDArray[Any]) -> NDArray[Any]:
    """Return the velocity of a body's particle that is at a place."""
    Q, centre = history.body(body), history.centre(body)
    turning = each(lambda x: x.rate(), Q) @ Q.T
    found: NDArray[Any] = each(lambda x: x.rate(), centre) + turning @ (place - centre)
    return found


def second_rates(history: History) -> list[Any]:
    """Return the second rate of every condition."""
    return [s.velocity if one.of_rates else s.acceleration for one, s in conditions_of(history)]


def distances_of(history: History) -> list[Any]:
    """Return every condition and its rate, those of rates alone."""
    each = [[s.value] if one.of_rates else [s.value, s.velocity]
            for one, s in conditions_of(history)]  # fmt: skip
    return [x for own in each for x in own]


def first_rates(history: History) -> list[Any]:
    """Return the rate of every condition, or the condition itself if it is of rates."""
    return [s.value if one.of_rates else s.velocity for one, s in conditions_of(history)]


def first_slopes(base: History, moved: History, rate: str) -> list[Any]:
    """Return how the first rates of all conditions change with a rate, one more where ``moved``.

    Where a formula is of rates it may be no line in them: it is followed as if that rate grew.
    """
    return [
        _slope_by(base, one.zero, rate) if one.of_rates and one.meeting is None else after - before
        for (one, _), after, before in zip(
            conditions_of(base), first_rates(moved), first_rates(base), strict=True)
    ]  # fmt: skip


def _slope_by(base: History, formula: Formula, rate: str) -> Any:
    still = {name: series(s.value) for name, s in base.scalars.items()}
    growing = {rate: motion_series(base.scalars[rate].value, mpf(1))}
    return evaluate(formula, still | growing, ARITHMETIC).velocity


@dataclass
class Allowed:
    """A machine at given values, and the velocities that its frames allow, one for each rate."""

    machine: Scene
    given: Mapping[str, Any]
    make: MakeHistory

    @cached_property
    def rates(self) -> tuple[str, ...]:
        """Return the names of the rates that motion is made of."""
        coordinates = (c.rate.name for c in self.machine.coordinates if isinstance(c.rate, Input))
        return (*coordinates, *(s.name for s in self.machine.speeds))

    @cached_property
    def _base(self) -> History:
        return self.make({})

    @cached_property
    def _moved(self) -> list[History]:
        return [self.make({name: self.given[name] + 1}) for name in self.rates]

    @cached_property
    def _slopes(self) -> list[list[Any]]:
        """Return of each rate how the first rates of all conditions change with it."""
        each = zip(self.rates, self._moved, strict=True)
        return [first_slopes(self._base, own, name) for name, own in each]

    @cached_property
    def _velocities(self) -> list[list[NDArray[Any]]]:
        """Return of each rate how the velocities of all particles change with it."""
        base = _velocities(self._base)
        return [[a - b for a, b in zip(_velocities(own), base, strict=True)]
                for own in self._moved]  # fmt: skip

    @cached_property
    def _turning(self) -> list[dict[str, NDArray[Any]]]:
        base = {b.name: _turns(self._base, b.name) for b in self.machine.bodies}
        return [{name: _turns(own, name) - base[name] for name in base} for own in self._moved]

    def left_over(self, history: History) -> list[Any]:
        """Return of each rate the power that masses times accelerations have beyond what acts."""
        pushes = [m * each(lambda x: x.acceleration, place)
                  for body in history.machine.bodies
                  for m, place in history.particles(body.name)]  # fmt: skip
        ours = {one.load for one in history.machine.constraints if one.load == one.name}
        loads = [one for load in history.machine.loads if load.name not in ours
                 for one in acting(history, load)]  # fmt: skip
        places = {b.name: at_instant(history.centre(b.name)) for b in history.machine.bodies}
        centres = self._centres
        rows = []
        for k in range(len(self.rates)):
            total = sum((f @ v for f, v in zip(pushes, self._velocities[k], strict=True)), mpf(0))
            for body, place, force, couple in loads:
                omega = self._turning[k][body]
                v = centres[k][body] + crossed(omega, place - places[body])
                total -= force @ v + couple @ omega
            for name, slope in zip(self._factors, self._slopes[k], strict=True):
                if name:
                    total -= history.scalars[name].value * slope
            rows.append(total)
        return rows

    def powers(self, history: History) -> list[Any]:
        """Return the power of each generalized force, on the rates as they are."""
        return [
            history.scalars[name].value * sum(
                (self._slopes[r][k] * self.given[rate] for r, rate in enumerate(self.rates)), mpf(0)
            )
            for k, name in enumerate(self._factors) if name and name in self._generalized
        ]  # fmt: skip

    @property
    def _generalized(self) -> frozenset[str]:
        return frozenset(one.factor for one in self.machine.constraints)

    @cached_property
    def _factors(self) -> list[str]:
        """Return what enforces each condition, "" where a load of the scene does."""
        found = []
        for one in self.machine.constraints:
            axes = one.meeting.axes if one.meeting else ("",)
            names = [f"{one.name}_{a}" if a else one.factor for a in axes]
            found += [name if one.load == one.name else "" for name in names]
        return found

    @cached_property
    def _centres(self) -> list[dict[str, NDArray[Any]]]:
        names = [b.name for b in self.machine.bodies]
        base = {n: _velocity(self._base.centre(n)) for n in names}
        return [{n: _velocity(own.centre(n)) - base[n] for n in names} for own in self._moved]


def _velocity(place: NDArray[Any]) -> NDArray[Any]:
    return each(lambda x: x.velocity, place)


def _velocities(history: History) -> list[NDArray[Any]]:
    bodies = history.machine.bodies
    return [_velocity(place) for b in bodies for _, place in history.particles(b.name)]


def _turns(history: History, body: str) -> NDArray[Any]:
    Q = history.body(body)
    spin = each(lambda x: x.velocity, Q) @ at_instant(Q).T
    return np.array([spin[2, 1], spin[0, 2], spin[1, 0]], dtype=object)


def generalized(machine: Scene) -> bool:
    """Tell whether a force enforces a constraint that acts on no body in particular."""
    return any(one.factor for one in machine.constraints)


def meetings(machine: Scene) -> tuple[Meeting, ...]:
    """Return the points that meet."""
    return tuple(one.meeting for one in machine.constraints if one.meeting is not None)
