"""States of the declared ranges to begin motions at: anywhere in them, and at their corners.

Numbers are floats of the smaller type, so that both precisions begin at the same state and have the
same motion; but for quaternions, which each precision holds as long as it can, and for machines
with constraints, whose states fulfil these to the last bit of a double.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from derive.library.library import Library
from derive.program.precision import F32, Precision
from derive.program.program import Quantity, placed
from derive.report.driver import Storage
from derive.verify.draw import Dice, Sampled, admitted, drawn
from derive.verify.equations import Equations, equations_of
from derive.verify.operators import Column
from derive.verify.scale import DOUBLES
from derive.verify.solution import solution

TURNS = 10
MOST_TURNS = 100_000
"""Beyond, errors of a double would be told by a reference that takes hours."""
LEAST_TURNS = 1e-6
"""Below, a motion is hardly more than what floats round of it."""
QUANTILE, RATES = 0.9, 256
SMALL = 2.0**-20
"""Beside the usual size of a number, of differences for slopes."""
STATE_RATE = "state_rate"


@dataclass(frozen=True)
class Begun:
    """Many states to begin at, with all that is held: (components, samples), in double."""

    names: tuple[str, ...]
    columns: Column

    def __len__(self) -> int:
        return int(self.columns.shape[1])

    def at(self, places: Any) -> "Begun":
        """Return some of them."""
        return Begun(self.names, self.columns[:, places])

    def of(self, names: Sequence[str]) -> "Begun":
        """Return the same states, of these components only."""
        own = [self.names.index(name) for name in names]
        return Begun(tuple(names), self.columns[own])

    def values(self, place: int) -> dict[str, float]:
        """Return one of them by component."""
        return dict(zip(self.names, self.columns[:, place].tolist(), strict=True))

    def joined(self, more: "Begun") -> "Begun":
        """Return these and others."""
        return Begun(self.names, np.concatenate([self.columns, more.columns], axis=1))


def anywhere(library: Library, seed: str, count: int) -> Begun:
    """Return ``count`` states anywhere in the ranges, the same whatever the scene is called."""
    of = Sampled(library, F32)
    return _given(library, of, drawn(of, Dice(f"derive: {seed}"), count))


def begun(library: Library, seed: str, count: int) -> Begun:
    """Return ``count`` states anywhere in the ranges, and as many at corners of these."""
    of = Sampled(library, F32)
    dice = Dice(f"derive: {library.scene.name} report {seed}")
    rows = drawn(of, dice, 2 * count)
    low, high = of.lows[:, None], of.highs[:, None]
    corners = np.where(dice.uniform(len(of.names), count) < 1 / 2, low, high)
    rows[:, count:] = np.where(admitted(of, corners), corners, rows[:, count:])
    return _in_motion(library, _given(library, of, rows))


def nearby(library: Library, start: Begun, seed: str, count: int, reach: float) -> Begun:
    """Return states beside those of ``start``: each of their numbers may be moved by ``reach``.

    reach : of the width of a range
    """
    of = Sampled(library, F32)
    dice = Dice(f"derive: {library.scene.name} report beside {seed}")
    places = [of.names.index(name) for name in start.names]
    which = (dice.uniform(count) * len(start)).astype(int)
    rows = np.array(((of.lows + of.highs) / 2)[:, None] + np.zeros((1, count)))
    rows[places] = start.columns[:, which]
    across = (of.highs - of.lows)[:, None] * reach
    moves = (2 * dice.uniform(*rows.shape) - 1) * (dice.uniform(*rows.shape) < 1 / 2)
    rows = np.clip(rows + moves * across, of.lows[:, None], of.highs[:, None])
    every = _given(library, of, rows[:, admitted(of, rows)])
    return every.of(start.names)


def _given(library: Library, of: Sampled, rows: Column) -> Begun:
    rows = rows.astype(np.float32).astype(np.float64)
    given = library.vocabulary.given()
    for q, span in placed(of.quantities):
        if q in library.vocabulary.states and q.is_quaternion:
            size = np.sqrt(np.sum(rows[span] ** 2, axis=0))
            rows[span] = np.where(size > 0, rows[span] / size, np.eye(4)[:, :1])
    names = tuple(c for q in given for c in q.components)
    return Begun(names, _held(library, rows[[of.names.index(name) for name in names]]))


def _held(library: Library, columns: Column) -> Column:
    """Return states that fulfil the constraints, if there are any, as many as there were.

    In the place of those that cannot be brought onto them stand others, which can.
    """
    brings = library.mechanism.held.onto
    if brings is None or not columns.shape[1]:
        return columns
    hidden = np.ones((len(brings.symbols) - len(columns), columns.shape[1]))
    found, fits = brings.brought(np.concatenate([columns, hidden]).T)
    there = np.flatnonzero(fits)
    if not len(there):
        return columns
    which = np.where(fits, np.arange(len(fits)), there[np.arange(len(fits)) % len(there)])
    return np.asarray(found[which, : len(columns)].T, np.float64)


def _in_motion(library: Library, every: Begun) -> Begun:
    """Return states with what their motion needs, without what other functions are given."""
    equations, _ = rate_equations(library)
    sought = {u for block in equations.blocks for u in block.unknowns}
    needed = {c for place, c in equations.names.items() if place not in sought}
    moved = (*library.vocabulary.states, *library.setup.inputs)
    needed |= {c for q in moved for c in q.components}
    needed |= {c for p in library.motions for q in p.inputs for c in q.components}
    return every.of([name for name in every.names if name in needed])


def as_storage(start: Begun, quantities: tuple[Quantity, ...], precision: Precision) -> Storage:
    """Return states by quantity, as the functions of a precision take them."""
    at = dict(zip(start.names, start.columns, strict=True))
    return {
        q.name: np.ascontiguousarray(np.array([at[c] for c in q.components]).T, precision.dtype)
        for q in quantities if all(c in at for c in q.components)
    }  # fmt: skip


def rates_at(library: Library, start: Begun) -> dict[str, Column]:
    """Return the rate of every component of the state, from the lecture's equations."""
    equations, names = rate_equations(library)
    wide: Mapping[str, Any] = dict(zip(start.names, start.columns, strict=True))
    with np.errstate(all="ignore"):
        found = solution(equations, wide, (), DOUBLES).unknowns()
    states = [c for q in library.vocabulary.states for c in q.components]
    values = (np.broadcast_to(np.asarray(found[n].value, float), (len(start),)) for n in names)
    return dict(zip(states, values, strict=True))


