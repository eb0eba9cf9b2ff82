"""Rates of turning bodies as programs, written by hand: quaternion and angular velocity."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from derive.program.operations import sqrt
from derive.program.program import Program, Quantity
from derive.program.recorded import needed
from derive.program.tape import Number, Tape, number

Values = Mapping[str, Number]
Moment = Callable[[Values], Sequence[Number | int | Fraction]]


def quantity(name: str, parts: str) -> Quantity:
    """Return a quantity with one component a letter; without letters, one of no shape."""
    if not parts:
        return Quantity(name, (name,), (), "", "", None, None, name)
    components = tuple(f"{name}_{part}" for part in parts)
    return Quantity(name, components, (len(parts),), "", "", None, None, name)


ATTITUDE = replace(quantity("attitude", "wxyz"), role="attitude")
OMEGA = quantity("omega", "xyz")
BODY = (ATTITUDE, OMEGA)


def rate(states: Sequence[Quantity], formula: Callable[[Values], Sequence[object]]) -> Program:
    """Return the program of a rate from a formula of the states."""
    tape = Tape("t")
    found = formula({c: tape.input(c) for q in states for c in q.components})
    results = tuple(number(x).operand for x in found)  # type: ignore[arg-type]
    outputs = tuple(quantity(f"{q.name}_rate", "") for q in states)
    return Program("state_rate", "", tuple(states), outputs, needed(tape.ops, results), results)


def no_moment(values: Values) -> Sequence[int]:
    """Return no moment."""
    return (0, 0, 0)


def constant(moment: Sequence[Fraction]) -> Moment:
    """Return a moment that is constant along the body's axes."""
    return lambda _: moment


def hanging(values: Values) -> Sequence[Number]:
    """Return the moment of a weight on the body's z axis, about the fixed point."""
    w, x, y, z = (values[c] for c in ATTITUDE.components)
    return ((y * z + w * x) * 3, (w * y - x * z) * 3, number(0))


def body(inertia: Sequence[Fraction], moment: Moment, wheel: Sequence[Fraction]) -> Program:
    """Return the rate of a body along its principal axes, with a wheel of momentum ``wheel``."""
    a, b, c = inertia

    def formula(values: Values) -> Sequence[object]:
        p, q, r = (values[name] for name in OMEGA.components)
        M = [number(m) for m in moment(values)]
        turned = (q * wheel[2] - r * wheel[1], r * wheel[0] - p * wheel[2])
        turned += (p * wheel[1] - q * wheel[0],)
        own = (q * r * (b - c), r * p * (c - a), p * q * (a - b))
        sums = [m - t + o for m, t, o in zip(M, turned, own, strict=True)]
        return (*_kinematics(values), *(s / i for s, i in zip(sums, inertia, strict=True)))

    return rate(BODY, formula)


def _kinematics(values: Values) -> list[Number]:
    w, x, y, z = (values[c] for c in ATTITUDE.components)
    p, q, r = (values[c] * Fraction(1, 2) for c in OMEGA.components)
    return [
        -(x * p + y * q + z * r),
        w * p + y * r - z * q,
        w * q + z * p - x * r,
        w * r + x * q - y * p,
    ]


def everything() -> tuple[tuple[Quantity, ...], Program]:
    """Return a rate with squares, a root, divisions of every kind and a rate that is constant."""
    states = (quantity("x", ""), quantity("y", ""), quantity("z", ""))

    def formula(v: Values) -> Sequence[object]:
        x, y = v["x"], v["y"]
        size = sqrt(x * x + y * y + 1)
        return (1 / size - y * y, (x - x * x / 3) / (y * y + 2) - 2 / y, Fraction(1, 4))

    return states, rate(states, formula)
