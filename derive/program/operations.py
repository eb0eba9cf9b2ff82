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


def both(a: Number, b: Number) -> Number:
    """Return whether two truths hold; one that is known decides now."""
    known, other = (a, b) if a.exact is not None else (b, a)
    if known.exact is None:
        return operation("both", a, b)
    return other if known.exact else known


def either(a: Number, b: Number) -> Number:
    """Return whether one of two truths holds; one that is known decides now."""
    known, other = (a, b) if a.exact is not None else (b, a)
    if known.exact is None:
        return operation("either", a, b)
    return known if known.exact else other


def splitter(tape: Tape) -> Number:
    """Return the number that splits a float into halves, 2^ceil(p/2) + 1 for p bits (Veltkamp)."""
    return Number(tape, tape.record("splitter", ()))


def unit_roundoff(tape: Tape) -> Number:
    """Return u of the working precision."""
    return Number(tape, tape.record("unit_roundoff", ()))


def select(condition: Number, yes: Number | int | Fraction, no: Number | int | Fraction) -> Number:
    """Return ``yes`` where ``condition`` is true, else ``no``; both are worked out."""
    if number(yes) == number(no) or condition.exact:
        return number(yes)
    if condition.exact == 0:
        return number(no)
    return operation("select", condition, yes, no)


def horner(terms: Sequence[Number], x: Number) -> Number:
    """Return the sum of ``terms[k]`` x^k."""
    total = terms[-1]
    for term in reversed(terms[:-1]):
        total = total * x + term
    return total
