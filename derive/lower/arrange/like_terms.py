"""Like terms of a sum gathered: those that differ in what rests on parameters only."""

from collections.abc import Set as AbstractSet

from sympy import Add, Expr, Integer, Mul, Symbol


def like_terms(e: Expr, constant: AbstractSet[Symbol]) -> dict[Expr, Expr]:
    """Return the coefficient, made of parameters, of every product of what varies in a sum.

    >>> from sympy import sqrt, symbols
    >>> a, b, x, y = symbols("a b x y")
    >>> like_terms(a * x * y - x * (b * y + 1), {a, b})
    {x*y: a - b, x: -1}
    >>> like_terms(x * sqrt(x + a), {a})
    {x*sqrt(a + x): 1}
    """
    names: dict[Expr, Symbol] = {}
    masked = _masked(e, constant, names).expand()
    values = {name: value for value, name in names.items()}
    found: dict[Expr, Expr] = {}
    for term in sorted(Add.make_args(masked), key=str):
        factors = Mul.make_args(term)
        own = Mul(*(f for f in factors if f.free_symbols - values.keys()))
        product = own.xreplace(values)
        found[product] = found.get(product, Integer(0)) + (term / own).xreplace(values)
    return {product: c for product, c in found.items() if c != 0}


def _masked(e: Expr, constant: AbstractSet[Symbol], names: dict[Expr, Symbol]) -> Expr:
    """Return an expression with a symbol for whatever in it rests on parameters only."""
    if e.is_Symbol or e.is_Number:
        return e if e not in constant else names.setdefault(e, Symbol(f"constant {len(names):04d}"))
    if e.free_symbols <= constant:
        number, rest = e.as_coeff_Mul()
        return number * names.setdefault(rest, Symbol(f"constant {len(names):04d}"))
    if isinstance(e, Add | Mul):
        own = e.func(*(a for a in e.args if a.free_symbols <= constant))
        others = [_masked(a, constant, names) for a in e.args if not a.free_symbols <= constant]
        return e.func(_masked(own, constant, names), *others)
    return e.func(*(_masked(a, constant, names) for a in e.args))


def gathered(e: Expr, constant: AbstractSet[Symbol]) -> Expr:
    """Return a sum multiplied out, its like terms put together."""
    return Add(*(c * own for own, c in like_terms(e, constant).items()))
