"""How operators are written: one table, a row an operator that is no plain call of its function."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.program.arithmetic import OPERATORS, rounded
from derive.program.precision import F64, Precision


@dataclass(frozen=True)
class Written:
    """The patterns of an operator in C and in CasADi, and what it rests on in pairs of floats.

    c, casadi : {0}, {1} stand for operands, {top} and {u} for 2^(p - 1) and 2^-p; "" for a call
    rests     : the functions that the one of pairs calls; None if it has none of its own
    """

    c: str = ""
    casadi: str = ""
    rests: tuple[str, ...] | None = None


def _sign(sign: str, *rests: str) -> Written:
    both = f"{{0}} {sign} {{1}}"
    return Written(both, both, rests)


_TOP = "({top} * {0} + {0})"
_TOP_PYTHON = "4503599627370497.0 * {0}"
_WIDE = ("neg", "add", "two_product", "mul")
WRITTEN: Mapping[str, Written] = {
    "neg": Written("-{0}", "-{0}", ()),
    "low": Written(rests=()),
    "add": _sign("+"),
    "sub": _sign("-", "neg", "add"),
    "two_product": Written(rests=()),
    "mul": _sign("*", "two_product"),
    "div": _sign("/", *_WIDE),
    "sqrt": Written(rests=("neg", "add", "two_product")),
    "sine": Written(rests=_WIDE),
    "sin": Written(rests=(*_WIDE, "sine")),
    "cos": Written(rests=(*_WIDE, "sine")),
    # Every product is one with a power of two (Rump): fused operations give the same.
    "power_of_two": Written(
        f"{_TOP} - ({_TOP} - {{u}} * {_TOP})",
        f"{_TOP_PYTHON} - 0.9999999999999999 * ({_TOP_PYTHON})",
        (),
    ),
    "pi": Written(rests=()),
    "unit_roundoff": Written(rests=()),
    "splitter": Written(rests=()),
    # CasADi's fabs has the derivative 0 at 0, and |x|^2 then no second one.
    "abs": Written("", "ca.if_else({0} < 0.0, -1.0, 1.0) * {0}", ("neg",)),
    "less": _sign("<"),
    "at_most": _sign("<="),
    "both": Written("{0} & {1}", "ca.logic_and({0}, {1})"),
    "either": Written("{0} | {1}", "ca.logic_or({0}, {1})"),
    "select": Written("{0} ? {1} : {2}", "ca.if_else({0}, {1}, {2})"),
}


def literal(q: Fraction, precision: Precision) -> str:
    """Return a constant that reads back as the float nearest to ``q``.

    >>> from derive.program.precision import F32
    >>> literal(Fraction(1, 3), F32), literal(Fraction(-2), F64)
    ('0.333333343F', '(-2.0)')
    """
    text = f"{float(rounded(q, precision.dtype)):.{precision.digits}g}"
    if precision is F64:
        text = repr(float(rounded(q, precision.dtype)))
    if not any(mark in text for mark in ".en"):
        text += ".0"
    return f"({text}{precision.suffix})" if q < 0 else text + precision.suffix


def in_c(operator: str, operands: Sequence[str], precision: Precision) -> str:
    """Return an operation on floats in C."""
    number = OPERATORS[operator].number
    if number is not None:
        return literal(number(precision.bits), precision)
    pattern = WRITTEN[operator].c if operator in WRITTEN else ""
    if not pattern:
        return f"{precision.functions[operator]}({', '.join(operands)})"
    top, u = (Fraction(2) ** power for power in (precision.bits - 1, -precision.bits))
    return pattern.format(*operands, top=literal(top, precision), u=literal(u, precision))


def in_casadi(operator: str, operands: Sequence[str]) -> str:
    """Return an operation on doubles in CasADi."""
    number = OPERATORS[operator].number
    if number is not None:
        return repr(float(rounded(number(F64.bits), F64.dtype)))
    pattern = WRITTEN[operator].casadi if operator in WRITTEN else ""
    return pattern.format(*operands) if pattern else f"ca.{operator}({', '.join(operands)})"
