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
from sympy import Expr, Integer, Symbol, lambdify

from derive.mechanics.constraints import Tie
from derive.mechanics.frames import Frames
from derive.scene import Input

ROUNDS, SOON = 80, 40
"""Corrections at most, and those that are damped by what is left: then by its square alone.

By what is left, states stay where redundant conditions say nothing; weak ones need the other.
"""
CLOSE = 1e-11  # of a condition beside the size of its slopes: what floats leave of it
FULFILLED = 1e-6  # of a range: what rates may be off by
TELLING = 1e-7  # a singular value below this part of the largest is none
CUT, WELL = 1e-12, 1e-3  # the same where places are sought; a part of what is close enough
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
        found, fits = np.array(points, float), np.ones(len(points), bool)
        with np.errstate(all="ignore"):  # what is no number fits nothing
            if self.of_places:
                fits = self._with_places(found)
            return found, self._with_rates(found, fits)

    def _with_places(self, points: Doubles) -> Doubles:
        """Move places of points, and return which fulfil the conditions then."""
        columns, size = np.array([*self.places], int), np.array([*self.places.values()])
        fits, left = np.zeros(len(points), bool), np.arange(len(points))
        for turn in range(ROUNDS):
            value, slopes = self._placed(points[left])
            own, gap = _of_size_one(slopes * size, value)
            known = _finite(own, gap)
            fits[left[~known]] = False
            left, own, gap = left[known], own[known], gap[known]
            off = np.max(np.abs(gap), axis=1, initial=0.0)
            fits[left] = off < CLOSE
            going = off >= CLOSE * WELL
            left, own, gap = left[going], own[going], gap[going]
            if not len(left):
                break
            damping = np.linalg.norm(gap, axis=1)
            step = _least(own, gap, CUT, damping if turn < SOON else damping * damping)
            longest = np.max(np.abs(step), axis=1, keepdims=True)
            step *= np.minimum(1.0, 0.5 / np.where(longest > 0, longest, 0.5))
            points[np.ix_(left, columns)] -= size * step
        return fits

    def _with_rates(self, points: Doubles, among: Doubles) -> Doubles:
        """Move rates of some points, at once where conditions are linear in them."""
        columns, size = np.array([*self.rates], int), np.array([*self.rates.values()])
        fits, left = np.zeros(len(points), bool), np.flatnonzero(among)
        for _ in range(ROUNDS):
            if not len(left):
                break
            value, slopes = self._moving(points[left])
            own, gap = _of_size_one(slopes * size, value)
            known = _finite(own, gap)
            fits[left[~known]] = False
            left, own, gap = left[known], own[known], gap[known]
            step = _least(own, gap, TELLING, np.zeros(len(left)))
            points[np.ix_(left, columns)] -= size * step
            far = np.max(np.abs(step), axis=1, initial=0.0)
            rest = np.abs((own @ step[:, :, None])[:, :, 0] - gap)
            fits[left] = np.maximum(np.max(rest, axis=1, initial=0.0), far) < FULFILLED
            left = left[far >= CLOSE]
        return fits

    def distances(self, points: Doubles) -> list[tuple[str, Doubles]]:
        """Return every condition and its rate at points (components, count), by names."""
        names = [f"constraint '{c.name}'" for c in self.conditions if c.place is not None]
        values = self._functions[0](*points)[: len(names)] if names else []
        names += [f"constraint '{c.name}'" if c.place is None else f"the rate of '{c.name}'"
                  for c in self.conditions]  # fmt: skip
        values = [*values, *self._functions[1](*points)[: len(self.conditions)]]
        return [*zip(names, values, strict=True)]

    def values(self, points: Doubles) -> Doubles:
        """Return what is zero of each condition at points (points, conditions)."""
        placed = iter(self._placed(points)[0].T if self.of_places else ())
        moving = self._moving(points)[0].T
        each = [next(placed) if c.place is not None else moving[k]
                for k, c in enumerate(self.conditions)]  # fmt: skip
        return np.array(each).T

    def worst(self, point: Doubles) -> tuple[str, float]:
        """Return the condition that is furthest off, in sizes of ranges, and what it is."""
        each = []
        for function, sizes in ((self._placed if self.of_places else None, self.places),
                                (self._moving, self.rates)):  # fmt: skip
            if function is not None:
                values, by = function(point[None])
                each += [*np.abs(_of_size_one(by * np.array([*sizes.values()]), values)[1][0])]
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
        scaled = self._moving(point[None])[1][0] * np.array([*self.rates.values()])
        return scaled, np.linalg.norm(scaled, axis=1)

    def lost(self, point: Doubles, usual: Doubles, rows: Sequence[int]) -> int | None:
        """Return the first of some conditions that says nothing of its own at a point, if any does.

        usual : a point at which all do
        """
        weight = self._scaled(usual)[1][[*rows], None]
        here, there = (self._scaled(x)[0][[*rows]] / np.where(weight > 0, weight, 1.0)
                       for x in (point, usual))  # fmt: skip
        for k, row in enumerate(rows):
            least, else_ = (np.linalg.svd(x[: k + 1], compute_uv=False)[-1] for x in (here, there))
            if least < FLAT * else_:
                return row
        return None

    @cached_property
    def of_places(self) -> list[tuple[Tie, Expr]]:
        """Return the conditions of places, each with what is zero."""
        return [(c, self.plain(c.place)) for c in self.conditions if c.place is not None]

    @cached_property
    def firsts(self) -> list[Expr]:
        """Return what is zero of rates, of every condition."""
        return [self.plain(c.first) for c in self.conditions]

    def slopes_by_rates(self, first: Expr) -> list[Expr]:
        """Return how what is zero of rates changes with each."""
        own = (self.symbols[k] for k in self.rates)
        return [first.diff(s) if s in first.free_symbols else Integer(0) for s in own]

    @cached_property
    def _functions(self) -> tuple[Any, Any]:
        moved, own = [self.symbols[k] for k in self.places], [e for _, e in self.of_places]
        placed = [*own, *(e.diff(s) if s in e.free_symbols else 0 for e in own for s in moved)]
        moving = [*self.firsts, *(x for e in self.firsts for x in self.slopes_by_rates(e))]
        flat = placed, moving
        first, second = (lambdify(self.symbols, e, modules="numpy", cse=True) for e in flat)
        return first, second

    def plain(self, e: Expr) -> Expr:
        """Return an expression without named quantities."""
        definitions = self.frames.sheet.needed([e])
        known: dict[Symbol, Expr] = {}
        for symbol, value in definitions.items():
            known[symbol] = value.xreplace(known)
        return e.xreplace(known)

    def _placed(self, points: Doubles) -> tuple[Doubles, Doubles]:
        return _split(self._functions[0](*points.T), points, len(self.places))

    def _moving(self, points: Doubles) -> tuple[Doubles, Doubles]:
        return _split(self._functions[1](*points.T), points, len(self.rates))


