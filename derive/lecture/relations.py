"""What is left of an expression once polynomial relations are used: exact, and never too little.

Reasons such as R^T R = 1 or |q| = 1 do not explain one symbol; they are relations. A difference
follows from them if its remainder is zero. The remainder is taken by a Groebner basis, which proves
whatever follows, or, where a basis would be huge, by the relations as they stand: that may leave
too much, never too little, so what is accepted is always proved.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from sympy import QQ, Expr, Integer, Poly, Symbol, cos, expand, fraction, groebner, sin, together
from sympy.polys.orderings import grevlex
from sympy.polys.rings import PolyRing

_FEW = 15  # symbols up to which a nonlinear Groebner basis takes a fraction of a second

_FEWER = 8  # the same where the rates of the relations join them


class ContradictionError(ValueError):
    """The relations exclude one another, so that anything would follow from them."""


def left_by_relations(
    differences: Sequence[Expr], relations: Sequence[Expr], rates: Sequence[Expr] = ()
) -> tuple[Expr, ...]:
    """Return what is left of each difference when every relation, and every rate of one, is zero.

    >>> from sympy.abc import x, y
    >>> left_by_relations([x**2 - y**2, x], [x - y])
    (0, y)
    """
    wanted = [polynomial(difference) for difference in differences]
    if not any(wanted):
        return tuple(wanted)
    given, moving = ([polynomial(each) for each in some] for some in (relations, rates))
    spoken = {s for each in (*given, *wanted) for s in each.free_symbols}
    moving = [each for each in moving if each.free_symbols <= spoken]
    circles = _circles([*given, *moving, *wanted])
    basis = _basis(tuple(sorted({g for g in (*given, *circles) if g != 0}, key=str)))
    left = _remainders(wanted, basis)
    if not any(left) or not any(moving):
        return left
    if len({s for r in (*given, *moving, *circles) for s in r.free_symbols}) <= _FEWER:
        basis = _basis(tuple(sorted({g for g in (*basis, *moving) if g != 0}, key=str)))
        return _remainders(left, basis)
    return _remainders(left, (*basis, *filter(None, moving)))


def polynomial(difference: Expr) -> Expr:
    """Return a polynomial that vanishes where ``difference`` does; sines become symbols."""
    difference = expand(difference)
    turns = difference.atoms(sin, cos)
    difference = difference.xreplace({turn: Symbol(str(turn), real=True) for turn in turns})
    if difference.is_polynomial(*difference.free_symbols):
        return difference
    return expand(fraction(together(difference))[0])


def _circles(polynomials: Sequence[Expr]) -> list[Expr]:
    """Return sin^2 + cos^2 - 1 for every angle whose sine or cosine occurs."""
    names = {s.name for p in polynomials for s in p.free_symbols}
    angles = sorted({name[4:-1] for name in names if name.startswith(("sin(", "cos("))})
    return [
        Symbol(f"sin({angle})", real=True) ** 2 + Symbol(f"cos({angle})", real=True) ** 2 - 1
        for angle in angles
    ]


@lru_cache(maxsize=1024)
def _basis(relations: tuple[Expr, ...]) -> tuple[Expr, ...]:
    if not relations:
        return ()
    symbols = sorted({s for r in relations for s in r.free_symbols}, key=str)
    if not symbols:
        raise ContradictionError(f"the reasons contradict one another: {relations[0]} = 0")
    if len(symbols) > _FEW and any(Poly(r, *symbols).total_degree() > 1 for r in relations):
        return relations
    basis = tuple(groebner(relations, *symbols, order="grevlex").exprs)
    if basis == (Integer(1),):
        raise ContradictionError("the reasons contradict one another")
    return basis


def _remainders(differences: Sequence[Expr], basis: tuple[Expr, ...]) -> tuple[Expr, ...]:
    if not any(differences) or not basis:
        return tuple(differences)
    symbols = {s for each in (*differences, *basis) for s in each.free_symbols}
    polynomials = PolyRing(sorted(symbols, key=str), QQ, grevlex)
    divisors = [polynomials.from_expr(each) for each in basis]
    return tuple(polynomials.from_expr(d).rem(divisors).as_expr() for d in differences)
