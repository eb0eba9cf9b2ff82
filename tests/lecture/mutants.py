"""Wrong versions of a step: a reason too few, a sign turned, a term left out."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from derive.lecture.step import Step
from derive.lecture.tree import summed
from derive.lecture.vectors import IDENTITY, Expression, number, unit

Claim = tuple[Expression, Expression]
_SOMETHING = {(): number(1), (3,): unit("x"), (3, 3): IDENTITY}


@dataclass(frozen=True)
class Mutant:
    """A step made wrong, and how."""

    how: str
    step: Step


def with_fewer_reasons(step: Step) -> Iterator[Mutant]:
    """Yield the step once without each of its reasons."""
    for reason in step.using:
        fewer = tuple(name for name in step.using if name != reason)
        yield Mutant(f"without {reason}", replace(step, using=fewer))


def with_wrong_sides(step: Step) -> Iterator[Mutant]:
    """Yield the step with each term of each claim turned over, and with it left out."""
    for place, claim in enumerate(step.claims):
        for how, wrong in _wrong_claims(*claim):
            claims = [*step.claims]
            claims[place] = wrong
            yield Mutant(f"claim {place + 1}: {how}", _with_claims(step, claims))


def _with_claims(step: Step, claims: list[Claim]) -> Step:
    left, right = (tuple(claim[side] for claim in claims) for side in (0, 1))
    return replace(step, left=left, right=right)


def _wrong_claims(left: Expression, right: Expression) -> Iterator[tuple[str, Claim]]:
    if right.operator == "zero":
        yield "right side not zero", (left, _SOMETHING[right.shape])
        changed = _wrong_sums(left) if len(_terms(left)) > 1 else ()
        yield from ((how, (wrong, right)) for how, wrong in changed)
    else:
        yield from ((how, (left, wrong)) for how, wrong in _wrong_sums(right))


def _wrong_sums(side: Expression) -> Iterator[tuple[str, Expression]]:
    parts = _terms(side)
    for k, part in enumerate(parts):
        others = (parts[:k], parts[k + 1 :])
        yield f"term {k + 1} turned over", summed([*others[0], -part, *others[1]], side.shape)
        yield f"term {k + 1} left out", summed([*others[0], *others[1]], side.shape)


def _terms(side: Expression) -> list[Expression]:
    """Return the terms of a sum as it is written, nothing multiplied out."""
    if side.operator == "add":
        return [term for operand in side.operands for term in _terms(operand)]
    if side.operator == "negate":
        return [-term for term in _terms(side.operands[0])]
    return [side]