def _split(values: Sequence[Any], points: Doubles, columns: int) -> tuple[Doubles, Doubles]:
    """Return values (points, conditions), and slopes by each component that moves."""
    each = np.empty((len(values), len(points)))
    for row, value in zip(each, values, strict=True):
        row[:] = value
    flat, count = each.T, len(values) // (columns + 1)
    return flat[:, :count], flat[:, count:].reshape(len(points), count, columns)


def _finite(slopes: Doubles, values: Doubles) -> Doubles:
    """Return at which points all is a number."""
    return np.asarray(np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(values).all(axis=1))


def _of_size_one(scaled: Doubles, values: Doubles) -> tuple[Doubles, Doubles]:
    """Return slopes whose rows are of size one, and values as these are scaled."""
    weight = np.linalg.norm(scaled, axis=2)
    weight = np.where(weight > 0, weight, 1.0)
    return scaled / weight[:, :, None], values / weight


def _least(slopes: Doubles, values: Doubles, cut: float, damping: Doubles) -> Doubles:
    """Return for each point the least step that takes values off, damped, which redundancy needs.

    damping : at most 1, beside squares of singular values
    """
    U, sizes, V = np.linalg.svd(slopes, full_matrices=False)
    most = np.max(sizes, axis=1, keepdims=True, initial=0.0)
    told = sizes > cut * most
    by = sizes / np.where(told, sizes * sizes + np.minimum(1.0, damping)[:, None], 1.0)
    along = (np.swapaxes(U, 1, 2) @ values[:, :, None])[:, :, 0] * np.where(told, by, 0.0)
    found: Doubles = (np.swapaxes(V, 1, 2) @ along[:, :, None])[:, :, 0]
    return found


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
