"""How equations are written: plain text for C comments, presentation MathML for pages.

Both come from one ``Layout``, so that a page and a comment cannot say different things.
"""

from collections.abc import Mapping
from typing import Any

from sympy import Expr, Symbol

from derive.emit.notation.layout import Layout
from derive.emit.notation.lines import pieces
from derive.emit.notation.mathml import line, math, row
from derive.emit.notation.symbolic import symbolic_layout
from derive.emit.notation.text import plain
from derive.emit.notation.tree import tree_layout
from derive.lecture.step import Step
from derive.lecture.vectors import Expression

LONG = 180  # characters after which a comment names the first claims and counts the others


def expression_text(expression: Any) -> str:
    """Return ``expression`` in plain ASCII, parentheses only where they are needed.

    expression : a tree of vector algebra, a SymPy expression, or a tuple of these
    Raises NotationError for an operator that has no reading.

    >>> from derive.lecture.vectors import cross, inertia, vector
    >>> expression_text(cross(vector("Omega"), inertia("I") @ vector("omega")))
    'Omega x (I omega)'
    """
    if isinstance(expression, tuple):
        return "; ".join(map(expression_text, expression))
    return plain(_layout(expression))


def equation_text(step: Step) -> str:
    """Return the equation of a lecture step in plain ASCII, several claims joined by ``;``."""
    claims = [plain(claim) for claim in _claims(step)]
    shown = len(claims)
    while shown > 1 and len("; ".join(claims[:shown])) > LONG:
        shown -= 1
    more = [f"and {len(claims) - shown} more"] if shown < len(claims) else []
    return "; ".join([*claims[:shown], *more])


def mathml(expression: Any) -> str:
    """Return ``expression`` as one inline MathML element.

    >>> from derive.lecture.vectors import scalar
    >>> mathml(scalar("m"))
    '<math xmlns="http://www.w3.org/1998/Math/MathML"><mi>m</mi></math>'
    """
    if isinstance(expression, tuple):
        return " ".join(map(mathml, expression))
    return math(row(_layout(expression)))


def equation_mathml(step: Step) -> str:
    """Return the equation of a lecture step as MathML, a line a claim."""
    return "\n".join(line(pieces(claim)) for claim in _claims(step))


def sympy_equation_mathml(left: Expr, right: Expr, names: Mapping[Symbol, str]) -> str:
    """Return ``left = right`` in SymPy expressions as MathML on a line of its own."""
    sides = symbolic_layout(left, names), symbolic_layout(right, names)
    return line(pieces(Layout("equal", sides)))


def sympy_equation_text(left: Expr, right: Expr, names: Mapping[Symbol, str]) -> str:
    """Return ``left = right`` in SymPy expressions as one line of ASCII."""
    return plain(Layout("equal", (symbolic_layout(left, names), symbolic_layout(right, names))))


def name_mathml(name: str, style: str) -> str:
    """Return the name of a quantity as inline MathML; style is scalar, vector or tensor."""
    return math(row(Layout("name", text=name, style=style)))


def _layout(expression: Any) -> Layout:
    if isinstance(expression, Expression):
        return tree_layout(expression)
    return symbolic_layout(expression, {})


def equation_layouts(step: Step) -> list[tuple[Layout, Layout]]:
    """Return left and right of every claim of a lecture step."""
    return [(_layout(left), _layout(right)) for left, right in step.claims]


def _claims(step: Step) -> list[Layout]:
    return [Layout("equal", sides) for sides in equation_layouts(step)]
