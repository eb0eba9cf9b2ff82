"""The operations of a program beside + - * /, by names that formulas over numbers read like."""

from fractions import Fraction

from derive.program.tape import Number, Tape, number, operation


def splitter(tape: Tape) -> Number:
    """Return the number that splits a float into halves, 2^ceil(p/2) + 1 for p bits (Veltkamp)."""
    return Number(tape, tape.record("splitter", ()))


def unit_roundoff(tape: Tape) -> Number:
    """Return u of the working precision."""
    return Number(tape, tape.record("unit_roundoff", ()))


def sqrt(x: Number) -> Number:
    """Return the square root."""
    return operation("sqrt", x)


def sin(x: Number) -> Number:
    """Return the sine of an angle in rad."""
    return operation("sin", x)


def cos(x: Number) -> Number:
    """Return the cosine of an angle in rad."""
    return operation("cos", x)


def atan2(y: Number | int, x: Number | int) -> Number:
    """Return the angle of the point (x, y), in rad, from -pi to pi."""
    return operation("atan2", y, x)


def absolute(x: Number) -> Number:
    """Return ``x`` without its sign."""
    return operation("abs", x)


def power_of_two(x: Number) -> Number:
    """Return the power of two at or next to ``x`` > 0."""
    return operation("power_of_two", x)


def less(a: Number | int | Fraction, b: Number | int | Fraction) -> Number:
    """Return the truth of a < b, for ``select``, ``both`` and ``either``."""
    return operation("less", a, b)


def at_most(a: Number | int | Fraction, b: Number | int | Fraction) -> Number:
    """Return the truth of a <= b."""
    return operation("at_most", a, b)


def both(a: Number, b: Number) -> Number:
    """Return the truth of a and b."""
    return operation("both", a, b)


def either(a: Number, b: Number) -> Number:
    """Return the truth of a or b."""
    return operation("either", a, b)


def select(condition: Number, yes: Number | int | Fraction, no: Number | int | Fraction) -> Number:
    """Return ``yes`` where ``condition`` is true, else ``no``; both are worked out."""
    if number(yes) == number(no):
        return number(yes)
    return operation("select", condition, yes, no)
