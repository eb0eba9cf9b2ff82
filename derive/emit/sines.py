"""Sine and cosine of one angle, made together: quarter turns are taken off once for both."""

from collections.abc import Sequence
from dataclasses import replace

from derive.emit.operators import SINES
from derive.program.indexed import Even, Loop
from derive.program.program import Line, Op

TOGETHER = "sine_cosine"
"""The operation that gives both; ``sine_of`` and ``cosine_of`` are its parts."""


def together(lines: Sequence[Line]) -> tuple[Line, ...]:
    """Return lines in which a sine and a cosine of an angle are parts of one value.

    >>> [op.operator for op in together((Op("s", "sin", ("a",)), Op("c", "cos", ("a",))))]
    ['sine_cosine', 'sine_of', 'cosine_of']
    """
    found, made = list[Line](), dict[object, str]()
    for line in lines:
        match line:
            case Op(operator="sin" | "cos"):
                (angle,) = line.operands
                if angle not in made:
                    made[angle] = f"{line.result}_both"
                    found.append(Op(made[angle], TOGETHER, (angle,)))
                found.append(Op(line.result, f"{SINES[line.operator]}_of", (made[angle],)))
            case Loop() | Even():
                found.append(replace(line, body=together(line.body)))
            case _:
                found.append(line)
    return tuple(found)
