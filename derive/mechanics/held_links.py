"""Links that constraints hold together: what conditions on accelerations leave of a mass matrix.

Accelerations that follow by the conditions, wherever in the ranges, are put into the equations of
the others: the energy of the motion that is left is positive, so L D L^T divides by nothing that
can vanish. Or all are found beside the forces that hold them, masses first, which needs no choice.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from sympy import Expr, Integer, Symbol

from derive.mechanics.mass_matrix import MassMatrix
from derive.mechanics.onto import Doubles

CLEAR = 0.02
"""Of the largest slope of a condition that is left: a pivot nowhere smaller may be divided by."""
NOISE = 1e-12  # what an elimination leaves of a slope that it takes out
MOST_AT_ONCE = 4096  # pivots that are valued together
ONE = Symbol("one")
Picked = tuple[int, ...]
LinearSum = dict[Symbol, Expr]
"""A sum of accelerations times factors; what holds none stands with the symbol of one."""


@dataclass(frozen=True)
class HeldCondition:
    """A condition that is linear in accelerations, and the force that enforces it."""

    form: LinearSum
    force: Symbol


@dataclass(frozen=True)
class Elimination:
    """Conditions, by their places, that are solved together for as many accelerations."""

    rows: Picked
    unknowns: tuple[Symbol, ...]


def with_forces(
    system: MassMatrix, rows: Sequence[HeldCondition], order: Sequence[Symbol]
) -> tuple[MassMatrix, LinearSum]:
    """Return what is on the way to accelerations and the forces that hold them, masses first."""
    own = system.copied()
    for row in rows:
        for u, slope in row.form.items():
            if u is not ONE:
                own.add(row.force, u, slope)
        own.act(row.force, -row.form.get(ONE, Integer(0)))
    made, found = own.solved((*order, *(row.force for row in rows)))
    return made, found | {row.force: -found[row.force] for row in rows}


def with_what_is_left(
    system: MassMatrix, rows: Sequence[HeldCondition], order: Sequence[Symbol],
    pivots: Sequence[Elimination], forces: Sequence[Symbol],
) -> tuple[MassMatrix, LinearSum]:  # fmt: skip
    """Return accelerations, those that follow put into the others, and forces if there are any."""
    own = system.copied()
    forms = _solved(own, [row.form for row in rows], pivots)
    left = put_into(own, forms, [u for u in order if u not in forms])
    made, found = left.solved([u for u in order if u not in forms])
    found |= {u: made.cut("x", _sum(form, found)) for u, form in forms.items()}
    if forces:
        found |= _enforcing(made, system, rows, pivots, found)
    return made, found


def put_into(
    own: MassMatrix, forms: Mapping[Symbol, LinearSum], left: Sequence[Symbol]
) -> MassMatrix:
    """Return the mass matrix and the right side of what is left, in which the others follow."""
    found = MassMatrix(own.definitions, named=own.named)

    def entry(a: Symbol, b: Symbol) -> Expr:
        return own.entries.get((a, b), Integer(0))

    def part(d: Symbol, u: Symbol) -> Expr:
        return forms[d].get(u, Integer(0))

    along = {(d, u): found.cut("along", entry(d, u) + _total(entry(d, e) * part(e, u)
             for e in forms)) for d in forms for u in left}  # fmt: skip
    push = {d: found.cut("push", own.right.get(d, Integer(0)) - _total(entry(d, e) * part(e, ONE)
            for e in forms)) for d in forms}  # fmt: skip
    for n, u in enumerate(left):
        for v in left[n:]:
            more = _total(part(d, u) * along[d, v] + entry(u, d) * part(d, v) for d in forms)
            found.add(u, v, found.cut("mass", entry(u, v) + more))
        more = _total(part(d, u) * push[d] - entry(u, d) * part(d, ONE) for d in forms)
        found.act(u, own.right.get(u, Integer(0)) + more)
    return found


def _enforcing(
    own: MassMatrix, system: MassMatrix, rows: Sequence[HeldCondition],
    pivots: Sequence[Elimination], found: Mapping[Symbol, Expr],
) -> LinearSum:  # fmt: skip
    """Return the forces, from the equations of the accelerations that follow."""
    following = [u for pivot in pivots for u in pivot.unknowns]
    place = {u: n for n, u in enumerate(following)}
    turned = []
    for u in following:
        form = {row.force: row.form[u] for row in rows if u in row.form}
        needs = _total(m * found[v] for (a, v), m in system.entries.items() if a == u)
        turned.append({**form, ONE: own.cut("needs", system.right.get(u, Integer(0)) - needs)})
    across = [Elimination(tuple(place[u] for u in p.unknowns), tuple(rows[n].force for n in p.rows))
              for p in pivots]  # fmt: skip
    made = _solved(own, turned, across)
    return {force: form.get(ONE, Integer(0)) for force, form in made.items()}


def _solved(
    own: MassMatrix, zeros: Sequence[LinearSum], pivots: Sequence[Elimination]
) -> dict[Symbol, LinearSum]:
    """Return what follows by sums that are zero, each as a sum of what does not."""
    left, found = dict(enumerate(zeros)), dict[Symbol, LinearSum]()
    for pivot in pivots:
        solved = _pivot_solved(own, [left.pop(n) for n in pivot.rows], pivot.unknowns)
        left = {n: _put(own, form, solved) for n, form in left.items()}
        found |= solved
    for u in reversed(found):
        found[u] = _put(own, found[u], {v: f for v, f in found.items() if v in found[u]})
    return found


def _pivot_solved(
    own: MassMatrix, rows: Sequence[LinearSum], unknowns: Sequence[Symbol]
) -> dict[Symbol, LinearSum]:
    """Return one or two unknowns by as many sums that are zero, by Cramer's rule."""
    others = [k for k in dict.fromkeys(k for row in rows for k in row) if k not in unknowns]
    A = [[row.get(u, Integer(0)) for u in unknowns] for row in rows]
    if len(rows) == 1:
        inverse = own.cut("inverse", 1 / A[0][0])
        return {unknowns[0]: {k: own.cut("by", -rows[0][k] * inverse) for k in others}}
    (a, b), (c, d) = A
    inverse = own.cut("inverse", 1 / own.cut("det", a * d - b * c))
    found: dict[Symbol, LinearSum] = {u: {} for u in unknowns}
    for k in others:
        x, y = (row.get(k, Integer(0)) for row in rows)
        for u, value in zip(unknowns, (b * y - d * x, c * x - a * y), strict=True):
            found[u][k] = own.cut("by", value * inverse)
    return found


