"""Which conditions say something of their own: by doubles where that is clear, else exactly.

Doubles cannot tell a condition that others hold anyway from one that nearly says what they do. So
where little is left of one beside the others, states are followed to hundreds of digits, all
numbers of a scene being exact: there what is left is nothing, or far more than nothing.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np
from mpmath import mp, mpf
from sympy import lambdify

from derive.mechanics.onto import Doubles, Onto
from derive.mechanics.probe import independent_at_all

CLEAR = 1e-5
"""Of a row of size one: where more is left beside the others, doubles tell."""
TOLD_BY_DOUBLES = 1e-7
"""Of a row of size one: less than this is nothing where numbers of a scene are rounded."""
EXACT_DIGITS, ROUNDS = 600, 12
FULFILLED, NOTHING_LEFT = mpf(10) ** -200, mpf(10) ** -100
"""What conditions may be off by, and what is left of a row that others hold: about as much."""
NEARBY, ANYWHERE = 1e-3, float("inf")
"""Of a range: an exact place further off is another one, while rates may be any."""


@dataclass(frozen=True)
class Independent:
    """The places of conditions that say something of their own.

    off : by how much of a range others do not hold where these do, as rounded numbers leave it
    """

    rows: tuple[int, ...]
    off: Mapping[int, float]


def independent_conditions(brings: Onto, states: Sequence[Doubles]) -> Independent:
    """Return the conditions that are independent at all of some states that fulfil them."""
    slopes = [brings.slopes(state) for state in states]
    unclear = {*range(len(brings.conditions))} - {*_kept(slopes, CLEAR)}
    found, off = list[int](), dict[int, float]()
    for part in _parts(brings):
        if unclear.isdisjoint(part):
            found += part
            continue
        each = [_Exactly(brings, part, state) for state in states]
        most = max(one.off for one in each)
        if most == 0:
            kept = independent_at_all([one.rows() for one in each], len(part), NOTHING_LEFT)
        else:
            kept = _kept([own[part] for own in slopes], TOLD_BY_DOUBLES)
            off |= {row: most for k, row in enumerate(part) if k not in kept}
        found += [part[k] for k in kept]
    return Independent(tuple(sorted(found)), off)


def _kept(each: Sequence[Doubles], least: float) -> list[int]:
    """Return the places of the first rows of which enough is left beside those before."""
    kept: list[int] = []
    bases = [np.zeros((0, own.shape[1])) for own in each]
    for k in range(len(each[0])):
        left = [own[k] for own in each]
        for _ in range(2):  # once leaves what rounding does
            left = [x - (basis @ x) @ basis for x, basis in zip(left, bases, strict=True)]
        sizes = [float(np.linalg.norm(x)) for x in left]
        if min(sizes) > least:
            bases = [np.vstack([basis, x / size])
                     for basis, x, size in zip(bases, left, sizes, strict=True)]  # fmt: skip
            kept.append(k)
    return kept


def _parts(brings: Onto) -> Iterator[list[int]]:
    """Yield the places of conditions that speak of the same things, parts that share nothing."""
    moving = {brings.symbols[k] for k in (*brings.places, *brings.rates)}
    graph = nx.Graph()
    for k, first in enumerate(brings.firsts):
        graph.add_node(k)
        graph.add_edges_from((k, s) for s in first.free_symbols & moving)
    for part in nx.connected_components(graph):
        yield sorted(n for n in part if isinstance(n, int))


class _Exactly:
    """Some conditions at a state near one in doubles that fulfils them to hundreds of digits."""

    def __init__(self, brings: Onto, part: Sequence[int], state: Doubles) -> None:
        self.brings, self.off = brings, 0.0
        firsts = [brings.firsts[k] for k in part]
        own = {brings.conditions[k].name for k in part}
        of_places = [e for c, e in brings.of_places if c.name in own]
        with mp.workdps(EXACT_DIGITS):
            self.here = [mpf(float(x)) for x in state]
            places = [(e, [e.diff(brings.symbols[k]) for k in brings.places]) for e in of_places]
            rates = [(e, brings.slopes_by_rates(e)) for e in firsts]
            self._by_rates = self._function(rates)
            self._fulfil(self._function(places), brings.places, NEARBY)
            self._fulfil(self._by_rates, brings.rates, ANYWHERE)

    def rows(self) -> list[dict[int, Any]]:
        """Return how each condition changes with the rates, without what is nothing."""
        with mp.workdps(EXACT_DIGITS):
            found = []
            for _, row in self._by_rates(self.here):
                whole = max((abs(x) for x in row), default=mpf(0))
                found.append({k: x for k, x in enumerate(row) if abs(x) > NOTHING_LEFT * whole
                              and abs(x) > NOTHING_LEFT})  # fmt: skip
            return found

    def _function(self, each: Sequence[tuple[Any, Sequence[Any]]]) -> Any:
        flat = lambdify(self.brings.symbols, [e for v, row in each for e in (v, *row)],
                        modules="mpmath", cse=True)  # fmt: skip

        def valued(here: Sequence[Any]) -> list[tuple[Any, list[Any]]]:
            left = iter([mp.mpf(x) for x in flat(*here)])
            return [(next(left), [next(left) for _ in row]) for _, row in each]

        return valued

    def _fulfil(self, function: Any, columns: Mapping[int, float], within: float) -> None:
        """Move a state by Newton's method, damped by what conditions are off by, or its square."""
        first, sizes = list(self.here), [mpf(float(x)) for x in columns.values()]
        for turn in range(2 * ROUNDS):
            valued = [(v, [x * s for x, s in zip(row, sizes, strict=True)])
                      for v, row in function(self.here)]  # fmt: skip
            weights = [mp.norm(row, 2) for _, row in valued]
            gaps = [v / (w or 1) for (v, _), w in zip(valued, weights, strict=True)]
            worst = max(map(abs, gaps), default=mpf(0))
            if worst < FULFILLED:
                return
            square = mp.fsum(v * v for v, _ in valued)
            damping = mp.sqrt(square) if turn < ROUNDS else square
            step = _least([row for _, row in valued], [v for v, _ in valued], damping)
            for k, s, by in zip(columns, sizes, step, strict=True):
                self.here[k] -= s * by
            moved = [abs(self.here[k] - first[k]) / s for k, s in zip(columns, sizes, strict=True)]
            if max(moved) > within:
                break
        self.off, self.here = max(self.off, float(worst)), first


def _least(slopes: Sequence[Sequence[Any]], values: Sequence[Any], damping: Any) -> list[Any]:
    """Return the least step that takes values off."""
    J = mp.matrix([list(row) for row in slopes])
    square = J * J.T
    for i in range(square.rows):
        square[i, i] += damping
    return list(J.T * mp.lu_solve(square, mp.matrix(list(values))))
