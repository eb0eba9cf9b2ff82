"""Lecture expressions in components, with what is worth keeping named on the way."""

from collections.abc import Mapping
from typing import Any

from sympy import Symbol

from derive.lecture.vectors import COMPONENTS, Expression, components
from derive.lower.arrange.draft import Draft
from derive.lower.arrange.spherical_part import without_spherical_part
from derive.mechanics.specialise import Specialised


def staged(draft: Draft, expression: Expression, bindings: Mapping[str, Any]) -> Any:
    """Return the components of a lecture expression, naming the second factor of every product."""
    if expression.operator not in ("cross", "dot", "apply", "add", "negate", "scale"):
        return components(expression, bindings)
    inner = dict(bindings)
    first, *rest = expression.operands
    left = staged(draft, first, bindings)
    constant = not bindings["I"].free_symbols & varying(draft.known)
    if constant and expression.operator == "cross" and left == bindings["omega"]:
        inner["I"] = without_spherical_part(bindings["I"])
    operands = [left, *(staged(draft, operand, inner) for operand in rest)]
    if expression.operator in ("cross", "dot"):
        operands[1] = draft.column("let", "l", operands[1])
    return COMPONENTS[expression.operator](*operands)


def varying(known: Specialised) -> set[Symbol]:
    """Return the symbols that change from call to call."""
    words = known.words
    fixed = {words.symbols[c] for q in words.parameters for c in q.components}
    return set(words.symbols.values()) - fixed
