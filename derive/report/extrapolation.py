"""One length of a motion in long floats, by extrapolation of a midpoint rule.

Gragg's rule (Bulirsch and Stoer 1966), or where a rate falls off far faster than motions go, that
of Bader and Deuflhard (1983), which the slopes of the rate, taken once for a length, make stable:
any slopes do, so that differences of the rate suffice.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, arb_mat

DEEPEST = 10
STIFF = 30.0
"""Times the rate of a motion: what falls off faster would force lengths that nothing else needs."""
CHANGE = 2.0**-40
"""Relative, of differences for slopes."""
Rate = Callable[[Sequence[Any]], list[Any]]
Substeps = Callable[[float, int], list[Any]]


@dataclass(frozen=True)
class Rule:
    """A midpoint rule for a motion.

    begun : from a state on, what takes a length in so many substeps
    calls : how often one length asks for the rate      stiff : whether it is the semi-implicit one
    """

    begun: Callable[[list[Any]], Substeps]
    calls: int
    stiff: bool


def rule_for(rate: Rate, state: list[Any], fast: float) -> Rule:
    """Return the midpoint rule that suits a motion, from the slopes of its rate where it begins."""
    own = np.linalg.eigvals(np.array([[float(x) for x in row] for row in slopes(rate, state)]))
    substeps = sum(2 * level for level in range(1, DEEPEST + 1))
    if -float(np.min(own.real)) > STIFF * fast:
        more = 1 + len(state)
        return Rule(lambda here: _semi_implicit(rate, here), substeps + more, stiff=True)
    return Rule(lambda here: _midpoint(rate, here), substeps - DEEPEST + 1, stiff=False)


def extrapolated(substeps: Substeps, length: float) -> tuple[list[Any], float]:
    """Return the state after a length, and how far the last two extrapolations are apart."""
    rows: list[list[list[Any]]] = []
    for level in range(1, DEEPEST + 1):
        row = [substeps(length, 2 * level)]
        for k, before in enumerate(rows[-1] if rows else []):
            factor = 1 / (arb(level) ** 2 / arb(level - k - 1) ** 2 - 1)
            latest = row[-1]
            pairs = zip(latest, before, strict=True)
            row.append([(a + (a - b) * factor).mid() for a, b in pairs])
        rows.append(row)
    best, other = rows[-1][-1], rows[-1][-2]
    size = max(abs(float(x)) for x in best) or 1.0
    gaps = [abs(float(a - b)) / size for a, b in zip(best, other, strict=True)]
    return best, max(gaps) if all(map(math.isfinite, gaps)) else math.inf


def slopes(rate: Rate, state: list[Any]) -> list[list[Any]]:
    """Return the slopes of a rate by differences: a row for each component of the rate."""
    here, columns = rate(state), []
    for k, x in enumerate(state):
        change = arb(CHANGE * max(abs(float(x)), 1.0))
        there = rate([*state[:k], x + change, *state[k + 1 :]])
        columns.append([((b - a) / change).mid() for a, b in zip(here, there, strict=True)])
    return [list(row) for row in zip(*columns, strict=True)]


def _midpoint(rate: Rate, state: list[Any]) -> Substeps:
    """Return Gragg's midpoint rule with so many substeps, an even number."""
    first = rate(state)

    def ended(length: float, count: int) -> list[Any]:
        h = (arb(length) / count).mid()
        before, here = state, [(x + h * v).mid() for x, v in zip(state, first, strict=True)]
        for _ in range(count - 1):
            own = zip(before, rate(here), strict=True)
            before, here = here, [(x + 2 * h * v).mid() for x, v in own]
        return here

    return ended


def _semi_implicit(rate: Rate, state: list[Any]) -> Substeps:
    """Return the semi-implicit midpoint rule with so many substeps, smoothed at its end."""
    first, steep, size = rate(state), slopes(rate, state), len(state)
    one = [[arb(int(i == k)) for k in range(size)] for i in range(size)]

    def ended(length: float, count: int) -> list[Any]:
        h = (arb(length) / count).mid()
        matrix = [[(one[i][k] - h * s).mid() for k, s in enumerate(row)]
                  for i, row in enumerate(steep)]  # fmt: skip
        inverse = arb_mat(matrix).solve(arb_mat(one)).mid()

        def solved(right: list[Any]) -> list[Any]:
            return [x.mid() for x in (inverse * arb_mat([[x] for x in right])).entries()]

        here, move = state, solved([h * v for v in first])
        for _ in range(count - 1):
            here = [(x + d).mid() for x, d in zip(here, move, strict=True)]
            more = solved([h * v - d for v, d in zip(rate(here), move, strict=True)])
            move = [(d + 2 * m).mid() for d, m in zip(move, more, strict=True)]
        here = [(x + d).mid() for x, d in zip(here, move, strict=True)]
        last = solved([h * v - d for v, d in zip(rate(here), move, strict=True)])
        return [(x + d).mid() for x, d in zip(here, last, strict=True)]

    return ended
