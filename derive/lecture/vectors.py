"""Vector expressions with two readings: coordinate-free for people, components for the checker.

An expression is a small tree of vector algebra. People read the tree (``notation`` prints it);
the checker reads ``components``, exact SymPy columns. Nothing here knows mechanics.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import Any

from sympy import Expr, Matrix, Rational, Symbol, cos, eye, sin, zeros

AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Expression:
    """A scalar (), vector (3,) or tensor (3, 3) built from named symbols."""

    operator: str
    operands: tuple[Expression, ...] = ()
    shape: tuple[int, ...] = ()
    name: str = ""
    number: Fraction = Fraction(0)

    def __add__(self, other: Expression) -> Expression:
        _same_shape(self, other)
        return Expression("add", (self, other), self.shape)

    def __sub__(self, other: Expression) -> Expression:
        return self + (-other)

    def __neg__(self) -> Expression:
        return Expression("negate", (self,), self.shape)

    def __mul__(self, other: Expression) -> Expression:
        """Scale: at least one of the two is a scalar."""
        if self.shape and other.shape:
            raise TypeError(f"use dot, cross or @ between shapes {self.shape} and {other.shape}")
        return Expression("scale", (self, other), self.shape or other.shape)

    def __rmul__(self, factor: int | Fraction) -> Expression:
        return number(factor) * self

    def __matmul__(self, other: Expression) -> Expression:
        if self.shape != (3, 3) or not other.shape:
            raise TypeError(f"@ needs a tensor on the left, not {self.shape} @ {other.shape}")
        return Expression("apply", (self, other), other.shape)


def _same_shape(left: Expression, right: Expression) -> None:
    if left.shape != right.shape:
        raise TypeError(f"cannot add shapes {left.shape} and {right.shape}")


def number(value: int | Fraction) -> Expression:
    """Return an exact number as a scalar."""
    return Expression("number", number=Fraction(value))


def scalar(name: str) -> Expression:
    """Return the scalar called ``name``."""
    return Expression("symbol", name=name)


def vector(name: str) -> Expression:
    """Return the vector called ``name``."""
    return Expression("symbol", shape=(3,), name=name)


def tensor(name: str) -> Expression:
    """Return the general tensor called ``name``, nine components."""
    return Expression("symbol", shape=(3, 3), name=name)


def inertia(name: str) -> Expression:
    """Return the symmetric tensor of three moments and three products called ``name``."""
    return Expression("inertia", shape=(3, 3), name=name)


def zero(*shape: int) -> Expression:
    """Return the zero of a shape: (), (3,) or (3, 3)."""
    return Expression("zero", shape=shape)


IDENTITY = Expression("identity", shape=(3, 3))


def unit(axis: str) -> Expression:
    """Return the unit vector along ``axis`` ("x", "y" or "z") of the axes in use."""
    return Expression("unit", shape=(3,), name=axis)


def dot(left: Expression, right: Expression) -> Expression:
    """Return the scalar product of two vectors."""
    return Expression("dot", (left, right))


def cross(left: Expression, right: Expression) -> Expression:
    """Return the vector product of two vectors."""
    return Expression("cross", (left, right), (3,))


def outer(left: Expression, right: Expression) -> Expression:
    """Return the tensor left right^T of two vectors."""
    return Expression("outer", (left, right), (3, 3))


def cross_tensor(v: Expression) -> Expression:
    """Return [v]x, the tensor with [v]x u = v x u."""
    return Expression("cross_tensor", (v,), (3, 3))


def transpose(t: Expression) -> Expression:
    """Return the transpose of a tensor."""
    return Expression("transpose", (t,), (3, 3))


def trace(t: Expression) -> Expression:
    """Return the trace of a tensor."""
    return Expression("trace", (t,))


def axial(t: Expression) -> Expression:
    """Return the vector w with [w]x = (t - t^T)/2, the turning part of a tensor."""
    return Expression("axial", (t,), (3,))


def component(v: Expression, axis: str) -> Expression:
    """Return one component ("x", "y" or "z") of a vector."""
    return Expression("component", (v,), name=axis)


def quantity(t: Expression, pair: str) -> Expression:
    """Return one of a tensor's six quantities: a moment "xx", or a product "xy" = - entry."""
    return Expression("quantity", (t,), name=pair)


def reciprocal(s: Expression) -> Expression:
    """Return 1/s of a scalar."""
    return Expression("reciprocal", (s,))


def sine(angle: Expression) -> Expression:
    """Return the sine of an angle in rad."""
    return Expression("sin", (angle,))


def cosine(angle: Expression) -> Expression:
    """Return the cosine of an angle in rad."""
    return Expression("cos", (angle,))


def turn(axis: Expression, angle: Expression) -> Expression:
    """Return the tensor that turns vectors by an angle in rad about a unit vector."""
    return Expression("turn", (axis, angle), (3, 3))


