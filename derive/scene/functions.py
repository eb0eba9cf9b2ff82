"""The functions of a formula, a row a function: at zero, of floats, of intervals."""

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from mpmath import iv


@dataclass(frozen=True)
class Function:
    """What a function of a formula does: to zero, to a float, to an interval of mpmath's ``iv``."""

    at_zero: int
    floats: Callable[[float], float]
    interval: Callable[[Any], Any]


def _root(a: Any) -> Any:
    """Return the square root of what of an interval is not negative."""
    return iv.sqrt(iv.mpf([max(a.a, 0), max(a.b, 0)]))


FUNCTIONS: Mapping[str, Function] = {
    "sin": Function(0, math.sin, iv.sin),
    "cos": Function(1, math.cos, iv.cos),
    "tan": Function(0, math.tan, iv.tan),
    "sqrt": Function(0, math.sqrt, _root),
}
PLAIN: Mapping[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
}
"""What Python's own signs do to numbers of any kind."""
INTERVALS: Mapping[str, Any] = {
    "number": lambda exact: iv.mpf(exact.numerator) / exact.denominator,
    **PLAIN,
    "power": operator.pow,
    **{name: function.interval for name, function in FUNCTIONS.items()},
}
"""An arithmetic for ``derive.scene.formula.evaluate``: bounds on a box, rounded outward."""
