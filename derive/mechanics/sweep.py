"""Divisors looked at over all of the declared ranges: random points, corners, zeros, a search.

A quotient is right at a trial point and wrong where its divisor vanishes. So every divisor is
valued at many points at once, beside the size of its terms, and followed to where it is smallest.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray
from sympy import Add, Expr, Mul, Pow, Rational, Symbol, pi, tan

from derive.mechanics.box import Box, ranges
from derive.mechanics.probe import DIGITS, Probe, random_probe
from derive.mechanics.words import Words
from derive.scene.escape import at_place

Sized = tuple[
    NDArray[Any], NDArray[Any]
]  # values at all points, and the sizes of the terms they are made of
STARTS, ROUNDS = 3, 40  # a round halves the steps at least every second time
LOW = 0.1  # what is nowhere smaller than this at the points is not searched for
LEAST = 1e-4  # of the size of its terms: a divisor that loses more digits than that is a pole
LEAST_OF_MASSES = 1e-6  # of a mass matrix beside its entries; 20 equal rods in line have 1.4e-5


@dataclass
class Sweep:
    """Values of symbols at many points, and of expressions as they are asked for."""

    values: dict[Symbol, Sized]
    memory: dict[Expr, Sized] = field(default_factory=dict)

    def of(self, e: Expr) -> Sized:
        """Return the values of an expression and the sizes of its terms."""
        if e in self.values:
            return self.values[e]
        if e not in self.memory:
            self.memory[e] = self._valued(e)
        return self.memory[e]

    def _valued(self, e: Expr) -> Sized:
        one = np.ones(())
        if e is pi:
            return np.pi * one, np.pi * one
        match e:
            case Rational():
                x = one * (int(e.p) / int(e.q))
                return x, abs(x)
            case Add():
                parts = [self.of(a) for a in e.args]
                return sum((v for v, _ in parts), 0 * one), sum((m for _, m in parts), 0 * one)
            case Mul():
                value, size = one, one
                for v, m in map(self.of, e.args):
                    value, size = value * v, size * m
                return value, size
            case Pow():
                return self._power(e)
        value = getattr(np, e.func.__name__)(self.of(e.args[0])[0])
        return value, abs(value) if e.func is tan else np.ones_like(value)

    def _power(self, e: Expr) -> Sized:
        (base, size), exponent = self.of(e.base), float(e.exp)
        value = base**exponent
        return value, size**exponent if exponent > 0 else abs(value)


def _attitudes(rows: NDArray[Any]) -> NDArray[Any]:
    """Return quaternions of length 1 along rows; none is turned where all four are zero."""
    rows = np.where(np.any(rows != 0, axis=1, keepdims=True), rows, np.eye(4)[0])
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


def sweep_at(
    of: Box,
    points: NDArray[Any],
    definitions: Mapping[Symbol, Expr],
    reaches: Mapping[Symbol, float] | None = None,
) -> Sweep:
    """Return all values at points; what moves has the size of its range, or nothing is at rest.

    reaches : the size that a named quantity has at most, unless it is larger itself
    """
    reach, points = np.maximum(abs(of.low), abs(of.high)), points.copy()
    for own in of.quaternions:
        points[:, own] = _attitudes(points[:, own])
    found = Sweep({
        s: (points[:, k], abs(points[:, k]) if s in of.fixed else np.full(len(points), reach[k]))
        for k, s in enumerate(of.symbols)
    })  # fmt: skip
    with np.errstate(all="ignore"):
        for symbol, value in definitions.items():
            named, size = found.of(value)
            most = size if reaches is None else np.maximum(abs(named), reaches[symbol])
            found.values[symbol] = named, np.minimum(size, most)
    return found


def reaches_of(of: Box, definitions: Mapping[Symbol, Expr]) -> dict[Symbol, float]:
    """Return the largest that named quantities become at points of the ranges.

    What moves has the size of its range; sizes of what is named upon it multiply from one to the
    next, and come to exceed by far whatever it can be.
    """
    found = sweep_at(of, of.tried, definitions)
    return {s: float(np.max(np.nan_to_num(abs(found.values[s][0])), initial=0.0))
            for s in definitions}  # fmt: skip


def probe_at(words: Words, place: Mapping[str, float], definitions: Mapping[Symbol, Expr]) -> Probe:
    """Return a place as a trial point, every named quantity valued."""
    of, probe = ranges(words), random_probe(words, 0)
    probe.values |= {s: mpf(place[n]) for s, n in zip(of.symbols, of.names, strict=True)}
    with mp.workdps(DIGITS):
        for own in of.quaternions:
            q = of.symbols[own]
            size = mp.sqrt(mp.fsum(probe.values[s] ** 2 for s in q))
            if size == 0:
                probe.values[q[0]] = size = mpf(1)  # no attitude has length 0: none is turned
            probe.values |= {s: probe.values[s] / size for s in q}
        probe.define(definitions)
    return probe


@dataclass(frozen=True)
class Weakest:
    """The smallest that a divisor becomes beside its terms, and where.

    bound : what it must not be below
    """

    least: float
    place: Mapping[str, float]
    bound: float = LEAST

    @property
    def vanishes(self) -> bool:
        """Tell whether it is a pole."""
        return not self.least > self.bound

    @property
    def where(self) -> str:
        """Return words for the place: the values of a few quantities.

        >>> Weakest(0.0, {"a": 0.0, "b": 1.25}).where
        'at a = 0, b = 1.25'
        """
        return at_place({name: float(f"{x:.4g}") for name, x in self.place.items()}).strip()


def weakest(
    of: Box,
    definitions: Mapping[Symbol, Expr],
    measure: Callable[[Sweep], Any],
    bound: float = LEAST,
    reaches: Mapping[Symbol, float] | None = None,
    enough: float = -np.inf,
) -> Weakest:
    """Return the smallest value of a measure on the ranges that points and a search find.

    enough : what is not above it is found without looking for less
    """

    def at(points: NDArray[Any]) -> NDArray[Any]:
        with np.errstate(all="ignore"):
            found = measure(sweep_at(of, points, definitions, reaches))
        every = np.broadcast_to(found, len(points))
        sizes: NDArray[Any] = np.nan_to_num(every, nan=0.0)
        return sizes

    points = of.tried
    if not len(points):
        return Weakest(1.0, {}, bound)
    sizes = at(points)
    order = np.argsort(sizes, kind="stable")[:STARTS]
    best = (float(sizes[order[0]]), points[order[0]])
    for n in order if enough < best[0] < LOW else ():
        best = min(best, _followed(of, at, (points[n], float(sizes[n])), enough),
                   key=lambda found: found[0])  # fmt: skip
        if best[0] <= enough:
            break
    return Weakest(best[0], dict(zip(of.names, map(float, best[1]), strict=True)), bound)


def _followed(
    of: Box, at: Callable[[NDArray[Any]], NDArray[Any]], start: tuple[NDArray[Any], float],
    enough: float,
) -> tuple[float, NDArray[Any]]:  # fmt: skip
    """Return the smallest value near a point, by steps along every component, ever shorter."""
    (here, size), step, width = start, 0.25, of.high - of.low
    sides = np.vstack([np.diag(width), -np.diag(width)])
    for turn in range(ROUNDS):
        if size <= enough:
            break
        around = of.brought(np.clip(here + step * sides, of.low, of.high))
        sizes = at(around) if len(around) else np.array([size])
        n = int(np.argmin(sizes))
        nearer = sizes[n] < size
        if nearer:
            here, size = around[n], float(sizes[n])
        if turn % 2 or not nearer:
            step /= 2
    return size, here


def matrices(found: Sweep, entries: list[list[Expr]], *, of_masses: bool = False) -> NDArray[Any]:
    """Return matrices of entries at all points, rows and columns scaled by the sizes of terms.

    of_masses : scaled by what the entries are instead, of which none is what rounding leaves
    """
    pairs = [[found.of(e) for e in row] for row in entries]
    shape = np.broadcast_shapes(*(v.shape for row in pairs for v, _ in row), (1,))
    values, sizes = np.empty((2, *shape, len(pairs), len(pairs[0])))
    for m, row in enumerate(pairs):
        for n, (value, size) in enumerate(row):
            values[:, m, n], sizes[:, m, n] = value, size
    sizes = abs(values) if of_masses else sizes
    for axis in (2, 1, 2, 1):
        scale = sizes.max(axis=axis, keepdims=True)
        scale = np.where(scale > 0, scale, 1)
        values, sizes = values / scale, sizes / scale
    scaled: NDArray[Any] = np.nan_to_num(values)
    return scaled


def regular(found: Sweep, entries: list[list[Expr]], *, of_masses: bool = False) -> NDArray[Any]:
    """Return the smallest singular value of scaled matrices at all points."""
    scaled = matrices(found, entries, of_masses=of_masses)
    sizes: NDArray[Any] = np.linalg.svd(scaled, compute_uv=False)
    return sizes[:, -1]
