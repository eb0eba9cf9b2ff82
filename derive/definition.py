"""The C between the braces of any function but set-up: operations, pairs of floats, or loops."""

from derive.c_text import Precision, body, pair_body
from derive.compact_text import compact_c
from derive.flows.compact import Compact
from derive.flows.series import Series
from derive.program import Program
from derive.series_text import series_c


def definition(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the lines between the braces of a hot function."""
    if isinstance(program.loops, Series):
        return series_c(program.loops, precision)
    if isinstance(program.loops, Compact):
        return compact_c(program.loops, program, precision)
    if program.arithmetic == "pairs":
        return pair_body(program, scene, precision)
    return body(program, precision)
