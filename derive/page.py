"""The page of the lecture: every step with its sentence, its equation and its reasons.

Each assumption also says what it carries: the first step that falls without it, and what is then
left over.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from markupsafe import Markup
from sympy import Expr, MatrixBase

from derive.emit import TEMPLATES
from derive.lecture import CHAPTERS, LECTURE
from derive.lecture.letters import TABLE, Letter
from derive.notation import equation_mathml, mathml, sympy_equation_mathml
from derive.step import Step, first_fall
from derive.tree import rebuilt
from derive.vectors import AXES, Expression, components

FINAL = (
    *("mass_centre_motion", "moving_point_form", "general_form", "body_axes_form", "euler"),
    *("axisymmetric_equations", "gyroscopic_moment", "gyrostat_form", "wheel_equation"),
    *("kinetic_energy_about_point", "koenig", "power", "parallel_axes", "change_of_axes"),
    *("quaternion_rate_vector", "euler_321_rates", "angular_velocities_add"),
)
IN_COMPONENTS = ("angular_momentum", "general_form", "moving_point_form", "body_axes_form",
                 "gyrostat_form", "quaternion_rate_vector", "rotation_of_vector")  # fmt: skip
_MARKS = {"assume": "assumed", "define": "defined", "deduce": "checked"}
_BUILT = {
    (): "scalar(\"{0}\")",
    (3,): "vector(\"{0}\")",
    (3, 3): "tensor(\"{0}\")",
}  # fmt: skip


@dataclass(frozen=True)
class Line:
    """One step as the page shows it."""

    number: int
    step: Step
    mark: str
    equation: Markup
    components: Markup
    falls: str
    leftover: Markup


@dataclass(frozen=True)
class Row:
    """One symbol and its names in three languages."""

    letter: Letter
    symbol: Markup
    python: str
    c: str
    casadi: str


def lecture_page() -> str:
    """Return the text of ``lecture.html``, complete in one file and without scripts."""
    numbers = {step.name: number for number, step in enumerate(LECTURE.steps, 1)}
    chapters = [
        (chapter, _paragraphs(chapter.says), [_line(s, numbers[s.name]) for s in chapter.steps])
        for chapter in CHAPTERS
    ]
    return TEMPLATES.get_template("lecture.html.jinja").render(
        title=LECTURE.title,
        chapters=chapters,
        numbers=numbers,
        table=[_row(letter) for letter in TABLE],
        final=[(LECTURE[name], LECTURE.assumptions(name)) for name in FINAL],
        counts={mark: _count(kind) for kind, mark in _MARKS.items()},
    )


def _count(kind: str) -> int:
    return sum(step.kind == kind for step in LECTURE.steps)


def _paragraphs(text: str) -> list[str]:
    return [" ".join(paragraph.split()) for paragraph in text.strip().split("\n\n")]


def _line(step: Step, number: int) -> Line:
    fall = first_fall(LECTURE, step.name) if step.kind == "assume" else None
    falls, leftover = (fall[0].name, mathml(fall[1])) if fall else ("", "")
    shown = "\n".join(_in_components(step)) if step.name in IN_COMPONENTS else ""
    return Line(
        number,
        step,
        _MARKS[step.kind],
        Markup(equation_mathml(step)),
        Markup(shown),
        falls,
        Markup(leftover),
    )


def _in_components(step: Step) -> Iterator[str]:
    """Yield the equations of a step along x, y and z."""
    for left, right in step.claims:
        sides = components(left), components(right)
        if isinstance(sides[0], MatrixBase):
            yield from map(_equation, sides[0], sides[1])
        else:
            yield _equation(*sides)


def _equation(left: Expr, right: Expr) -> str:
    return sympy_equation_mathml(left, right, {})


def _row(letter: Letter) -> Row:
    """Return a symbol's names: a vector is an array of three, a tensor its named quantities."""
    name, shape = letter.name, letter.symbol.shape
    built = (
        f'inertia("{name}")' if letter.symbol.operator == "inertia" else _BUILT[shape].format(name)
    )
    return Row(letter, Markup(mathml(letter.symbol)), built, _c(letter), _casadi(letter))
