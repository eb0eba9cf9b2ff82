"""How operators are written: one table, a row an operator that is no plain call of its function."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from derive.program.arithmetic import OPERATORS, rounded
from derive.program.precision import F64, Precision


@dataclass(frozen=True)
class Written:
    """The patterns of an operator, and what it rests on in pairs of floats.

    sign, c, casadi : {0}, {1} stand for operands, {top} and {u} for 2^(p - 1) and 2^-p; "" for a
                      call. The sign serves every language that has no pattern of its own.
    rests           : the functions that the one of pairs calls; None if it has none of its own
    """

    sign: str = ""
    c: str = ""
    casadi: str = ""
    rests: tuple[str, ...] | None = None


_TOP = "(({top} * {0}) + {0})"
_TOP_PYTHON = "4503599627370497.0 * {0}"
_WIDE = ("neg", "add", "two_product", "mul")
WRITTEN: Mapping[str, Written] = {
    "neg": Written("-{0}", rests=()),
    "low": Written(rests=()),
    "add": Written("{0} + {1}", rests=()),
    "sub": Written("{0} - {1}", rests=("neg", "add")),
    "two_product": Written(rests=()),
    "mul": Written("{0} * {1}", rests=("two_product",)),
    "div": Written("{0} / {1}", rests=_WIDE),
    "sqrt": Written(rests=("neg", "add", "two_product")),
    "sine": Written(rests=_WIDE),
    "sin": Written(rests=(*_WIDE, "sine")),
    "cos": Written(rests=(*_WIDE, "sine")),
    # Every product is one with a power of two (Rump): fused operations give the same.
    "power_of_two": Written(
        f"{_TOP} - ({_TOP} - ({{u}} * {_TOP}))",
        casadi=f"{_TOP_PYTHON} - 0.9999999999999999 * ({_TOP_PYTHON})",
        rests=(),
    ),
    "pi": Written(rests=()),
    "unit_roundoff": Written(rests=()),
    "splitter": Written(rests=()),
    # CasADi's fabs has the derivative 0 at 0, and |x|^2 then no second one.
    "abs": Written(casadi="ca.if_else({0} < 0.0, -1.0, 1.0) * {0}", rests=("neg",)),
    "less": Written("{0} < {1}", rests=()),
    "at_most": Written("{0} <= {1}", rests=()),
    "both": Written("{0} & {1}", c="{0} && {1}", casadi="ca.logic_and({0}, {1})"),
    "either": Written("{0} | {1}", c="{0} || {1}", casadi="ca.logic_or({0}, {1})"),
    "select": Written(c="{0} ? {1} : {2}", casadi="ca.if_else({0}, {1}, {2})"),
}
SUMS = ("add", "sub")
SINES = {"sin": "sine", "cos": "cosine"}
"""The parts of what makes sine and cosine of an angle together."""


def patterns(
    own: Mapping[str, str], literal: Callable[[Fraction], str], bits: int
) -> dict[str, str]:
    """Return the operators on floats that a language writes by patterns, numbers among them.

    own : those that it writes in its own way       bits : the precision of its floats, p
    """
    signs = {name: row.sign for name, row in WRITTEN.items() if row.sign}
    numbers = {n: literal(row.number(bits)) for n, row in OPERATORS.items() if row.number}
    top, u = (literal(Fraction(2) ** power) for power in (bits - 1, -bits))
    found = {**signs, **own}
    return {n: p.replace("{top}", top).replace("{u}", u) for n, p in found.items()} | numbers


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
