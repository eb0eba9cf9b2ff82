"""How expressions are written for people: one line of plain text, for comments and terminals.

``mathml`` writes the same expressions for pages. Both read a symbol's name in the same way:
``rho_i_N_dot`` is the rate, seen from N, of rho of particle i.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from derive.step import Step
from derive.vectors import Expression

OVER = {
    "body": "sum_i",
    "carrier": "sum_(i in carrier)",
    "wheel": "sum_(i in wheel)",
    "wheels": "sum_wheels",
    "pairs": "sum_(i<j)",
    "others": "sum_(j!=i)",
}
_TIGHT = ("symbol", "inertia", "number", "zero", "identity", "unit", "sum", "others", "sin", "cos",
          "cross_tensor", "turn", "trace", "axial", "component", "quantity", "transpose")  # fmt: skip
_ENCLOSING = ("add", "sum", "others", "sin", "cos", "trace", "axial", "cross_tensor", "turn")
_PRODUCTS = ("scale", "apply", "outer", "reciprocal")


@dataclass(frozen=True)
class Spelling:
    """A symbol's letter, what stands below it, its dots, and whether N sees the rate."""

    letter: str
    below: str
    dots: int
    seen_from_N: bool  # noqa: N815


def spelled(name: str) -> Spelling:
    """Return how the symbol called ``name`` is spelled.

    >>> spelled("rho_i_N_dot")
    Spelling(letter='rho', below='i', dots=1, seen_from_N=True)
    """
    letter, *rest = name.removesuffix("_any").split("_")
    dots = sum({"dot": 1, "ddot": 2}.get(part, 0) for part in rest)
    primes = "'" * rest.count("prime")
    below = [part for part in rest if part not in ("dot", "ddot", "prime")]
    seen_from_N = dots > 0 and "N" in below  # noqa: N806
    if seen_from_N:
        below.remove("N")
    return Spelling(letter + primes, " ".join(below), dots, seen_from_N)


def needs_parentheses(expression: Expression, inside: str) -> bool:
    """Return whether ``expression`` stands in parentheses as an operand of the operator ``inside``."""
    operator = expression.operator
    if operator in _TIGHT or inside in _ENCLOSING:
        return False
    if inside == "negate":
        return operator == "add"
    if inside in _PRODUCTS:
        return operator not in _PRODUCTS
    return True


def expression_text(expression: Expression) -> str:
    """Return ``expression`` as one line of ASCII.

    >>> from derive.vectors import cross, inertia, vector
    >>> expression_text(cross(vector("Omega"), inertia("I") @ vector("omega")) - vector("M"))
    'Omega x (I omega) - M'
    """
    operator, operands, name = expression.operator, expression.operands, expression.name
    parts = [_wrapped(operand, operator) for operand in operands]
    match operator:
        case "symbol" | "inertia":
            return name.removesuffix("_any")
        case "number":
            return str(expression.number)
        case "zero":
            return "0"
        case "identity":
            return "1"
        case "unit":
            return f"e_{name}"
        case "add":
            negative = operands[1].operator == "negate"
            return f"{parts[0]} - {parts[1][1:]}" if negative else f"{parts[0]} + {parts[1]}"
        case "sum":
            return f"{OVER[name]}({parts[0]})"
        case "others":
            return f"{OVER['others']}({parts[0]})"
        case "scale" if operands[0] == operands[1]:
            return f"{parts[0]}^2"
        case "component" | "quantity":
            return _with_index(operands[0], parts[0], name)
    return _TEXT[operator].format(*parts)


_TEXT: Mapping[str, str] = {
    "negate": "-{}",
    "scale": "{} {}",
    "apply": "{} {}",
    "outer": "{} {}^T",
    "dot": "{} . {}",
    "cross": "{} x {}",
    "cross_tensor": "[{}]x",
    "transpose": "{}^T",
    "trace": "tr({})",
    "axial": "axial({})",
    "reciprocal": "(1/{})",
    "turn": "turn({}, {})",
    "sin": "sin({})",
    "cos": "cos({})",
}


def _wrapped(operand: Expression, inside: str) -> str:
    text = expression_text(operand)
    return f"({text})" if needs_parentheses(operand, inside) else text


def _with_index(operand: Expression, text: str, index: str) -> str:
    """Return a component's name, the index before the dots as people say it: ``omega_x_dot``."""
    if operand.operator not in ("symbol", "inertia"):
        return f"({text})_{index}"
    return f"{text}_{index}"


def equation_text(step: Step) -> str:
    """Return what a step claims as one line of ASCII, several equations separated by semicolons."""
    return "; ".join(
        f"{expression_text(left)} = {expression_text(right)}" for left, right in step.claims
    )
