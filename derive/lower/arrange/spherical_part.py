"""The spherical part of a tensor taken off: omega x (I omega) with I less a multiple of 1.

Three components hold a cross product of omega with something linear where their products do no work
on omega. What is linear follows by division, but for a multiple of omega itself, which is chosen so
that the fewest terms are left (lecture step "spherical_part"). Near a sphere nothing is left to
cancel, and on the way there are fewer operations.
"""

from collections.abc import Mapping, Sequence
from itertools import permutations
from math import prod

from sympy import Add, Expr, Integer, Matrix, Mul, Pow, Symbol, diag, eye

from derive.lower.arrange.column import NamedColumns

ZERO = Integer(0)
MOST = 8  # symbols of which three are tried as omega
LONGEST_SUM = 400  # terms that a component is multiplied out to; longer ones are left as they are

Products = Mapping[frozenset[Symbol], Expr]  # coefficients of products of two symbols


def spherical_part(column: Matrix, columns: NamedColumns) -> Matrix | None:
    """Return a column with omega x l, and l named, for the products with omega that are in it."""
    if max(map(terms_of, column)) > LONGEST_SUM:
        return None
    parts = [columns.like_terms(e) for e in column]
    pairs = [{pair: c for p, c in own.items() if (pair := _pair(p))} for own in parts]
    symbols = sorted({s for own in pairs for pair in own for s in pair}, key=str)
    if not all(pairs) or len(symbols) > MOST:
        return None
    for omega in permutations(symbols, 3):
        turning = [{pair: c for pair, c in own.items() if pair & {*omega}} for own in pairs]
        inner = divided(turning, omega)
        if inner is not None:
            cross = Matrix(omega).cross(columns.column("l", inner))
            rest = [[c * p for p, c in own.items() if _pair(p) not in t]
                    for own, t in zip(parts, turning, strict=True)]  # fmt: skip
            return cross + Matrix([Add(*terms) for terms in rest])
    return None


def terms_of(e: Expr) -> int:
    """Return how many terms an expression has, multiplied out, before like ones are gathered.

    >>> from sympy import symbols
    >>> a, b, c = symbols("a b c")
    >>> terms_of((a + b) * (a + b + c) - 2 * a), terms_of((a + b) ** 3)
    (7, 8)
    """
    each = [terms_of(a) for a in e.args] if isinstance(e, Add | Mul) else []
    if isinstance(e, Pow) and e.exp.is_Integer and e.exp > 0:
        return int(terms_of(e.base) ** e.exp)
    return sum(each) if isinstance(e, Add) else prod(each)


def _pair(product: Expr) -> frozenset[Symbol]:
    """Return the symbols of a product of two, of one if it is a square; none of anything else."""
    powers = [f.as_base_exp() for f in Mul.make_args(product)]
    whole = all(base.is_Symbol for base, _ in powers) and sum(n for _, n in powers) == 2
    return frozenset(base for base, _ in powers) if whole else frozenset()


def divided(q: Sequence[Products], omega: Sequence[Symbol]) -> Matrix | None:
    """Return l of q = omega x l, None if there is none."""
    if not all(map(_can_be, q, [omega[1:], [omega[2], omega[0]], omega[:2]])):
        return None
    linear: list[dict[Symbol, Expr]] = [{}, {}, {}]
    for s in sorted({s for own in q for pair in own for s in pair}, key=str):
        for k in (k for k in range(3) if s != omega[k]):
            linear[k][s] = q[(k + 1) % 3].get(frozenset([omega[(k + 2) % 3], s]), ZERO)
    a = q[0].get(frozenset([omega[1], omega[2]]), ZERO)
    b = q[1].get(frozenset([omega[2], omega[0]]), ZERO)
    moments = without_spherical_part(diag(a + b, 0, a))
    for k in range(3):
        linear[k][omega[k]] = moments[k, k]
    if not all(_is_component(own, k, linear, omega) for k, own in enumerate(q)):
        return None
    return Matrix([Add(*(c * s for s, c in own.items())) for own in linear])


def _can_be(own: Products, others: Sequence[Symbol]) -> bool:
    """Tell whether there are products, each with one of the two omegas of the other axes."""
    return bool(own) and all(not pair.isdisjoint(others) for pair in own)


def _is_component(
    own: Products, k: int, linear: Sequence[Mapping[Symbol, Expr]], omega: Sequence[Symbol]
) -> bool:
    """Tell whether products are component ``k`` of omega x l, coefficient by coefficient."""
    i, j = (k + 1) % 3, (k + 2) % 3
    left: dict[frozenset[Symbol], Expr] = dict(own)
    for w, part, sign in ((omega[i], linear[j], -1), (omega[j], linear[i], 1)):
        for s, c in part.items():
            pair = frozenset([w, s])
            left[pair] = left.get(pair, ZERO) + sign * c
    return all(c == 0 or c.expand() == 0 for c in left.values())


def without_spherical_part(tensor: Matrix) -> Matrix:
    """Return the tensor less the multiple of the identity that leaves the fewest moments."""
    moments = [tensor[1, 1], tensor[0, 0], tensor[2, 2]]
    best = max(moments, key=lambda c: sum((m - c).expand() == 0 for m in moments))
    return tensor - best * eye(3)
