"""What the files of a sweep say: quantiles, histograms, worst members, sensitivities.

Files are read one after the other, so a sweep may be larger than memory.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from derive.solve.sweep.course import ASTRAY, REFUSED
from derive.solve.sweep.job import ENDED, ENDED_AT, MEMBER
from derive.solve.sweep.store import parts_of
from derive.solve.sweep.vary import FloatColumn

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
MOST_READ = 1 << 20
"""Members that quantiles and histograms are of, the first ones."""
MOST_COURSES = 1 << 14
"""Members that quantiles in time are of, the first ones."""
BINS = 40
APART = 1e-12
"""Of their size, at which the ends of a histogram are: below lies what rounding makes."""
FURTHEST, NOTHING = 8e307, 1e-300
"""Half of what the ends of a histogram are apart at most: twice as much is a number still; what is
further out stands in its last bars. And at least, for all between them are numbers, too."""
FEWEST_LEFT = 0.1
"""Of the members, those that must still run for quantiles of an instant."""
LISTED = 10
"""Members without an end that are listed with their inputs."""


@dataclass(frozen=True)
class WorstMember:
    """The member with the largest or smallest value of a column, and what varies of its inputs."""

    column: str
    says: str
    value: float
    member: int
    inputs: Mapping[str, float]


@dataclass(frozen=True)
class Scatter:
    """A column of numbers: how many there are, quantiles, a histogram."""

    column: str
    count: int
    quantiles: tuple[float, ...]
    edges: tuple[float, ...]
    heights: tuple[int, ...]

    @property
    def width(self) -> float:
        """Return what nine of ten values lie within."""
        return self.quantiles[-1] - self.quantiles[0]


@dataclass(frozen=True)
class Fan:
    """Quantiles in time of a column: (quantiles, instants); where none runs any more, NaN."""

    column: str
    times: tuple[float, ...]
    quantiles: FloatColumn


@dataclass(frozen=True)
class Influence:
    """How much of a column's variance each input makes, alone and with others, each +- 95 %."""

    column: str
    pairs: int
    rows: tuple[tuple[str, float, float, float, float], ...]


@dataclass(frozen=True)
class Lost:
    """A member without an end: why, and what varies of its inputs."""

    member: int
    why: str
    inputs: Mapping[str, float]


@dataclass(frozen=True)
class Summary:
    """What the files of a sweep say.

    off : how far a member begins at most from what was drawn or set, by component
    """

    scatters: tuple[Scatter, ...]
    fans: tuple[Fan, ...]
    extremes: tuple[WorstMember, ...]
    lost: tuple[Lost, ...]
    influences: tuple[Influence, ...]
    off: Mapping[str, float]


def summary(
    folder: Path, plain: int, varied: Sequence[str], begun: Mapping[str, str],
    held: Mapping[str, float],
    numbers: Sequence[str], courses: Mapping[str, Sequence[float]],
) -> Summary:  # fmt: skip
    """Return what the files of a sweep say.

    plain : members that are not there for sensitivities alone
    begun : states that members are brought to at their start, and the columns that tell where
    held  : what is set
    numbers, courses : columns of numbers, and of courses with their instants
    """
    heads: dict[str, list[FloatColumn]] = {c: [] for c in (*numbers, *courses)}
    extremes: dict[tuple[str, str], WorstMember] = {}
    lost: list[Lost] = []
    off: dict[str, float] = {}
    rest: dict[str, list[FloatColumn]] = {c: [] for c in numbers}
    for table in _each_file(folder):
        member = np.asarray(table[MEMBER])
        own = member < plain
        inputs = {name: table[name] for name in varied}
        for name, column in begun.items():
            gaps = np.abs(table[column] - inputs.get(name, held.get(name, np.nan)))
            off[name] = max(off.get(name, 0.0), float(np.max(gaps[np.isfinite(gaps)], initial=0.0)))
        inputs |= {name: table[column] for name, column in begun.items()}
        for k in np.flatnonzero([str(how).startswith((ASTRAY, REFUSED)) for how in table[ENDED]]):
            if len(lost) < LISTED:
                of = {name: float(x[k]) for name, x in inputs.items()}
                lost.append(Lost(int(member[k]), str(table[ENDED][k]), of))
        for column in numbers:
            values = table[column]
            heads[column].append(values[own & (member < MOST_READ)])
            rest[column].append(values[~own])
            _extremes(extremes, column, member[own], values[own],
                      {name: x[own] for name, x in inputs.items()})  # fmt: skip
        for column in courses:
            heads[column].append(table[column][own & (member < MOST_COURSES)])
    return Summary(
        tuple(_scatter(c, np.concatenate(heads[c])) for c in numbers),
        tuple(_fan(c, times, np.concatenate(heads[c])) for c, times in courses.items()),
        tuple(extremes[key] for key in sorted(extremes, key=lambda k: numbers.index(k[0]))),
        tuple(lost),
        tuple(i for c in numbers for i in _influence(c, np.concatenate(rest[c]), varied)),
        off,
    )  # fmt: skip


