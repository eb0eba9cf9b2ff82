"""The C between the braces of any function but set-up: operations, pairs of floats, or loops."""

from derive.emit.c.compact import compact_c
from derive.emit.c.series import series_c
from derive.emit.c.text import body, pair_body
from derive.motion.runge_kutta.compact import Compact
from derive.motion.taylor.series import Series
from derive.program.precision import Precision
from derive.program.program import Program


def definition(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the lines between the braces of a hot function."""
    if isinstance(program.loops, Series):
        return series_c(program.loops, precision)
    if isinstance(program.loops, Compact):
        return compact_c(program.loops, program, precision)
    if program.arithmetic == "pairs":
        return pair_body(program, scene, precision)
    return body(program, precision)
