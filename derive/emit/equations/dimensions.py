"""The unit of what equations name in between, by the units of what it is made of."""

from collections.abc import Mapping
from fractions import Fraction

from sympy import Expr, Symbol

from derive.scene.unit import BESIDE_SI, NONE, Dimension, dimension

Dimensions = Mapping[Symbol, Dimension]


def dimension_said(unit: str) -> Dimension:
    """Return the dimension of a declared unit; results may have some beside SI, as days."""
    return dimension(BESIDE_SI[unit][0] if unit in BESIDE_SI else unit or "1")


def dimension_made(value: Expr, known: Dimensions) -> Dimension | None:
    """Return the dimension of an expression; None for zero, which agrees with any.

    known : of its symbols; what stands in none has None, and so has what it multiplies

    >>> from sympy import Symbol
    >>> m, l = Symbol("m"), Symbol("l")
    >>> dimension_made(2*m*l**2, {m: dimension("kg"), l: dimension("m")}) == dimension("kg m^2")
    True
    """
    if value.is_Symbol:
        return known.get(value)
    if value.is_number:
        return None if value == 0 else NONE
    if value.is_Add:
        every = (dimension_made(term, known) for term in value.args)
        return next((one for one in every if one is not None), None)
    if value.is_Mul:
        return _product([dimension_made(factor, known) for factor in value.args])
    if value.is_Pow:
        base, power = dimension_made(value.base, known), value.exp
        return (
            None if base is None else raised_dimension(base, Fraction(int(power.p), int(power.q)))
        )
    return NONE  # sines and their like


def joined_dimensions(left: Dimension, right: Dimension) -> Dimension:
    """Return the dimension of a product."""
    return left[0] + right[0], left[1] + right[1], left[2] + right[2]


def raised_dimension(base: Dimension, power: Fraction) -> Dimension:
    """Return the dimension of a power."""
    return base[0] * power, base[1] * power, base[2] * power


def _product(factors: list[Dimension | None]) -> Dimension | None:
    whole = NONE
    for one in factors:
        if one is None:
            return None
        whole = joined_dimensions(whole, one)
    return whole
