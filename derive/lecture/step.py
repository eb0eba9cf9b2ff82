"""A derivation is a list of steps; a step is a claim with its reasons, checked by them alone.

Every step holds at all times, so a reason may be differentiated. A reason whose left side is a
symbol explains that symbol; any other reason is a relation between what is left unexplained.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter
from typing import Literal

from sympy import Expr

from derive.lecture.facts import CircularError, Facts, expressions_of
from derive.lecture.rate import without_rates
from derive.lecture.relations import ContradictionError
from derive.lecture.tree import renamed, symbols
from derive.lecture.vectors import Expression, zero

ScalarOrColumn = Expression | tuple[Expression, ...]


@dataclass(frozen=True)
class Step:
    """One line of the lecture: ``left = right``, because of ``using``.

    For a tuple of sides every pair is claimed. ``instance`` renames the symbols of the reasons: the
    reason is a theorem about any body, and this step speaks of another one.
    """

    name: str
    says: str
    kind: Literal["assume", "define", "deduce"]
    left: ScalarOrColumn
    right: ScalarOrColumn
    using: tuple[str, ...] = ()
    instance: tuple[tuple[str, str], ...] = ()

    @property
    def claims(self) -> tuple[tuple[Expression, Expression], ...]:
        """Return the pairs (left, right) that the step claims to be equal."""
        return tuple(zip(expressions_of(self.left), expressions_of(self.right), strict=True))


@dataclass(frozen=True)
class Derivation:
    """Steps in reading order; a step may use only the steps above it."""

    title: str
    steps: tuple[Step, ...]

    @cached_property
    def _by_name(self) -> dict[str, Step]:
        return {step.name: step for step in self.steps}

    def __getitem__(self, name: str) -> Step:
        if name not in self._by_name:
            raise KeyError(f"the lecture has no step '{name}'")
        return self._by_name[name]

    def assumptions(self, name: str) -> tuple[str, ...]:
        """Return every assumption that the step ``name`` rests on, sorted."""
        step = self[name]
        below = {a for reason in step.using for a in self.assumptions(reason)}
        return tuple(sorted(below | ({name} if step.kind == "assume" else set())))

    def without(self, reason: str) -> Derivation:
        """Return the derivation in which no step may use ``reason`` any more."""
        self[reason]
        fewer = (replace(s, using=tuple(u for u in s.using if u != reason)) for s in self.steps)
        return replace(self, steps=tuple(fewer))

    def facts(self, step: Step) -> Facts:
        """Return what a step may use, and no more; a false instance may use nothing."""
        if not step.instance:
            return Facts.of((self[reason].claims for reason in step.using), {})
        theorems = [self[reason] for reason in step.using if self[reason].kind != "define"]
        sound = not _false_instance(self, step)
        return Facts.of((each.claims for each in theorems if sound), dict(step.instance))

    def behind(self, *names: str) -> frozenset[str]:
        """Return the names of the steps ``names`` and of all that they rest on."""
        reasons = {reason for name in names for reason in self[name].using}
        return frozenset(names) | (self.behind(*sorted(reasons)) if reasons else frozenset())

    def gap(self, step: Step) -> tuple[Expr, ...]:
        """Return left - right of a step, entry by entry, by its reasons and by nothing else."""
        return self.facts(step).gap(step.claims)


@dataclass(frozen=True)
class Checked:
    """One row of the table that ``derive lecture`` prints."""

    name: str
    kind: str
    reasons: tuple[str, ...]
    fault: str
    seconds: float

    @property
    def holds(self) -> bool:
        """Return whether the step stands."""
        return not self.fault


def first_fall(derivation: Derivation, reason: str) -> tuple[Step, Expression] | None:
    """Return the first step that falls without ``reason`` and what is then left of left - right.

    None if no step needs the reason.
    """
    poorer = derivation.without(reason)
    for step in poorer.steps:
        if step != derivation[step.name] and any(poorer.gap(step)):
            return derivation[step.name], leftover(poorer, step)
    return None


def leftover(derivation: Derivation, step: Step) -> Expression:
    """Return left - right of the first claim that fails, as far as the reasons explain it."""
    facts = derivation.facts(step)
    for left, right in step.claims:
        if any(facts.gap([(left, right)])):
            return facts.leftover(left, right)
    return zero()


def verify(derivation: Derivation) -> Iterator[Checked]:
    """Check every step exactly and yield one row a step, in reading order."""
    spoken: set[str] = set()
    above: set[str] = set()
    for step in derivation.steps:
        start = perf_counter()
        fault = _fault(derivation, step, spoken, above)
        yield Checked(step.name, step.kind, step.using, fault, perf_counter() - start)
        above.add(step.name)
        spoken |= {without_rates(name) for name in _names(step)}


def _fault(derivation: Derivation, step: Step, spoken: set[str], above: set[str]) -> str:
    """Return the rule that a step breaks, or the empty string."""
    if step.name in above:
        return "this name is taken by a step above"
    if later := [reason for reason in step.using if reason not in above]:
        return f"uses {later[0]}, which is not a step above it"
    if step.kind == "define":
        return _smuggled(step, spoken)
    if step.kind == "assume":
        return ""
    if step.instance and (fault := _false_instance(derivation, step)):
        return fault
    try:
        gap = derivation.gap(step)
    except (CircularError, ContradictionError) as error:
        return str(error)
    return f"left - right = {', '.join(map(str, gap))}" if any(gap) else ""


def _smuggled(step: Step, spoken: set[str]) -> str:
    """A definition may only name something new, so that no claim can enter as a definition."""
    known = set(spoken)
    for left, right in step.claims:
        if left.operator not in ("symbol", "inertia"):
            return "a definition must have a bare symbol on its left"
        above = {without_rates(name) for name in symbols(right)}
        if without_rates(left.name) in known:
            return f"defines {left.name} again"
        if without_rates(left.name) in above:
            return f"defines {left.name} by itself"
        known |= above | {without_rates(left.name)}
    return ""


def _false_instance(derivation: Derivation, step: Step) -> str:
    """A theorem holds for another body if that body's quantities are defined by the same sums."""
    names = dict(step.instance)
    reasons = [derivation[reason] for reason in step.using]
    theorems = [each for each in reasons if each.kind != "define"]
    for old, new in step.instance:
        if without_rates(new) != names.get(without_rates(old)):
            return f"{new} is not to {without_rates(new)} what {old} is to {without_rates(old)}"
    if kept := sorted({name for each in theorems for name in _names(each)} - set(names)):
        return f"does not say what {kept[0]} is for the other body"
    general = derivation.behind(*(each.name for each in theorems))
    defined = _definitions(reasons)
    for old, right in _definitions([s for s in derivation.steps if s.name in general]).items():
        new = names.get(old, old)
        if renamed(right, names) != (right if new == old else defined.get(new)):
            return f"{new} is not defined as {old} is"
    return ""


def _definitions(steps: list[Step]) -> dict[str, Expression]:
    claims = (claim for step in steps if step.kind == "define" for claim in step.claims)
    return {left.name: right for left, right in claims}


def _names(step: Step) -> set[str]:
    return {name for pair in step.claims for side in pair for name in symbols(side)}
