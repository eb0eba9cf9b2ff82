"""Equations cut so that no term is wider than a line: what is too wide gets a name of its own."""

from collections.abc import Iterable, Iterator, Mapping

from sympy import Add, Expr, Integer, Symbol, preorder_traversal

from derive.emit.notation.lines import width
from derive.emit.notation.symbolic import symbolic_layout

TwoSides = tuple[Expr, Expr]
WIDEST = 36.0
"""Width of a term in em: lines break between terms, and hold 40."""


def fitted(
    equations: Iterable[TwoSides], names: Mapping[Symbol, str], known: dict[Expr, Expr]
) -> Iterator[TwoSides]:
    """Yield equations whose terms fit a line, each after the sums that are named for it.

    known : what has been named already, by what it stands for; added to
    """
    for sides in equations:
        left, right = sides[0].xreplace(known), sides[1].xreplace(known)
        while part := _too_wide((left, right), names):
            *before, (_, value) = fitted([(Integer(0), part)], names, known)
            symbol = Symbol("part" + "'" * len(known), real=True)
            known[part] = symbol
            yield from [*before, (symbol, value)]
            left, right = left.xreplace({part: symbol}), right.xreplace({part: symbol})
        yield left, right


def _too_wide(sides: TwoSides, names: Mapping[Symbol, str]) -> Expr | None:
    """Return the widest sum within a term that is too wide, None if there is none."""
    for term in (term for side in sides for term in Add.make_args(side)):
        if _wide(term, names) > WIDEST:
            sums = [e for e in preorder_traversal(term) if e.is_Add]
            if sums:
                return max(sums, key=lambda e: _wide(e, names))
    return None


def _wide(expression: Expr, names: Mapping[Symbol, str]) -> float:
    return width(symbolic_layout(expression, names))
