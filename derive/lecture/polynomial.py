"""Expressions multiplied out as polynomials of symbols, sines and cosines.

SymPy multiplies out any expression, by walking through it once a rule; sums of products of
symbols and waves are added and multiplied here, a monomial being one whole number.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction

from sympy import Add, Expr, Mul, Pow, Rational, cos, sin

BITS = 16
"""Of a monomial's number hold the exponent of an atom."""
HIGHEST = 1 << (BITS - 1)
WithoutBrackets = dict[int, Fraction | int]


class NotAPolynomialError(ValueError):
    """An expression that holds more than sums, products, whole powers, symbols, sines, cosines."""


@dataclass
class Multiplied:
    """Polynomials of the same atoms, which are met as expressions are read."""

    atoms: dict[Expr, int] = field(default_factory=dict)
    known: dict[Expr, WithoutBrackets] = field(default_factory=dict)

    def of(self, value: Expr) -> WithoutBrackets:
        """Return the terms of an expression. Raises NotAPolynomialError if it is no polynomial."""
        found = self.known.get(value)
        if found is None:
            found = self.known[value] = self._of(value)
        return found

    def _of(self, value: Expr) -> WithoutBrackets:
        if isinstance(value, Rational):
            p, q = int(value.p), int(value.q)
            return {0: p if q == 1 else Fraction(p, q)} if p else {}
        if value.is_Symbol or (isinstance(value, (sin, cos)) and _is_flat(value.args[0])):
            return {1 << (BITS * self.atoms.setdefault(value, len(self.atoms))): 1}
        if value.is_Add:
            return _sum(map(self.of, value.args))
        if value.is_Mul:
            return _product(map(self.of, value.args))
        if value.is_Pow and value.exp.is_Integer and 0 < value.exp < HIGHEST:
            return _product([self.of(value.base)] * int(value.exp))
        raise NotAPolynomialError(str(value))

    def without_squared_sines(self, terms: WithoutBrackets) -> WithoutBrackets:
        """Return terms with sin^2 = 1 - cos^2."""
        for atom, place in tuple(self.atoms.items()):
            if isinstance(atom, sin) and any(_power(m, place) > 1 for m in terms):
                other = self.atoms.setdefault(cos(*atom.args), len(self.atoms))
                square: WithoutBrackets = {0: 1, 2 << (BITS * other): -1}
                terms = _sum(_lowered(m, x, place, square) for m, x in terms.items())
        return terms

    def written(self, terms: WithoutBrackets) -> Expr:
        """Return the sum of some terms."""
        atoms = tuple(self.atoms.items())
        return Add(*(
            Mul(
                Rational(x) if isinstance(x, int) else Rational(x.numerator, x.denominator),
                *(Pow(atom, _power(m, k)) for atom, k in atoms if _power(m, k)),
            )
            for m, x in terms.items()
        ))  # fmt: skip


def without_brackets(value: Expr) -> Expr:
    """Return an expression multiplied out.

    >>> from sympy import symbols
    >>> a, b = symbols("a b")
    >>> without_brackets((a + b) * (a - sin(b)) / 2 - a**2 / 2)
    a*b/2 - a*sin(b)/2 - b*sin(b)/2
    """
    by = Multiplied()
    try:
        return by.written(by.of(value))
    except NotAPolynomialError:
        return value.expand()


def _is_flat(angle: Expr) -> bool:
    """Tell whether an angle is a sum of symbols, or of parts of them, as it stands."""
    each = (term.as_coeff_Mul()[1] for term in Add.make_args(angle))
    return all(rest.is_Symbol or rest.is_Rational for rest in each)


def _power(monomial: int, place: int) -> int:
    return (monomial >> (BITS * place)) & ((1 << BITS) - 1)


def _lowered(
    monomial: int, x: Fraction | int, place: int, square: WithoutBrackets
) -> WithoutBrackets:
    """Return a term with even powers of an atom written by what its square is."""
    half = _power(monomial, place) // 2
    alone: WithoutBrackets = {monomial - (2 * half << (BITS * place)): x}
    return _product([alone, *[square] * half])


def _sum(each: Iterable[WithoutBrackets]) -> WithoutBrackets:
    found: WithoutBrackets = {}
    for terms in each:
        for m, x in terms.items():
            found[m] = found.get(m, 0) + x
    return {m: x for m, x in found.items() if x}


def _product(each: Iterable[WithoutBrackets]) -> WithoutBrackets:
    found: WithoutBrackets = {0: 1}
    for terms in each:
        made: WithoutBrackets = {}
        for m, x in found.items():
            for n, y in terms.items():
                made[m + n] = made.get(m + n, 0) + x * y
        found = {m: x for m, x in made.items() if x}
    return found
