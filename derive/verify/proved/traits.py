"""What is known of the operations of a function before any box: what is exact, and what chooses."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from types import MappingProxyType

from derive.program.arithmetic import rounded
from derive.program.precision import Precision
from derive.verify.proved.multiples import cone, is_multiple, squares_in
from derive.verify.proved.sphere import UNIT
from derive.verify.proved.unfolded import Operation, Unfolded

COMPARED = ("less", "at_most")
ALIKE = (*COMPARED, "add", "sub", "neg", "abs", "select", "power_of_two", "rounded")
"""What gives, of values with a common factor, a value with that factor, or none."""
MOST_CHOICES = 12
NOTHING: Mapping[str, float] = MappingProxyType({})


@dataclass(frozen=True)
class Traits:
    """What is known of a trace before any box: see ``Enclosed``.

    exact       : whether a place has the same value in floats, a choice by such values among them
    quaternions : the components of those that are given
    carried     : how far what is given is off already, by name, before it is rounded
    shell       : between which numbers the squared length of quaternions is
    """

    trace: Unfolded
    precision: Precision
    exact: tuple[bool, ...]
    quaternions: tuple[tuple[str, ...], ...]
    carried: Mapping[str, float]
    shell: tuple[float, float] = UNIT

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

    @cached_property
    def any_power(self) -> bool:
        """Tell whether results are the same whichever powers of two values are scaled by."""
        steps = self.trace.steps
        scales = [n for n, step in enumerate(steps) if step.operator == "power_of_two"]
        return all(_falls_out(self.trace, n) for n in scales)

    def jumps(self, index: int) -> bool:
        """Tell whether a place is a choice that may have a jump."""
        return self.trace.steps[index].operator == "select" and not self.kinds[index]

    @cached_property
    def lengths(self) -> frozenset[int]:
        """Return the places of sums of four squares that are divided by, rooted, or results."""
        steps = self.trace.steps
        if not self.quaternions:
            return frozenset()
        rooted = {o for s in steps for o in s.operands[-1:] if s.operator in ("div", "sqrt")}
        rooted.update(self.trace.results)
        return frozenset(n for n in rooted if len(squares_in(steps, n)) == 4)

    @cached_property
    def multiples(self) -> Mapping[int, tuple[Sequence[str], Sequence[int]]]:
        """Return which lengths are a given quaternion's times another, by which, and its cone."""
        steps, found = self.trace.steps, dict[int, tuple[Sequence[str], Sequence[int]]]()
        for n, names in product(sorted(self.lengths), self.quaternions):
            within = cone(steps, n, names)
            if is_multiple(steps, within, names):
                found[n] = names, within
        return found

    @cached_property
    def spent(self) -> tuple[tuple[int, ...], ...]:
        """Return of each place those whose forms nothing needs any more after it."""
        steps, last = self.trace.steps, dict[int, int]()
        for index, step in enumerate(steps):
            _, within = self.multiples.get(index, ((), ()))
            read = (*step.operands, *(o for n in within for o in steps[n].operands))
            last |= dict.fromkeys((index, *read), index)
        found: list[list[int]] = [[] for _ in steps]
        for place, index in last.items():
            found[index].append(place)
        return tuple(map(tuple, found))


def choice_name(index: int) -> str:
    """Return what a comparison is called among what boxes have ends of: 0 to 1, false to true."""
    return f"choice {index}"


def traits(
    trace: Unfolded,
    precision: Precision,
    quaternions: Sequence[Sequence[str]] = (),
    carried: Mapping[str, float] = NOTHING,
) -> Traits:
    """Return what is known of a trace in a precision before any box."""
    exact: list[bool] = []
    for step in trace.steps:
        own = _is_exact(step, [exact[o] for o in step.operands], precision)
        exact.append(own and step.name not in carried)
    names = {s.name for s in trace.steps}
    whole = tuple(tuple(each) for each in quaternions if names.issuperset(each))
    return Traits(trace, precision, tuple(exact), whole, carried)


def _falls_out(trace: Unfolded, scale: int) -> bool:
    """Tell whether twice a scale gives the same results, as exactly: each value times 2^degree."""
    degrees: list[int | None] = []  # None of a zero, which has any
    for index, step in enumerate(trace.steps):
        own = [degrees[o] for o in step.operands]
        one = [d for d in own[step.operator == "select" :] if d is not None]
        if index == scale:
            degrees.append(1)
        elif step.operator in ("mul", "div"):
            sign = -1 if step.operator == "div" else 1
            degrees.append(one[0] + sign * one[1] if len(one) == len(own) else None)
        elif step.operator == "sqrt" and one[0] % 2 == 0:
            degrees.append(one[0] // 2)
        elif step.operator in ALIKE and len(set(one)) <= 1:
            degrees.append(0 if step.operator in COMPARED else next(iter(one), None))
        elif not any(one):
            degrees.append(None if step.number == 0 else 0)
        else:
            return False
    return not any(degrees[r] for r in trace.results)


def _is_exact(step: Operation, operands: Sequence[bool], precision: Precision) -> bool:
    match step.operator:
        case "given" | "power_of_two":
            return True
        case "number":
            q = step.number or Fraction(0)
            return Fraction(float(rounded(q, precision.dtype))) == q
        case "rounded" | "neg" | "abs" | "select" | "less" | "at_most" | "both" | "either":
            return all(operands)
        case "add":
            return all(operands) and step.operands[0] == step.operands[1]
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