def _put(own: MassMatrix, form: LinearSum, known: Mapping[Symbol, LinearSum]) -> LinearSum:
    """Return a sum with forms put into it."""
    found = {k: x for k, x in form.items() if k not in known}
    for u in (k for k in form if k in known):
        for k, x in known[u].items():
            found[k] = found.get(k, Integer(0)) + form[u] * x
    return {k: own.cut("put", x) for k, x in found.items() if x != 0}


def _sum(form: LinearSum, values: Mapping[Symbol, Expr]) -> Expr:
    return _total(x if k is ONE else x * values[k] for k, x in form.items())


def _total(terms: Iterable[Expr]) -> Expr:
    return sum(terms, Integer(0))


def pivots_of(
    slopes: Doubles, unknowns: Sequence[Symbol], sizes: Sequence[int]
) -> tuple[Elimination, ...] | None:
    """Return what follows by which conditions, by slopes (points, conditions, unknowns).

    sizes : how many are solved together, what is preferred first
    """
    left, found = np.array(slopes), list[Elimination]()
    rows, columns = [*range(left.shape[1])], [*range(left.shape[2])]
    while rows:
        for size in sizes:
            least, (r, c) = _clearest(left, rows, columns, size)
            if least > CLEAR:
                break
        else:
            return None
        found.append(Elimination(r, tuple(unknowns[k] for k in c)))
        rows = [k for k in rows if k not in r]
        columns = [k for k in columns if k not in c]
        left = _eliminated(left, r, c, rows)
    return tuple(found)


def _clearest(
    left: Doubles, rows: Sequence[int], columns: Sequence[int], size: int
) -> tuple[float, tuple[Picked, Picked]]:
    """Return the pivot that is largest where it is smallest, and its conditions and unknowns."""
    used = np.any(np.abs(left) > NOISE, axis=0)
    each = [(r, c) for r in combinations(rows, size) for c in _held_by(used, r, columns)]
    best: tuple[float, tuple[Picked, Picked]] = (0.0, ((), ()))
    for n in range(0, len(each), MOST_AT_ONCE):
        some = each[n : n + MOST_AT_ONCE]
        sizes = _sized(left, [r for r, _ in some], [c for _, c in some])
        low, high = np.min(sizes, axis=0), np.max(sizes, axis=0)
        least = np.where(low * high > 0, np.min(np.abs(sizes), axis=0), 0.0)
        if least[k := int(np.argmax(least))] > best[0]:
            best = float(least[k]), some[k]
    return best


def _held_by(used: Doubles, rows: Picked, columns: Sequence[int]) -> Iterable[Picked]:
    """Return as many unknowns as there are conditions, each held by a condition of its own."""
    own = ([k for k in columns if used[r, k]] for r in rows)
    return sorted({tuple(sorted(c)) for c in product(*own) if len({*c}) == len(rows)})


def pivot_sizes(
    slopes: Doubles, unknowns: Sequence[Symbol], pivots: Sequence[Elimination]
) -> Doubles:
    """Return the smallest pivot at each point, beside the largest slopes of its conditions."""
    left, found = np.array(slopes), np.ones(len(slopes))
    rows = [*range(left.shape[1])]
    for pivot in pivots:
        columns = [unknowns.index(u) for u in pivot.unknowns]
        sizes = _sized(left, [pivot.rows], [tuple(columns)])
        found = np.minimum(found, np.abs(sizes[:, 0]))
        rows = [k for k in rows if k not in pivot.rows]
        left = _eliminated(left, pivot.rows, columns, rows)
    return found


def _eliminated(
    left: Doubles, pivots: Sequence[int], columns: Sequence[int], rows: Sequence[int]
) -> Doubles:
    """Return slopes without what pivots take out of other rows."""
    found = np.array(left)
    square = left[:, pivots][:, :, columns]
    found[:, rows] -= left[:, rows][:, :, columns] @ np.linalg.pinv(square) @ left[:, pivots]
    return found


def _sized(left: Doubles, rows: Sequence[Picked], columns: Sequence[Picked]) -> Doubles:
    """Return pivots (points, pivots), beside the largest slopes of their conditions."""
    r, c = np.array(rows, int), np.array(columns, int)
    size = np.prod(np.max(np.abs(left), axis=2)[:, r], axis=2)
    pivot: Doubles = np.linalg.det(left[:, r[:, :, None], c[:, None, :]])
    return pivot / np.where(size > 0, size, np.inf)