def rate_equations(library: Library) -> tuple[Equations, list[str]]:
    """Return the equations of the state's rate, and the names of its components."""
    mechanism = library.mechanism
    problem = library.problems.get(STATE_RATE) or mechanism.problem(STATE_RATE)
    names = [c for q in problem.outputs for c in q.components]
    return equations_of(mechanism, problem), names


def fastest(library: Library) -> float:
    """Return the rate, rad/s, that a scene typically turns with, from states inside its ranges.

    It is the largest of the speeds that nine of ten states keep to, and of what half of them keep
    to: rates of angles, roots of angular accelerations, which grow without end beside a pole, and
    the rates that small changes of a state swing with. Of a state without any turning, it is also
    what changes beside the width of its range.
    """
    start = anywhere(library, "rates", RATES)
    rates, turning = rates_at(library, start), Sampled(library, F32).turning
    at = dict(zip(start.names, start.columns, strict=True))
    speeds, others = list[Column](), list[Column]()
    for q in library.vocabulary.states:
        for c in q.components:
            if q.unit == "rad/s" and (c in turning or not turning):
                speeds.append(np.abs(at[c]))
                others.append(np.sqrt(np.abs(rates[c])))
            elif q.unit == "rad":
                others.append(np.abs(rates[c]))
    for q in () if others else library.vocabulary.states:
        wide = float(q.ends[1] - q.ends[0]) if q.low is not None else 1.0
        others += [np.abs(rates[c]) / wide for c in q.components]
    swings = [_swings(library, start)]
    return max(_kept_to(speeds, QUANTILE), _kept_to(others, 1 / 2), _kept_to(swings, 1 / 2))


def _swings(library: Library, start: Begun) -> Column:
    """Return the largest rate, rad/s, that small changes of each state swing with.

    Of the slopes of its rate, by differences, it is the largest imaginary part of an eigenvalue.
    """
    names = [c for q in library.vocabulary.states for c in q.components]
    own, count = [start.names.index(c) for c in names], len(start)
    sizes = np.median(np.abs(start.columns[own]), axis=1)
    changes = SMALL * np.where(sizes > 0, sizes, 1.0)
    every = np.repeat(start.columns[:, None, :], 1 + len(own), axis=1)
    for k, place in enumerate(own):
        every[place, 1 + k] += changes[k]
    found = rates_at(library, Begun(start.names, every.reshape(len(start.names), -1)))
    each = np.array([found[c].reshape(1 + len(own), count) for c in names])
    slopes = np.moveaxis((each[:, 1:] - each[:, :1]) / changes[:, None], 2, 0)
    told = np.isfinite(slopes).all(axis=(1, 2))
    swings: Column = np.abs(np.linalg.eigvals(slopes[told]).imag).max(axis=1)
    return swings


def _kept_to(each: list[Column], part: float) -> float:
    """Return what the largest of each state is within, for a part of the states."""
    most = np.max(np.array(each), axis=0) if each else np.zeros(1)
    return float(np.quantile(most[np.isfinite(most)], part)) if np.isfinite(most).any() else 0.0


def horizon(fast: float) -> float:
    """Return a time of about ``TURNS`` turns at a rate: 1, 2 or 5 times a power of ten, in s.

    >>> horizon(6.0), horizon(0.0)
    (10.0, 10.0)
    """
    time = TURNS * 2 * np.pi / fast if fast > 0 else TURNS
    power = 10.0 ** np.floor(np.log10(time))
    nice = [1.0, 2.0, 5.0, 10.0]
    return float(np.float64(min(nice, key=lambda x: abs(np.log(x * power / time))) * power))
