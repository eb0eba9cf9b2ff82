"""The operations of a program beside + - * /, by names that formulas over numbers read like."""

from collections.abc import Sequence
from fractions import Fraction
from functools import partial

from derive.program.tape import Number, Tape, number, operation

sqrt = partial(operation, "sqrt")
sin = partial(operation, "sin")
cos = partial(operation, "cos")
atan2 = partial(operation, "atan2")  # of y and x: the angle of the point (x, y), -pi to pi
absolute = partial(operation, "abs")
power_of_two = partial(operation, "power_of_two")  # one at or next to x > 0
less = partial(operation, "less")
at_most = partial(operation, "at_most")
both = partial(operation, "both")
either = partial(operation, "either")


def splitter(tape: Tape) -> Number:
    """Return the number that splits a float into halves, 2^ceil(p/2) + 1 for p bits (Veltkamp)."""
    return Number(tape, tape.record("splitter", ()))


def unit_roundoff(tape: Tape) -> Number:
    """Return u of the working precision."""
    return Number(tape, tape.record("unit_roundoff", ()))


def select(condition: Number, yes: Number | int | Fraction, no: Number | int | Fraction) -> Number:
    """Return ``yes`` where ``condition`` is true, else ``no``; both are worked out."""
    if number(yes) == number(no):
        return number(yes)
    return operation("select", condition, yes, no)


def horner(terms: Sequence[Number], x: Number) -> Number:
    """Return the sum of ``terms[k]`` x^k."""
    total = terms[-1]
    for term in reversed(terms[:-1]):
        total = total * x + term
    return total
