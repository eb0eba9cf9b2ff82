"""How set-up in C tells whether its parameters are admissible: a test a rule, and its number.

The rules are the program's own, and so is the order in which they are tried.
"""

from fractions import Fraction

from derive.emit.operators import literal
from derive.program.precision import Precision
from derive.program.program import Operand, Program
from derive.program.status import RIGHT, tried

# What is infinite or no number fails x - x >= 0.
BROKEN = {"finite": "!({0} - {0} >= {1})", "positive": "{0} <= {1}", "not negative": "{0} < {1}"}


def status(program: Program, precision: Precision) -> list[str]:
    """Return the C lines by which set-up tells whether its parameters are admissible."""
    names = {c for q in program.inputs for c in q.components}
    zero = literal(Fraction(0), precision)

    def rounded(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return literal(operand, precision)
        return operand if operand in names else f"{operand}.high"

    lines = []
    for number, kept in tried(program):
        tests = (BROKEN[relation].format(rounded(value), zero) for relation, value in kept)
        condition = "\n    || ".join(tests)
        lines += [f"if ({condition}) {{", f"    return {number};", "}"]
    return [*lines, f"return {RIGHT};"]
