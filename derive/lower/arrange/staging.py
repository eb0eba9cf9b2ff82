"""Lecture expressions in components, with what is worth keeping named on the way."""

from collections.abc import Mapping
from typing import Any

from sympy import Matrix, Symbol, eye

from derive.lecture.vectors import COMPONENTS, Expression, components
from derive.lower.arrange.draft import Draft
from derive.mechanics.specialise import Specialised


def staged(draft: Draft, expression: Expression, bindings: Mapping[str, Any]) -> Any:
    """Return the components of a lecture expression, naming the second factor of every product."""
    if expression.operator not in ("cross", "dot", "apply", "add", "negate", "scale"):
        return components(expression, bindings)
    inner = dict(bindings)
    first, *rest = expression.operands
    left = staged(draft, first, bindings)
    if expression.operator == "cross" and left == bindings["omega"]:
        inner["I"] = without_spherical_part(draft.known, bindings["I"])
    operands = [left, *(staged(draft, operand, inner) for operand in rest)]
    if expression.operator in ("cross", "dot"):
        operands[1] = draft.column("let", "l", operands[1])
    return COMPONENTS[expression.operator](*operands)


def without_spherical_part(known: Specialised, tensor: Matrix) -> Matrix:
    """Return the tensor less the multiple of the identity that leaves the fewest moments.

    omega x (I omega) does not change, by the lecture step "spherical_part"; near a sphere its
    cancellation is gone and on the way there are fewer operations.
    """
    if tensor.free_symbols & varying(known):
        return tensor
    moments = [tensor[1, 1], tensor[0, 0], tensor[2, 2]]
    best = max(moments, key=lambda c: sum((m - c).expand() == 0 for m in moments))
    return tensor - best * eye(3)


def varying(known: Specialised) -> set[Symbol]:
    """Return the symbols that change from call to call."""
    words = known.words
    fixed = {words.symbols[c] for q in words.parameters for c in q.components}
    return set(words.symbols.values()) - fixed
