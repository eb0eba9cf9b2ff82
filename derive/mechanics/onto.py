"""States brought onto the constraints of a machine by Newton's method: places, then rates.

Of all states that fulfil the constraints the one nearby is taken, distances counted in parts of the
declared ranges; so no coordinate need be chosen to follow the others, and none can fail to.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import Expr, Symbol, lambdify

from derive.mechanics.constraints import Partials, Tie
from derive.mechanics.frames import Frames
from derive.scene import Input

ROUNDS = 60
CLOSE = 1e-11  # of a condition beside the size of its slopes: what floats leave of it
FULFILLED = 1e-6  # of a range: what rates may be off by
TELLING = 1e-7  # a singular value below this part of the largest is none
FLAT = 1e-3  # of what it is elsewhere: a condition that changes with rates by less is lost there

Doubles = NDArray[Any]


@dataclass(frozen=True)
class Onto:
    """The conditions of a machine over the components of all that is given, and what may move.

    places : components that places are made of, each with the size of its range
    rates  : components that velocities are made of, each with the size of its range
    """

    frames: Frames
    conditions: tuple[Tie, ...]
    symbols: tuple[Symbol, ...]
    places: Mapping[int, float]
    rates: Mapping[int, float]

    def __getstate__(self) -> dict[str, Any]:
        """Return what another process needs: functions are made anew there."""
        return {name: x for name, x in self.__dict__.items() if name != "_functions"}

    def brought(self, points: Doubles) -> tuple[Doubles, Doubles]:
        """Return points (count, components) that fulfil the conditions, and which of them do."""
        found = np.array(points, float)
        fits = np.ones(len(found), bool)
        for n in range(len(found)):
            found[n], fits[n] = self._one(found[n])
        return found, fits

    def _one(self, point: Doubles) -> tuple[Doubles, bool]:
        here, columns, size = point, [*self.places], np.array([*self.places.values()])
        if self._of_places:
            for _ in range(ROUNDS):
                value, slopes = self._placed(here)
                scaled = slopes * size
                weight = np.linalg.norm(scaled, axis=1)
                weight = np.where(weight > 0, weight, 1.0)
                gap, own = value / weight, scaled / weight[:, None]
                if not np.all(np.isfinite(gap)):
                    return here, False
                if np.max(np.abs(gap)) < CLOSE * 1e-3:
                    break
                # damped by the square of what is left, which redundant conditions need
                damped = own.T @ own + min(1.0, float(gap @ gap)) * np.eye(len(columns))
                step = np.linalg.lstsq(damped, own.T @ gap, rcond=1e-15)[0]
                longest = float(np.max(np.abs(step)))
                here = here.copy()
                here[columns] -= size * step * min(1.0, 0.5 / longest if longest else 1.0)
            if np.max(np.abs(gap)) > CLOSE:
                return here, False
        return self._driven(here)

    def _driven(self, here: Doubles) -> tuple[Doubles, bool]:
        """Return a point with its rates moved, at once where conditions are linear in them."""
        columns, size = [*self.rates], np.array([*self.rates.values()])
        here = here.copy()
        for _ in range(ROUNDS):
            value, slopes = self._moving(here)
            scaled = slopes * size
            weight = np.linalg.norm(scaled, axis=1)
            weight = np.where(weight > 0, weight, 1.0)
            own, gap = scaled / weight[:, None], value / weight
            if not np.all(np.isfinite(gap)):
                return here, False
            step = np.linalg.lstsq(own, gap, rcond=TELLING)[0]
            here[columns] -= size * step
            far = np.max(np.abs(step), initial=0.0)
            if far < CLOSE:
                break
        left = np.max(np.abs(own @ step - gap), initial=0.0)
        return here, bool(max(left, far) < FULFILLED)

    def distances(self, points: Doubles) -> list[tuple[str, Doubles]]:
        """Return every condition and its rate at points (components, count), by names."""
        names = [f"constraint '{c.name}'" for c in self.conditions if c.place is not None]
        values = self._functions[0](*points)[: len(names)] if names else []
        names += [f"constraint '{c.name}'" if c.place is None else f"the rate of '{c.name}'"
                  for c in self.conditions]  # fmt: skip
        values = [*values, *self._functions[1](*points)[: len(self.conditions)]]
        return [*zip(names, values, strict=True)]

    def worst(self, point: Doubles) -> tuple[str, float]:
        """Return the condition that is furthest off, in sizes of ranges, and what it is."""
        each = []
        for slopes, sizes in ((self._placed if self._of_places else None, self.places),
                              (self._moving, self.rates)):  # fmt: skip
            if slopes is not None:
                values, by = slopes(point)
                weight = np.linalg.norm(by * np.array([*sizes.values()]), axis=1)
                each += list(np.abs(values) / np.where(weight > 0, weight, 1.0))
        name, value = self.distances(point)[int(np.argmax(each))]
        return name, float(value)

    def slopes(self, point: Doubles) -> Doubles:
        """Return how the first rates of all conditions change with the rates, (conditions, rates).

        Both are counted in sizes of ranges.
        """
        scaled, weight = self._scaled(point)
        return np.asarray(scaled / np.where(weight > 0, weight, 1.0)[:, None])

    def flat(self, before: Doubles, after: Doubles) -> Doubles:
        """Return which conditions change with nothing at a point that another was brought to."""
        was, now = self._scaled(before)[1], self._scaled(after)[1]
        return np.asarray(now < TELLING * was)

    def _scaled(self, point: Doubles) -> tuple[Doubles, Doubles]:
        """Return the slopes of first rates in sizes of ranges, and the length of each row."""
        scaled = self._moving(point)[1] * np.array([*self.rates.values()])
        return scaled, np.linalg.norm(scaled, axis=1)

    def lost(self, point: Doubles, usual: Doubles, rows: Sequence[int]) -> int | None:
        """Return the first of some conditions that says nothing of its own at a point, if any does.

        usual : a point at which all do
        """
        weight = self._scaled(usual)[1][[*rows], None]
        own = self._scaled(point)[0][[*rows]] / np.where(weight > 0, weight, 1.0)
        least = (np.linalg.svd(own[: k + 1], compute_uv=False)[-1] for k in range(len(rows)))
        return next((row for row, x in zip(rows, least, strict=True) if x < FLAT), None)

    @cached_property
    def _of_places(self) -> list[Expr]:
        return [self.plain(c.place) for c in self.conditions if c.place is not None]

    @cached_property
    def _functions(self) -> tuple[Any, Any]:
        moved = [self.symbols[k] for k in self.places]
        by, rates = Partials(self.frames), [self.symbols[k] for k in self.rates]
        placed = [*self._of_places, *(e.diff(s) for e in self._of_places for s in moved)]
        firsts = [c.first for c in self.conditions]
        moving = [*firsts, *(by.by(e, s) for e in firsts for s in rates)]
        flat = placed, [self.plain(e) for e in moving]
        first, second = (lambdify(self.symbols, e, modules="numpy", cse=True) for e in flat)
        return first, second

    def plain(self, e: Expr) -> Expr:
        """Return an expression without named quantities."""
        definitions = self.frames.sheet.needed([e])
        known: dict[Symbol, Expr] = {}
        for symbol, value in definitions.items():
            known[symbol] = value.xreplace(known)
        return e.xreplace(known)

    def _placed(self, point: Doubles) -> tuple[Doubles, Doubles]:
        return _split(self._functions[0](*point), len(self.places))

    def _moving(self, point: Doubles) -> tuple[Doubles, Doubles]:
        return _split(self._functions[1](*point), len(self.rates))


def _split(values: Sequence[Any], columns: int) -> tuple[Doubles, Doubles]:
    flat = np.array([float(v) for v in values])
    count = len(flat) // (columns + 1)
    return flat[:count], flat[count:].reshape(count, columns)


def onto(frames: Frames, every: tuple[Tie, ...]) -> Onto:
    """Return what brings states of a machine onto its conditions."""
    book, machine = frames.words.vocabulary, frames.machine
    each = [(c, q) for q in book.given() for c in q.components]
    names = [c for c, _ in each]
    size = {c: max(float(q.ends[1] - q.ends[0]), 1e-300) for c, q in each}
    states = [c for q in book.states for c in q.components]
    speeds = {s.name for s in machine.speeds}
    rates = [c.rate.name for c in machine.coordinates if c.free and isinstance(c.rate, Input)]
    rates += [s.name for s in machine.speeds if s.free]
    places = [c for c in states if c not in speeds and c not in rates]
    where = {c: k for k, c in enumerate(names)}
    hidden = tuple(frames.words.hidden)
    return Onto(
        frames, every, (*(book.symbols[c] for c in names), *hidden),
        {where[c]: size[c] for c in places if c in where},
        {where[c]: size[c] for c in rates},
    )  # fmt: skip
