"""The problems once more in ball arithmetic of 256 bits, from their vector equations.

Nothing here is shared with the code under test: tensors are inverted by cofactors, Jacobians come
from power series in a small parameter along each column.
"""

from collections.abc import Callable, Sequence
from typing import Any

from flint import arb, arb_series, ctx

from bench.problem import Problem

BITS = 256
Ball = Any
Column = list[Ball]


def truth(problem: Problem, row: Sequence[float], rotation: str) -> Column:
    """Return the outputs of a problem for a row of parameters and inputs.

    rotation : which R(q) is meant away from unit length, "unit" or "homogeneous"
    """
    ctx.prec = BITS
    p = [arb(value) for value in row[: len(problem.parameters)]]
    x = [arb(value) for value in row[len(problem.parameters) :]]
    rate = RATES[problem.scene]
    return rate(p, x, rotation) + _jacobian(problem, rate, p, x, rotation)


def _jacobian(
    problem: Problem, rate: Callable[..., Column], p: Column, x: Column, rotation: str
) -> Column:
    """Return the nonzeros of a problem's Jacobian in the order of its pattern."""
    slopes: dict[str, Column] = {}
    for name in dict.fromkeys(column for _, column in problem.pattern):
        k = problem.inputs.index(name)
        moved = [arb_series([v, 1 if i == k else 0], prec=2) for i, v in enumerate(x)]
        slopes[name] = [_slope(value) for value in rate(p, moved, rotation)]
    return [slopes[column][problem.outputs.index(row)] for row, column in problem.pattern]


def _slope(value: Ball) -> Ball:
    return value[1] if isinstance(value, arb_series) else arb(0)


def cross(a: Column, b: Column) -> Column:
    """Return a x b."""
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def dot(a: Column, b: Column) -> Ball:
    """Return a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _add(*columns: Column) -> Column:
    return [sum(entries[1:], entries[0]) for entries in zip(*columns, strict=True)]


def _scaled(factor: Ball, a: Column) -> Column:
    return [factor * value for value in a]


def _tensor(p: Column) -> list[Column]:
    xx, yy, zz, xy, xz, yz = p
    return [[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]


def applied(rows: list[Column], a: Column) -> Column:
    """Return a matrix, given by its rows, times a column."""
    return [dot(row, a) for row in rows]


def _solved(rows: list[Column], b: Column) -> Column:
    """Return the solution of a symmetric system, by cofactors."""
    cofactors = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])]
    determinant = dot(rows[0], cofactors[0])
    return [value / determinant for value in applied(cofactors, b)]


def _spin_rate(inertia: list[Column], w: Column, moment: Column, wheels: Column) -> Column:
    """Return I^-1 (M - omega x (I omega + h)) for the tensor and momentum given."""
    momentum = _add(applied(inertia, w), wheels)
    return _solved(inertia, _add(moment, cross(momentum, w)))


def _free_body(p: Column, x: Column, _: str) -> Column:
    return _spin_rate(_tensor(p), x[:3], x[3:6], [arb(0)] * 3)


def _principal(p: Column, x: Column, _: str) -> Column:
    return _spin_rate(_tensor([*p, arb(0), arb(0), arb(0)]), x[:3], x[3:6], [arb(0)] * 3)


def _heavy_top(p: Column, x: Column, _: str) -> Column:
    A, C, m, g, length = p
    theta, w = x[1], x[3:6]
    precession = w[1] / theta.sin()
    axes = [w[0], w[1], precession * theta.cos()]
    momentum = [A * w[0], A * w[1], C * w[2]]
    moment = [m * g * length * theta.sin(), arb(0), arb(0)]
    rate = _add(moment, cross(momentum, axes))
    return [precession, w[0], w[2] - axes[2], rate[0] / A, rate[1] / A, rate[2] / C]


def _gyrostat(p: Column, x: Column, _: str) -> Column:
    phi, theta, w, s, moment, u = x[0], x[1], x[3:6], x[6:9], x[9:12], x[12:15]
    axial = p[6:9]
    inertia = _tensor(p[:6])
    carrier = [[e - axial[i] * (i == j) for j, e in enumerate(r)] for i, r in enumerate(inertia)]
    momentum = _add(applied(inertia, w), [c * v for c, v in zip(axial, s, strict=True)])
    load = _add(moment, _scaled(arb(-1), u), cross(momentum, w))
    w_dot = _solved(carrier, load)
    s_dot = [torque / c - a for torque, c, a in zip(u, axial, w_dot, strict=True)]
    across = phi.sin() * w[1] + phi.cos() * w[2]
    psi_dot = across / theta.cos()
    angles = [w[0] + psi_dot * theta.sin(), phi.cos() * w[1] - phi.sin() * w[2], psi_dot]
    return angles + w_dot + s_dot


def _turned(q: Column, a: Column, rotation: str) -> Column:
    """Return R a by quaternion products; "unit" adds what |q|^2 lacks to one."""
    w, v = q[0], q[1:]
    both = _add(_scaled(w, cross(v, a)), cross(v, cross(v, a)))
    size = arb(1) if rotation == "unit" else w * w + dot(v, v)
    return _add(_scaled(size, a), _scaled(arb(2), both))


def _rigid_body(p: Column, x: Column, rotation: str) -> Column:
    q, v, w, force, moment = x[3:7], x[7:10], x[10:13], x[13:16], x[16:19]
    v_dot = [value / p[0] for value in _turned(q, force, rotation)]
    w_dot = _spin_rate(_tensor(p[1:]), w, moment, [arb(0)] * 3)
    vector = _add(_scaled(q[0], w), cross(q[1:], w))
    q_dot = [-dot(q[1:], w) / 2, *(value / 2 for value in vector)]
    return v + q_dot + v_dot + w_dot


RATES: dict[str, Callable[[Column, Column, str], Column]] = {
    "free_body": _free_body,
    "free_body_principal": _principal,
    "heavy_top": _heavy_top,
    "gyrostat": _gyrostat,
    "rigid_body": _rigid_body,
}