def turn_written_out(axis: Expression, angle: Expression) -> Expression:
    """Return ``turn(axis, angle)`` in products, sines and cosines."""
    along = outer(axis, axis)
    return cosine(angle) * (IDENTITY - along) + sine(angle) * cross_tensor(axis) + along


def total(summand: Expression, over: str = "body") -> Expression:
    """Return the sum of ``summand`` over the members of ``over``."""
    return Expression("sum", (summand,), summand.shape, over)


def symbol_components(name: str) -> Matrix:
    """Return the column (name_x, name_y, name_z), shape (3, 1), all real.

    >>> symbol_components("omega").T
    Matrix([[omega_x, omega_y, omega_z]])
    """
    return Matrix([Symbol(f"{name}_{axis}", real=True) for axis in AXES])


def inertia_components(name: str) -> Matrix:
    """Return the symmetric tensor of six quantities, products of inertia entering with minus.

    >>> inertia_components("I")[0, 1]
    -I_xy
    """
    xx, yy, zz, xy, xz, yz = (
        Symbol(f"{name}_{pair}", real=True) for pair in ("xx", "yy", "zz", "xy", "xz", "yz")
    )
    return Matrix([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]])


def cross_matrix(v: Matrix) -> Matrix:
    """Return [v]x, shape (3, 3), so that ``cross_matrix(v) * u == v.cross(u)``."""
    x, y, z = v
    return Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def _axial(t: Matrix) -> Matrix:
    return Matrix([t[2, 1] - t[1, 2], t[0, 2] - t[2, 0], t[1, 0] - t[0, 1]]) / 2


def _turn(axis: Matrix, angle: Expr) -> Matrix:
    along = axis * axis.T
    return cos(angle) * (eye(3) - along) + sin(angle) * cross_matrix(axis) + along


def _quantity(t: Matrix, pair: str) -> Expr:
    entry = t[AXES.index(pair[0]), AXES.index(pair[1])]
    return entry if pair[0] == pair[1] else -entry


def _leaf(expression: Expression) -> Any:
    name, shape = expression.name, expression.shape
    match expression.operator:
        case "symbol" if shape == ():
            return Symbol(name, real=True)
        case "symbol" if shape == (3,):
            return symbol_components(name)
        case "symbol":
            return Matrix(3, 3, lambda i, k: Symbol(f"{name}_{AXES[i]}{AXES[k]}", real=True))
        case "inertia":
            return inertia_components(name)
        case "number":
            return Rational(expression.number.numerator, expression.number.denominator)
        case "identity":
            return eye(3)
        case "unit":
            return eye(3)[:, AXES.index(name)]
    return Rational(0) if shape == () else zeros(3, 1 if shape == (3,) else 3)


# One row an operator: from the operands' components to the result's.
COMPONENTS: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "negate": lambda a: -a,
    "scale": lambda a, b: a * b,
    "dot": lambda a, b: (a.T * b)[0],
    "cross": lambda a, b: a.cross(b),
    "apply": lambda t, v: t * v,
    "outer": lambda a, b: a * b.T,
    "cross_tensor": cross_matrix,
    "transpose": lambda t: t.T,
    "trace": lambda t: t.trace(),
    "axial": _axial,
    "turn": _turn,
    "reciprocal": lambda s: 1 / s,
    "sin": sin,
    "cos": cos,
}


def combine(expression: Expression, operands: Sequence[Any]) -> Any:
    """Return the components of ``expression`` from those of its operands."""
    if expression.operator == "component":
        return operands[0][AXES.index(expression.name)]
    if expression.operator == "quantity":
        return _quantity(operands[0], expression.name)
    return COMPONENTS[expression.operator](*operands)


def components(expression: Expression, bindings: Mapping[str, Any] | None = None) -> Any:
    """Return the components of ``expression``: a SymPy scalar, (3, 1) column or (3, 3) matrix.

    bindings : what a named symbol stands for (a SymPy scalar or Matrix of its shape); a name
               that is not bound gets symbols of its own, ``name_x`` and so on. What a sum runs
               over is bound to a tuple of bindings, one a member.

    >>> components(cross(vector("a"), vector("b")))[0]
    a_y*b_z - a_z*b_y
    >>> components(total(scalar("m"), "parts"), {"parts": ({"m": 2}, {"m": 3})})
    5
    """
    bound = bindings or {}
    if expression.operator in ("symbol", "inertia") and expression.name in bound:
        return bound[expression.name]
    if expression.operator == "sum":
        return _sum(expression, bound)
    if not expression.operands:
        return _leaf(expression)
    return combine(expression, [components(operand, bound) for operand in expression.operands])


def _sum(expression: Expression, bound: Mapping[str, Any]) -> Any:
    if expression.name not in bound:
        raise KeyError(
            f"a sum over '{expression.name}' has no components until its members are bound"
        )
    members = [
        components(expression.operands[0], {**bound, **each}) for each in bound[expression.name]
    ]
    return reduce(lambda a, b: a + b, members, _leaf(zero(*expression.shape)))
