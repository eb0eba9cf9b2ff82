"""How set-up in C tells whether its parameters are admissible: a test a rule, and its number.

The rules are the program's own; the order in which they are tried is that of their numbers.
"""

from collections.abc import Sequence
from fractions import Fraction

from derive.emit.operators import literal
from derive.program.precision import Precision
from derive.program.program import Operand, Program
from derive.program.status import CONSTANT, PARAMETER, RIGHT, computed


def _rounded(operand: Operand, names: set[str], precision: Precision) -> str:
    if isinstance(operand, Fraction):
        return literal(operand, precision)
    return operand if operand in names else f"{operand}.high"


def status(program: Program, precision: Precision) -> list[str]:
    """Return the C lines by which set-up tells whether its parameters are admissible.

    What is infinite or no number fails ``x - x >= 0``.
    """
    names = [c for q in program.inputs for c in q.components]
    zero = literal(Fraction(0), precision)
    broken: dict[int, list[str]] = {}
    for rule in program.rules:
        sign = "<=" if rule.relation == "positive" else "<"
        test = f"{_rounded(rule.value, set(names), precision)} {sign} {zero}"
        broken.setdefault(rule.status, []).append(test)
    made = dict.fromkeys((*(rule.value for rule in program.rules), *computed(program)))
    rest = [_rounded(r, set(names), precision) for r in made if r not in names]
    lines = _refused(_finite(names, zero), PARAMETER)
    for number, tests in sorted(broken.items()):
        lines += _refused(tests, number)
    return [*lines, *_refused(_finite(rest, zero), CONSTANT), f"return {RIGHT};"]


def _finite(names: Sequence[str], zero: str) -> list[str]:
    return [f"!({name} - {name} >= {zero})" for name in names]


def _refused(tests: Sequence[str], number: int) -> list[str]:
    if not tests:
        return []
    condition = "\n    || ".join(tests)
    return [f"if ({condition}) {{", f"    return {number};", "}"]
