"""The functions of a formula, a row a function: at zero, of floats, of intervals."""

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from derive.scene.interval import (
    Interval,
    added,
    cosine,
    divided,
    multiplied,
    negative,
    number,
    raised,
    root,
    sine,
)


@dataclass(frozen=True)
class Function:
    """What a function of a formula does: to zero, to a float, to an interval of floats."""

    at_zero: int
    floats: Callable[[float], float]
    interval: Callable[[Interval], Interval]


FUNCTIONS: Mapping[str, Function] = {
    "sin": Function(0, math.sin, sine),
    "cos": Function(1, math.cos, cosine),
    "tan": Function(0, math.tan, lambda a: divided(sine(a), cosine(a))),
    "sqrt": Function(0, math.sqrt, root),
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
    "number": number,
    "add": added,
    "sub": lambda a, b: added(a, negative(b)),
    "mul": multiplied,
    "div": divided,
    "neg": negative,
    "power": raised,
    **{name: function.interval for name, function in FUNCTIONS.items()},
}
"""An arithmetic for ``derive.scene.formula.evaluate``."""
