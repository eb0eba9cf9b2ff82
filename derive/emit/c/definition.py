"""The C between the braces of any function but set-up: operations, pairs of floats, or loops."""

from derive.emit.c.text import body, pair_body
from derive.program.precision import Precision
from derive.program.program import Program


def definition(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the lines between the braces of a hot function."""
    if program.arithmetic == "pairs":
        return pair_body(program, scene, precision)
    return body(program, precision)
