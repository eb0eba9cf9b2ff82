"""How set-up in C tells whether its parameters are admissible: a test a rule, and its number.

The rules are the program's own, and so is the order in which they are tried.
"""

from collections.abc import Callable, Iterator

from derive.program.program import Operand, Program
from derive.program.status import RIGHT, tried

# What is infinite or no number fails x - x >= 0.
BROKEN = {
    "finite": "!(({0} - {0}) >= {1})",
    "positive": "({0} <= {1})",
    "not negative": "({0} < {1})",
    "within": "!(({2} <= {0}) && ({0} <= {3}))",
}


def status(program: Program, rounded: Callable[[Operand], str], zero: str) -> Iterator[str]:
    """Yield the C lines by which set-up tells whether its parameters are admissible."""
    for number, kept in tried(program):
        tests = (
            BROKEN[relation].format(rounded(value), zero, *map(rounded, ends))
            for relation, value, ends in kept
        )
        condition = "\n    || ".join(tests)
        yield from (f"if ({condition}) {{", f"    return {number};", "}")
    yield f"return {RIGHT};"
