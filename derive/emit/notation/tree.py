"""From a tree of vector algebra to its layout: one row an operator."""

from collections.abc import Callable
from fractions import Fraction

from derive.emit.notation.glyph import glyph
from derive.emit.notation.layout import (
    IDENTITY,
    ONE,
    Layout,
    added,
    applied,
    infix,
    multiplied,
    name,
    negative,
    number,
    operand,
)
from derive.lecture.vectors import Expression

_STYLES = {(): "scalar", (3,): "vector", (3, 3): "tensor"}


class NotationError(ValueError):
    """An operator for which the notation has no reading."""


def tree_layout(expression: Expression) -> Layout:
    """Return how ``expression`` is written."""
    if expression.operator in _LEAVES:
        return _LEAVES[expression.operator](expression)
    operands = [tree_layout(operand) for operand in expression.operands]
    if expression.operator in _NAMED:
        return _NAMED[expression.operator](expression, operands[0])
    if expression.operator in _OPERATORS:
        return _OPERATORS[expression.operator](*operands)
    known = ", ".join(sorted((*_LEAVES, *_NAMED, *_OPERATORS)))
    raise NotationError(f"the notation reads the operators {known}; not '{expression.operator}'")


def _symbol(expression: Expression) -> Layout:
    return name(expression.name.replace("u_any", "u"), _STYLES[expression.shape])


def _indexed(expression: Expression, inside: Layout) -> Layout:
    """Return one component; of a bare symbol it is a scalar's name."""
    if inside.kind == "name" and glyph(inside.text).base:
        return name(f"{inside.text}_{expression.name}", "scalar")
    return Layout("index", (operand(inside),), expression.name)


def _total(expression: Expression, inside: Layout) -> Layout:
    over = "others" if expression.operator == "others" else expression.name
    return Layout("total", (inside,), over)


def transposed(inside: Layout) -> Layout:
    """Return a transpose."""
    return Layout("transposed", (operand(inside),))


def called(function: str) -> Callable[..., Layout]:
    """Return how a call of ``function`` is laid out."""
    return lambda *inside: Layout("call", inside, function)


_LEAVES: dict[str, Callable[[Expression], Layout]] = {
    "symbol": _symbol,
    "inertia": _symbol,
    "number": lambda e: number(e.number),
    "zero": lambda e: name("0", _STYLES[e.shape]) if e.shape else number(Fraction(0)),
    "identity": lambda _: IDENTITY,
    "unit": lambda e: name(f"e_{e.name}", "vector"),
}
_NAMED: dict[str, Callable[[Expression, Layout], Layout]] = {
    "component": _indexed,
    "quantity": _indexed,
    "sum": _total,
    "others": _total,
}
_OPERATORS: dict[str, Callable[..., Layout]] = {
    "add": lambda a, b: added([a, b]),
    "negate": negative,
    "scale": lambda a, b: multiplied([a, b]),
    "apply": applied,
    "dot": lambda a, b: infix(".", a, b),
    "cross": lambda a, b: infix("x", a, b),
    "outer": lambda a, b: multiplied([a, transposed(b)]),
    "cross_tensor": lambda v: Layout("skew", (v,)),
    "transpose": transposed,
    "trace": called("tr"),
    "axial": called("axial"),
    "turn": called("turn"),
    "reciprocal": lambda s: Layout("fraction", (ONE, s)),
    "sin": called("sin"),
    "cos": called("cos"),
}
