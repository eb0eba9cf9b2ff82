"""Which quantities a sum of monomials is homogeneous in, each of degree one or two.

Every monomial is an equation: its degree in each quantity, over that quantity's power, sums to one.
Monomials that share no quantity are solved apart; the one with the fewest quantities left to
choose from says which is tried next.
"""

from collections.abc import Iterable, Sequence

from derive.lower.apart import apart

Degrees = Sequence[int | None]
Choice = tuple[tuple[int, int], ...]  # quantities, each with its power
MOST_STEPS = 10_000  # a bound; the scenes of the tests take fewer than 50


def degrees_that_sum(rows: Iterable[Degrees], most: int = MOST_STEPS) -> dict[int, int] | None:
    """Return quantities with powers k such that sum(degree / k) = 1 in every row.

    The fewest quantities, of these the first, then the lowest powers; None if there are none, or
    if looking for them takes more than ``most`` steps. A degree None bars its quantity.

    >>> degrees_that_sum([(1, 1, 0), (0, 0, 2)])
    {0: 1, 2: 2}
    """
    distinct = list(dict.fromkeys(tuple(row) for row in rows))
    columns = list(zip(*distinct, strict=True))
    # Of quantities with the same degrees everywhere, no choice of the fewest holds but the first.
    usable = [q for q, own in enumerate(columns) if None not in own and columns.index(own) == q]
    total: Choice = ()
    degrees = [{q: row[q] or 0 for q in usable if row[q]} for row in distinct]
    for places in apart([own.keys() for own in degrees]):
        found = _fewest([degrees[k] for k in places], most)
        if found is None:
            return None
        total += found
    return dict(sorted(total))


def _fewest(rows: list[dict[int, int]], most: int) -> Choice | None:
    best: Choice | None = None
    waiting: list[tuple[Choice, list[int]]] = [((), sorted({q for row in rows for q in row}))]
    while waiting:
        most -= 1
        if most < 0:
            return None
        chosen, left = waiting.pop()
        halves = [2 - sum(row.get(q, 0) * 2 // k for q, k in chosen) for row in rows]
        short = [row for row, due in zip(rows, halves, strict=True) if due]
        if not short:
            best = min(best or chosen, chosen, key=_rank)
        elif best is None or len(chosen) < len(best):
            fits = {q: _fitting(rows, halves, q) for q in left}
            waiting += _next(short, chosen, {q: own for q, own in fits.items() if own})
    return best


def _fitting(rows: list[dict[int, int]], halves: list[int], q: int) -> list[int]:
    """Return the powers with which a quantity takes no more than what is due in any row."""
    pairs = [(row[q], due) for row, due in zip(rows, halves, strict=True) if q in row]
    return [k for k in (1, 2) if all(degree * 2 // k <= due for degree, due in pairs)]


def _next(
    short: list[dict[int, int]], chosen: Choice, fits: dict[int, list[int]]
) -> list[tuple[Choice, list[int]]]:
    """Return what to try: a quantity of the row with the fewest, with each power and without."""
    own = min(([q for q in fits if q in row] for row in short), key=len)
    if not own:
        return []
    others = [q for q in fits if q != own[0]]
    return [(chosen, others), *(((*chosen, (own[0], k)), others) for k in fits[own[0]])]


def _rank(choice: Choice) -> tuple[int, list[int], list[int]]:
    ordered = sorted(choice)
    return len(ordered), [q for q, _ in ordered], [k for _, k in ordered]
