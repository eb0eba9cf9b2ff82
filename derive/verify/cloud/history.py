"""Where every frame and particle of a machine is in time, from its declared angles and rates."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray

from derive.scene import Input, Scene, SceneError
from derive.scene.formula import Formula, evaluate
from derive.scene.machine import INERTIAL, Frame
from derive.verify.cloud.series import ARITHMETIC, Series, each, motion_series, series, turn

UNKNOWN = mpf(1)  # a mass or moment that the user left out, and that must not matter


@dataclass
class History:
    """A machine at given values of all that is known, and of the accelerations to be found."""

    machine: Scene
    values: Mapping[str, Any]

    @cached_property
    def scalars(self) -> dict[str, Series]:
        """Return every scalar as a series in time."""
        found = {"pi": series(+mp.pi)}
        for frame in self.machine.frames:  # a load may be a formula of them, at this instant
            parts = [f"{frame.attitude}_{p}" for p in "wxyz"] if frame.attitude else []
            found |= {name: series(self.values[name]) for name in parts}
        for p in self.machine.parameters:
            fixed = None if p.value is None else mpf(p.value.numerator) / p.value.denominator
            found[p.name] = series(self.values[p.name] if fixed is None else fixed)
        for m in (*self.machine.inputs, *self.machine.speeds):
            rate = self._rate(m.rate, found) if m.kind == "speed" and not m.free else mpf(0)
            rate = self.values[m.unknown] if m.free and m.kind == "speed" else rate
            found[m.name] = motion_series(self.values[m.name], rate)
            if isinstance(m.rate, Input):
                found[m.rate.name] = series(self.values[m.rate.name])
        for c in self.machine.coordinates:
            if isinstance(c.rate, Input):
                self._add_coordinate(c, found)
            else:
                found[c.name] = series(self.values[c.name])
        self._follow(found)
        return found

    def _follow(self, found: dict[str, Series]) -> None:
        """Move coordinates by formulas: values give their rates, then both give the second ones."""
        for _ in range(2):
            rates = {c.name: evaluate(c.rate, found, ARITHMETIC) for c in self.machine.coordinates
                     if isinstance(c.rate, Formula)}  # fmt: skip
            found |= {n: motion_series(self.values[n], rate.value, rate.velocity / 2)
                      for n, rate in rates.items()}  # fmt: skip

    def _rate(self, rate: Any, found: Mapping[str, Series]) -> Any:
        if isinstance(rate, Input):
            return self.values[rate.name]
        return mpf(0) if rate is None else evaluate(rate, found, ARITHMETIC).value

    def _add_coordinate(self, c: Any, found: dict[str, Series]) -> None:
        first = self.values[c.rate.name]
        second = self.values[c.unknown] if c.free else self._rate(c.acceleration, found)
        found[c.rate.name] = motion_series(first, second)
        if isinstance(c.acceleration, Input):
            found[c.acceleration.name] = series(second)
        found[c.name] = motion_series(self.values[c.name], first, second / 2)

    def value(self, formula: Formula) -> Series:
        """Return a formula as a series."""
        found: Series = evaluate(formula, self.scalars, ARITHMETIC)
        return found

    def column(self, formulas: tuple[Formula, ...]) -> NDArray[Any]:
        """Return formulas as a column of series."""
        return np.array([self.value(f) for f in formulas], dtype=object)

    @cached_property
    def rotations(self) -> dict[str, NDArray[Any]]:
        """Return the axes of every frame: components along it to components along N."""
        found: dict[str, NDArray[Any]] = {}
        for frame in self.machine.frames:
            if frame.name == INERTIAL:
                found[frame.name] = turn("x", series(0))
                continue
            found[frame.name] = found[frame.parent] @ self._in_parent(frame)
        return found

    def _in_parent(self, frame: Frame) -> NDArray[Any]:
        if frame.angular_velocity is not None:  # along its own axes
            skew = self._skew(frame.angular_velocity)
            return _carried_on(each(series, self._start(frame)), lambda R: R @ skew)
        R = turn("x", series(0))
        for one in frame.turned:
            R = R @ turn(one.axis, self.value(one.angle))
        return R

    def _skew(self, rate: tuple[Formula, ...]) -> NDArray[Any]:
        x, y, z = self.column(rate)
        zero = series(0)
        return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]], dtype=object)

    def _start(self, frame: Frame) -> NDArray[Any]:
        if not frame.attitude:
            return np.array([[mpf(i == k) for k in range(3)] for i in range(3)], dtype=object)
        parts = [self.values[f"{frame.attitude}_{p}"] for p in "wxyz"]
        w, x, y, z = (p / mp.sqrt(mp.fsum(q * q for q in parts)) for p in parts)
        return np.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ], dtype=object)  # fmt: skip

    @cached_property
    def origins(self) -> dict[str, NDArray[Any]]:
        """Return where the origin of every frame is, along N."""
        found: dict[str, NDArray[Any]] = {}
        still = np.array([series(0)] * 3, dtype=object)
        for frame in self.machine.frames:
            if frame.name == INERTIAL:
                found[frame.name] = still
            elif frame.acceleration is not None:  # from rest, or as seen moving along with it
                a = self.rotations[frame.name] @ self.column(frame.acceleration)
                found[frame.name] = each(lambda v: motion_series(0, 0, v.value / 2), a)
            elif frame.rolls is not None or frame.velocity is not None:
                found[frame.name] = each(lambda v: v.integral(mpf(0)), self._velocity(frame))
            else:
                placed = self.rotations[frame.parent] @ self.column(frame.origin)
                found[frame.name] = found[frame.parent] + placed
        return found

    def _velocity(self, frame: Frame) -> NDArray[Any]:
        """Return the velocity of an origin: given, or such that the particle in contact rests."""
        R = self.rotations[frame.name]
        if frame.velocity is not None:
            given: NDArray[Any] = R @ self.column(frame.velocity)
            return given
        assert frame.rolls is not None  # noqa: S101
        Q = self.body(frame.rolls.body)
        found: NDArray[Any] = -(each(lambda v: v.rate(), Q) @ Q.T) @ R @ self.column(frame.rolls.at)
        return found

    def body(self, name: str) -> NDArray[Any]:
        """Return the axes fixed in a body, to those of N: it spins in its frame's turned axes."""
        member = self.machine.body(name)
        R = self.rotations[member.frame]
        for one in member.turned:
            R = R @ turn(one.axis, self.value(one.angle))
        if member.angular_velocity is not None:  # along the axes of its frame
            skew = self._skew(member.angular_velocity)
            return np.asarray(R @ _carried_on(turn("x", series(0)), lambda Q: skew @ Q))
        if member.axis is None or (member.spin is None and member.axial_speed is None):
            return R
        if member.spin is not None:
            speed = self.value(member.spin)
        else:
            assert member.axial_speed is not None  # noqa: S101
            speed = self.value(member.axial_speed) - self._along(R, member.axis)
        return np.asarray(R @ turn(member.axis, speed.integral(mpf(0))))

    @staticmethod
    def _along(R: NDArray[Any], axis: str) -> Series:
        """Return how fast axes turn about one of themselves."""
        k = "xyz".index(axis)
        turning: Series = (R.T @ each(lambda v: v.rate(), R))[k - 1, k - 2]
        return turning

    def centre(self, name: str) -> NDArray[Any]:
        """Return where the mass centre of a body is."""
        member = self.machine.body(name)
        return self.place(member.frame, member.centre)

    def place(self, frame: str, at: tuple[Formula, ...]) -> NDArray[Any]:
        """Return where a point given in a frame is."""
        found: NDArray[Any] = self.origins[frame] + self.rotations[frame] @ self.column(at)
        return found

    def mass(self, name: str) -> Any:
        """Return the mass of a body."""
        own = self.machine.body(name).mass
        return UNKNOWN if own is None else self.value(own).value

    def particles(self, name: str) -> list[tuple[Any, NDArray[Any]]]:
        """Return masses and places of particles with the body's mass and second moments.

        Two on each principal axis and one at the centre. Where an inertia is less than nothing,
        as that of a wheel which another body counts as its own, so are two masses.
        """
        size = self.mass(name)
        centre, Q = self.centre(name), self.body(name)
        each_one = abs(size) / 6 or UNKNOWN
        moments, axes = mp.eigsy(self._second_moments(name))
        found, rest = [], size
        for k in range(3):
            reach = mp.sqrt(abs(moments[k]) / (2 * each_one))
            mass = each_one if moments[k] >= 0 else -each_one
            for side in (1, -1):
                own = np.array([series(side * reach * axes[i, k]) for i in range(3)], dtype=object)
                found.append((mass, centre + Q @ own))
                rest -= mass
        return [*found, (rest, centre)]

    def _second_moments(self, name: str) -> Any:
        """Return the sums of x_i x_k dm, from the declared moments and products."""
        entries = [UNKNOWN * (1 if k < 3 else 0) if f is None else self.value(f).value
                   for k, f in enumerate(self.machine.body(name).inertia)]  # fmt: skip
        xx, yy, zz, xy, xz, yz = entries
        if not all(map(mp.isfinite, entries)):  # nobody knows the root of what is about zero
            raise SceneError(f"body '{name}': its inertia has no value that can be told")
        half = (xx + yy + zz) / 2
        return mp.matrix([[half - xx, xy, xz], [xy, half - yy, yz], [xz, yz, half - zz]])


def _carried_on(start: NDArray[Any], rate: Callable[[NDArray[Any]], NDArray[Any]]) -> NDArray[Any]:
    """Return the axes that go on at a rate from where they are."""
    R = start
    for _ in range(2):
        moved = rate(R)
        R = np.array([[moved[i, k].integral(R[i, k].value) for k in range(3)]
                      for i in range(3)], dtype=object)  # fmt: skip
    return R
