"""What is known of the operations of a function before any box: what is exact, and what chooses."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from derive.program.arithmetic import rounded
from derive.program.precision import Precision
from derive.verify.proved.unfolded import Operation, Unfolded

COMPARED = ("less", "at_most")
MOST_CHOICES = 12


@dataclass(frozen=True)
class Traits:
    """What is known of a trace before any box: see ``Enclosed``.

    exact       : whether a place has the same value in floats, a choice by such values among them
    quaternions : whether any are given
    """

    trace: Unfolded
    precision: Precision
    exact: tuple[bool, ...]
    quaternions: bool

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """Return of each choice whether it is a largest, a smallest, an absolute value or none."""
        return tuple(_kind(self.trace.steps, s) for s in self.trace.steps)

    @cached_property
    def choices(self) -> tuple[int, ...]:
        """Return the comparisons of exact values that decide between others, with a jump."""
        steps = self.trace.steps
        asked = {s.operands[0] for n, s in enumerate(steps) if self.jumps(n)}
        for n in range(len(steps) - 1, -1, -1):
            if n in asked and steps[n].operator in ("both", "either"):
                asked.update(steps[n].operands)
        own = (n for n in sorted(asked) if steps[n].operator in COMPARED and self.exact[n])
        return tuple(own)[:MOST_CHOICES]

    def jumps(self, index: int) -> bool:
        """Tell whether a place is a choice that may have a jump."""
        return self.trace.steps[index].operator == "select" and not self.kinds[index]

    @cached_property
    def lengths(self) -> frozenset[int]:
        """Return the places of sums of four squares that are divided by, or rooted."""
        steps = self.trace.steps
        if not self.quaternions:
            return frozenset()
        rooted = {o for s in steps for o in s.operands[-1:] if s.operator in ("div", "sqrt")}
        return frozenset(n for n in rooted if len(_squares(steps, n)) == 4)


def _squares(steps: Sequence[Operation], index: int) -> list[int]:
    """Return what a sum adds the squares of, nothing if it is no such sum."""
    step = steps[index]
    if step.operator == "mul" and step.operands[0] == step.operands[1]:
        return [step.operands[0]]
    if step.operator != "add":
        return []
    each = [_squares(steps, o) for o in step.operands]
    return [n for part in each for n in part] if all(each) else []


def choice_name(index: int) -> str:
    """Return what a comparison is called among what boxes have ends of: 0 to 1, false to true."""
    return f"choice {index}"


def traits(trace: Unfolded, precision: Precision, *, quaternions: bool) -> Traits:
    """Return what is known of a trace in a precision before any box."""
    exact: list[bool] = []
    for step in trace.steps:
        exact.append(_is_exact(step, [exact[o] for o in step.operands], precision))
    return Traits(trace, precision, tuple(exact), quaternions)


def _is_exact(step: Operation, operands: Sequence[bool], precision: Precision) -> bool:
    match step.operator:
        case "given" | "power_of_two":
            return True
        case "number":
            q = step.number or Fraction(0)
            return Fraction(float(rounded(q, precision.dtype))) == q
        case "rounded" | "neg" | "abs" | "select" | "less" | "at_most" | "both" | "either":
            return all(operands)
    return False


def _kind(steps: Sequence[Operation], step: Operation) -> str:
    """Return what a choice between values amounts to where that has no jump, "" if it may."""
    if step.operator != "select":
        return ""
    condition, yes, no = step.operands
    compared = steps[condition]
    if compared.operator not in COMPARED:
        return ""
    first, second = compared.operands
    if (yes, no) in ((first, second), (second, first)):
        return "least" if yes == first else "most"
    zero = steps[second].number == 0
    negative = steps[yes].operator == "neg" and steps[yes].operands == (no,)
    return "abs" if zero and negative and no == first else ""
