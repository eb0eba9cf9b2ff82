"""An exact expression multiplied out: a sum of terms, each a coefficient times powers of atoms.

The coefficient of a term holds all that is made of parameters, collected exactly, so that
(I_yy - I_zz) omega_y omega_z is one term, of two products. The sum can be valued, and
differentiated term by term, in any arithmetic: balls, exact fractions.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from sympy import Add, Expr, Mul, Pow, Rational, Symbol, cos, pi, sin, tan

from derive.scene.formula import Arithmetic
from derive.verify.operators import SLOPES

AtomPowers = tuple[tuple[int, int], ...]  # (atom, power), by atom
Polynomial = dict[AtomPowers, Fraction]


@dataclass(frozen=True)
class Atom:
    """What a term is a product of: a symbol, pi, or a function of a polynomial."""

    kind: str  # "symbol" | "pi" | "inverse" | a function with a slope
    symbol: Symbol | None
    inner: tuple[tuple[AtomPowers, Fraction], ...]


@dataclass
class Atoms:
    """All atoms of a set of expressions, each after those it is made of."""

    each: list[Atom] = field(default_factory=list)
    places: dict[Atom, int] = field(default_factory=dict)
    memory: dict[Expr, Polynomial] = field(default_factory=dict)

    def place(self, atom: Atom) -> int:
        """Return where ``atom`` stands, new ones last."""
        if atom not in self.places:
            self.places[atom] = len(self.each)
            self.each.append(atom)
        return self.places[atom]

    def symbol(self, symbol: Symbol) -> int:
        """Return where a symbol stands."""
        return self.place(Atom("symbol", symbol, ()))

    def within(self, monomial: AtomPowers) -> set[int]:
        """Return the atoms of a monomial, and those that its functions are made of."""
        found: set[int] = set()
        for atom, _ in monomial:
            found.add(atom)
            for inner, _ in self.each[atom].inner:
                found |= self.within(inner)
        return found

    def power(self, kind: str, inner: Polynomial, power: int) -> Polynomial:
        """Return a power of a function of a polynomial."""
        atom = Atom(kind, None, tuple(sorted(inner.items())))
        return {((self.place(atom), power),): Fraction(1)}

    def polynomial(self, expression: Expr) -> Polynomial:
        """Return ``expression`` multiplied out.

        >>> from sympy import symbols
        >>> x, y = symbols("x y")
        >>> sorted(Atoms().polynomial((x + y) * (x - y)).values())
        [Fraction(-1, 1), Fraction(1, 1)]
        """
        if expression not in self.memory:
            self.memory[expression] = self._multiplied_out(expression)
        return self.memory[expression]

    def _multiplied_out(self, e: Expr) -> Polynomial:
        if isinstance(e, Rational):
            return {(): Fraction(int(e.p), int(e.q))} if e.p else {}
        if isinstance(e, Symbol):
            return {((self.symbol(e), 1),): Fraction(1)}
        if isinstance(e, Add):
            return total(self.polynomial(part) for part in e.args)
        if isinstance(e, Mul):
            return multiplied(*(self.polynomial(part) for part in e.args))
        if isinstance(e, Pow) and isinstance(e.exp, Rational):
            return self._raised(self.polynomial(e.base), e.exp)
        if e.func.__name__ in SLOPES:
            return self.power(e.func.__name__, self.polynomial(e.args[0]), 1)
        if isinstance(e, tan):
            return self.polynomial(sin(e.args[0]) / cos(e.args[0]))
        if e == pi:
            return {((self.place(Atom("pi", None, ())), 1),): Fraction(1)}
        raise TypeError(f"an exact expression is made of + * ^ {' '.join(SLOPES)}, found {e}")

    def _raised(self, base: Polynomial, exponent: Rational) -> Polynomial:
        if exponent.q == 2:
            return self.power("sqrt", base, int(exponent.p))
        power = int(exponent)
        if power > 0:
            return multiplied(*[base] * power)
        if len(base) == 1:
            ((monomial, coefficient),) = base.items()
            return {tuple((a, p * power) for a, p in monomial): coefficient**power}
        return self.power("inverse", base, -power)


def total(polynomials: Iterable[Polynomial]) -> Polynomial:
    """Return the sum of polynomials."""
    summed: Polynomial = {}
    for polynomial in polynomials:
        for monomial, coefficient in polynomial.items():
            summed[monomial] = summed.get(monomial, Fraction(0)) + coefficient
    return {monomial: c for monomial, c in summed.items() if c}


def multiplied(first: Polynomial, *others: Polynomial) -> Polynomial:
    """Return the product of polynomials."""
    product = first
    for other in others:
        parts: list[Polynomial] = [
            {_joined(m, n): c * d for n, d in other.items()} for m, c in product.items()
        ]
        product = total(parts)
    return product


def _joined(a: AtomPowers, b: AtomPowers) -> AtomPowers:
    powers = dict(a)
    for atom, power in b:
        powers[atom] = powers.get(atom, 0) + power
    return tuple(sorted((atom, power) for atom, power in powers.items() if power))


def raised(x: Any, power: int) -> Any:
    """Return a whole power by products: a ball's own power is undefined where it holds zero."""
    if power < 0:
        return 1 / raised(x, -power)
    product = x
    for _ in range(power - 1):
        product = product * x
    return product


@dataclass(frozen=True)
class CollectedTerm:
    """A coefficient made of parameters, times powers of atoms that vary."""

    coefficient: tuple[tuple[AtomPowers, Fraction], ...]
    factors: AtomPowers


def collected_terms(
    polynomial: Polynomial, varies: Callable[[int], bool]
) -> tuple[CollectedTerm, ...]:
    """Return a polynomial's terms, all that goes with the same varying factors in one."""
    grouped: dict[AtomPowers, Polynomial] = {}
    for monomial, number in polynomial.items():
        varying = tuple((a, p) for a, p in monomial if varies(a))
        fixed = tuple((a, p) for a, p in monomial if not varies(a))
        grouped.setdefault(varying, {})[fixed] = number
    return tuple(CollectedTerm(tuple(c.items()), factors) for factors, c in grouped.items())


def value(
    polynomial: Iterable[tuple[AtomPowers, Fraction]],
    atoms: Mapping[int, Any],
    arithmetic: Arithmetic,
) -> Any:
    """Return the value of a polynomial where its atoms have the values given."""
    summed = arithmetic["number"](Fraction(0))
    for monomial, number in polynomial:
        product = arithmetic["number"](number)
        for atom, power in monomial:
            product = product * raised(atoms[atom], power)
        summed = summed + product
    return summed