def _each_file(folder: Path) -> Iterator[dict[str, Any]]:
    """Yield each file of a sweep as arrays by column, courses as (members, instants)."""
    from pyarrow import parquet

    for _, part in sorted(parts_of(folder).items()):
        table = parquet.read_table(part)
        yield {name: in_array(table[name].combine_chunks()) for name in table.column_names}


def in_array(column: Any) -> Any:
    """Return a column of Arrow as an array, a course as (members, instants)."""
    if hasattr(column.type, "list_size"):
        return column.flatten().to_numpy(zero_copy_only=False).reshape(len(column), -1)
    return column.to_numpy(zero_copy_only=False)


def _extremes(
    found: dict[tuple[str, str], WorstMember], column: str, member: Any, values: FloatColumn,
    inputs: Mapping[str, FloatColumn],
) -> None:  # fmt: skip
    right = np.flatnonzero(np.isfinite(values))
    if not len(right):
        return
    for says, sign, best in (("largest", 1, np.argmax), ("smallest", -1, np.argmin)):
        k = right[best(values[right])]
        old = found.get((column, says))
        if old is None or sign * values[k] > sign * old.value:
            of = {name: float(x[k]) for name, x in inputs.items()}
            found[column, says] = WorstMember(column, says, float(values[k]), int(member[k]), of)


def _scatter(column: str, values: FloatColumn) -> Scatter:
    values = values[np.isfinite(values)]
    if not len(values):
        return Scatter(column, 0, (), (), ())
    ends = _ends_apart(values)
    heights, edges = np.histogram(np.clip(values, *ends), BINS, ends)
    cuts = tuple((2 * np.quantile(values / 2, QUANTILES)).tolist())
    return Scatter(column, len(values), cuts, tuple(edges.tolist()), tuple(heights.tolist()))


def _ends_apart(values: FloatColumn) -> tuple[float, float]:
    """Return the ends of values, as far apart as numbers between them need."""
    middle, half = float(values.min() / 2 + values.max() / 2), float(np.ptp(values / 2))
    half = min(max(half, abs(middle) * APART), FURTHEST)
    half = half if half > NOTHING else 1.0
    return middle - half, middle + half


def _fan(column: str, times: Sequence[float], values: FloatColumn) -> Fan:
    cuts = np.full((len(QUANTILES), len(times)), np.nan)
    for k in range(len(times)):
        own = values[:, k][np.isfinite(values[:, k])]
        if len(own) and len(own) >= FEWEST_LEFT * len(values):
            cuts[:, k] = np.quantile(own, QUANTILES)
    return Fan(column, tuple(times), cuts)


def _influence(column: str, values: FloatColumn, varied: Sequence[str]) -> Iterator[Influence]:
    """Yield sensitivities of a column, by SALib; none where it does not change."""
    size = len(varied) + 2
    pairs = values[: len(values) // size * size].reshape(-1, size)
    pairs = pairs[np.isfinite(pairs).all(axis=1)]
    if len(pairs) < 2 or np.ptp(pairs) == 0:
        return
    from SALib.analyze import sobol

    names = np.array([*varied])  # of a list older SALib with newer pandas warns
    problem = {"num_vars": len(varied), "names": names, "bounds": [[0, 1]] * len(varied)}
    with np.errstate(all="ignore"):
        of = sobol.analyze(problem, pairs.ravel(), calc_second_order=False, seed=0)
    each = zip(varied, of["S1"], of["S1_conf"], of["ST"], of["ST_conf"], strict=True)
    rows = tuple((n, float(a), float(b), float(c), float(d)) for n, a, b, c, d in each)
    yield Influence(column, len(pairs), rows)


SCALARS = (ENDED_AT,)
"""Columns of numbers that every sweep has."""
