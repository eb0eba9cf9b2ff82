"""Sine and cosine as a function of C, and what every language prints it from."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import partial
from typing import Any

from derive.emit.operators import SINES, literal
from derive.emit.sines import TOGETHER
from derive.emit.templates import TEMPLATES
from derive.program.own_sine import FITTED, parts_of_quarter, rounder
from derive.program.pair_sine import PI
from derive.program.precision import Precision
from derive.program.program import Program


def takes_sines(program: Program) -> bool:
    """Tell whether a program takes sines or cosines of floats."""
    return program.arithmetic == "working" and any(name in program.count for name in SINES)


def sines_type(scene: str, precision: Precision) -> str:
    """Return the type of a sine and a cosine."""
    return f"{scene}_sines_{precision.name}"


def own_sines(scene: str, precision: Precision) -> str:
    """Return the function that makes sine and cosine of an angle."""
    own = numbers_of_sines(precision.bits, partial(literal, precision=precision))
    text = TEMPLATES.get_template("sine_cosine.c.jinja").render(
        symbol=f"{scene}_{TOGETHER}_{precision.name}",
        kind=sines_type(scene, precision),
        scalar=precision.scalar,
        **own,
        **precision.functions,
    )
    return text.rstrip()


def numbers_of_sines(bits: int, text: Callable[[Fraction], str]) -> dict[str, Any]:
    """Return the numbers that sine and cosine are made of, as a language writes them."""
    of = FITTED[bits]
    return {
        "per_quarter": text(2 / PI),
        "top": text(rounder(bits)),
        "parts": [text(part) for part in parts_of_quarter(bits)],
        "first": text(of.sine[0]),
        "odd": horner([text(c) for c in of.sine[1:]]),
        "even": horner([text(c) for c in of.cosine]),
        "half_of_one": text(Fraction(1, 2)),
        "one": text(Fraction(1)),
        "largest": text(Fraction(of.largest)),
        "served": of.largest,
    }


def horner(coefficients: Sequence[str]) -> str:
    """Return a polynomial of z.

    >>> horner(["a", "b", "c"])
    'a + (z * (b + (z * c)))'
    """
    first, *rest = coefficients
    inner = horner(rest) if rest else ""
    return f"{first} + (z * {f'({inner})' if rest[1:] else inner})" if rest else first
