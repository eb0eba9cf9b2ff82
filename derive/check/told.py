"""What Eva is told of divisors whose ranges are proved elsewhere, and what tries these ranges.

Intervals in C cannot follow why some divisor keeps away from zero, however finely inputs are cut.
Where it is proved (``verify.proved.divisors``), an annotation tells it; a run of the function at
samples, whose every value is looked at, must stay in these ranges.
"""

import re
from collections.abc import Sequence

import numpy as np

from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Program
from derive.program.run import numbers_of, run_lines
from derive.verify.columns import arithmetics, supplied
from derive.verify.draw import Dice, Sampled, drawn
from derive.verify.operators import Column
from derive.verify.proved.divisors import ProvedRange
from derive.verify.proved.seen import by_component

TRIED = 4096
"""Samples that ranges are tried at."""


def escaped(
    library: Library, program: Program, ranges: Sequence[ProvedRange], precision: Precision
) -> str:
    """Return which value of a function leaves its range at a sample, "" if none does."""
    of, by = Sampled(library, precision), arithmetics(precision.dtype)
    rows = drawn(of, Dice(f"derive: {library.scene.name} told {program.name}"), TRIED)
    ends = np.where(rows > (of.lows + of.highs)[:, None] / 2, of.highs[:, None], of.lows[:, None])
    rows[:, 1::2] = np.where(np.isfinite(ends), ends, rows)[:, 1::2]
    at = supplied(of.setup, by_component(of, _floats_of_the_ranges(of, rows)), by)
    known = dict(at.own) | numbers_of(program, by.own)
    with np.errstate(all="ignore"):
        run_lines(program.ops, by.own, known)
    for proved in ranges:
        found = known[proved.name]
        if not np.all((proved.low <= found) & (found <= proved.high)):
            is_between = f"{proved.name} is {found.min():g} .. {found.max():g} at samples"
            return f"{is_between}, beyond what is proved, {proved.low:g} .. {proved.high:g}"
    return ""


def _floats_of_the_ranges(of: Sampled, rows: Column) -> Column:
    """Return values as floats; what rounding brought beyond an end is the float before it."""
    own: Column = rows.astype(of.precision.dtype)
    own = np.where(own > of.highs[:, None], np.nextafter(own, -np.inf), own)
    return np.where(own < of.lows[:, None], np.nextafter(own, np.inf), own).astype(rows.dtype)


def with_ranges(text: str, symbol: str, ranges: Sequence[ProvedRange]) -> str:
    """Return C in which a function's values are told to be in ranges, where it makes them."""
    body = re.search(rf"^void {symbol}\([^)]*\)\n\{{\n.*?^\}}$", text, re.MULTILINE | re.DOTALL)
    if body is None:
        return text
    told = body[0]
    for proved in ranges:
        made = re.compile(rf"^(    const (\w+) {proved.name} = )[^;]*;$", re.MULTILINE)
        ends = f"{proved.low!r}, {proved.high!r}"
        says = f"    /*@ admit {proved.low!r} <= {proved.name} <= {proved.high!r}; */"
        new = rf"\g<1>Frama_C_\g<2>_interval({ends});" if proved.quotient else "\\g<0>"
        told = made.sub(f"{new}\n{says}", told, count=1)
    return text[: body.start()] + told + text[body.end() :]
