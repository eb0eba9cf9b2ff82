"""The rate of an expression: the product and chain rules, computed on the tree, never assumed.

A vector has a rate seen from the inertial frame N and a rate seen from the moving axes xyz. Both
obey the product rule; they differ only in what the rate of a symbol is called.
"""

from __future__ import annotations

from collections.abc import Callable

from derive.lecture.vectors import Expression, cosine, reciprocal, sine, turn_written_out, zero

Naming = Callable[[str, tuple[int, ...]], str]

# Rates seen from N that have a letter of their own.
_LETTERS = {
    "r_i": "v_i", "v_i": "a_i", "r_A": "v_A", "v_A": "a_A", "r_G": "v_G", "v_G": "a_G",
    "b_i": "b_i_dot", "Q": "Q_dot", "T": "T_dot",
}  # fmt: skip
_UNDER = {rate: base for base, rate in _LETTERS.items()}
_LINEAR = ("add", "negate", "cross_tensor", "transpose", "trace", "axial", "component", "quantity")
_BILINEAR = ("scale", "dot", "cross", "apply", "outer")


def seen_from_axes(name: str, shape: tuple[int, ...] = (3,)) -> str:  # noqa: ARG001
    """Return the name of the rate of ``name`` seen from the moving axes.

    >>> seen_from_axes("l"), seen_from_axes("rho_dot"), seen_from_axes("l_N_dot")
    ('l_dot', 'rho_ddot', 'l_N_dot_dot')
    """
    if name.endswith("_dot") and not name.endswith("_N_dot"):
        return name.removesuffix("_dot") + "_ddot"
    return name + "_dot"


def seen_from_N(name: str, shape: tuple[int, ...] = (3,)) -> str:
    """Return the name of the rate of ``name`` seen from N; a scalar has but one rate.

    >>> seen_from_N("l"), seen_from_N("l_N_dot"), seen_from_N("r_i"), seen_from_N("m", ())
    ('l_N_dot', 'l_N_ddot', 'v_i', 'm_dot')
    """
    if name in _LETTERS:
        return _LETTERS[name]
    if shape == ():
        return seen_from_axes(name)
    if name.endswith("_N_dot"):
        return name.removesuffix("_N_dot") + "_N_ddot"
    return name + "_N_dot"


def rate_of(name: str) -> tuple[str, Naming] | None:
    """Return whose rate ``name`` is, and seen from where; None if it is nobody's rate.

    >>> rate_of("l_N_dot")[0], rate_of("a_i")[0], rate_of("omega")
    ('l', 'v_i', None)
    """
    if name in _UNDER:
        return _UNDER[name], seen_from_N
    endings = (("_N_ddot", "_N_dot"), ("_N_dot", ""), ("_ddot", "_dot"), ("_dot", ""))
    for ending, before in endings:
        if name.endswith(ending):
            naming = seen_from_N if "_N_" in ending else seen_from_axes
            return name.removesuffix(ending) + before, naming
    return None


def without_rates(name: str) -> str:
    """Return the symbol at the bottom of a chain of rates.

    >>> without_rates("a_i"), without_rates("l_N_dot_dot")
    ('r_i', 'l')
    """
    below = rate_of(name)
    return name if below is None else without_rates(below[0])


def rate(expression: Expression, naming: Naming = seen_from_axes) -> Expression:
    """Return the time derivative of ``expression``; a symbol's rate is called ``naming(symbol)``.

    Sums run over the same particles at all times, so the rate of a sum is the sum of rates.
    """
    operator, operands, shape = expression.operator, expression.operands, expression.shape
    if operator in ("symbol", "inertia"):
        return Expression(operator, shape=shape, name=naming(expression.name, shape))
    if not operands:
        return zero(*shape)
    rates = [rate(operand, naming) for operand in operands]
    if operator in _LINEAR or operator in ("sum", "others"):
        return _simple(Expression(operator, tuple(rates), shape, expression.name))
    if operator == "turn":
        return rate(turn_written_out(*operands), naming)
    if operator in _BILINEAR:
        return _product(operator, shape, operands, rates)
    return _chain(operator, operands[0], rates[0])


def _product(
    operator: str,
    shape: tuple[int, ...],
    operands: tuple[Expression, ...],
    rates: list[Expression],
) -> Expression:
    first = _simple(Expression(operator, (rates[0], operands[1]), shape))
    second = _simple(Expression(operator, (operands[0], rates[1]), shape))
    return _simple(first + second)


def _chain(operator: str, inner: Expression, rate_of_inner: Expression) -> Expression:
    outer_rate = {
        "sin": cosine(inner),
        "cos": -sine(inner),
        "reciprocal": -(reciprocal(inner) * reciprocal(inner)),
    }[operator]
    return _simple(rate_of_inner * outer_rate)


def _simple(expression: Expression) -> Expression:
    """Leave out zeros, so that the rate of a constant leaves no trace."""
    absent = [operand.operator == "zero" for operand in expression.operands]
    if expression.operator == "add" and any(absent):
        return expression.operands[0 if absent[1] else 1]
    return zero(*expression.shape) if any(absent) else expression
