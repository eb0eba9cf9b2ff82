"""A card of the gallery: drawing, question, equation, answer and cost of a scene."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from markupsafe import Markup
from sympy import Expr

from derive.emit.gallery.drawing import drawing
from derive.emit.notation import equation_mathml, sympy_equation_mathml
from derive.emit.page.equation import LONGEST, written_names
from derive.emit.templates import TEMPLATES
from derive.lecture.chapters import LECTURE
from derive.library.library import Library
from derive.lower.arrange.plan import plain_arrangement
from derive.program.arithmetic import extended, paired, working
from derive.program.program import Program, Quantity
from derive.program.run import run
from derive.scene.machine import LEFT_OVER
from derive.scene.unit import behind
from derive.scene.wanted import JACOBIAN


@dataclass(frozen=True)
class Card:
    """What the gallery shows of one scene."""

    name: str
    title: str
    source: str
    drawing: Markup
    equation: Markup
    answer: str
    cost: str


def card(library: Library) -> Card:
    """Return the card of a scene."""
    scene, program = library.scene, (*library.functions, *library.motions)[0]
    return Card(
        scene.name,
        scene.title,
        scene.source,
        Markup(drawing(scene)),  # noqa: S704 (numbers and checked names)
        Markup(_equation(library, program)),  # noqa: S704 (MathML of checked names)
        _answer(library, program),
        _cost(library),
    )


def gallery(cards: Sequence[Card]) -> str:
    """Return the text of ``index.html``."""
    return TEMPLATES.get_template("gallery.html.jinja").render(cards=cards)


def _cost(library: Library) -> str:
    each = [f"{p.name} {p.flops()}" for p in library.functions if not p.name.endswith(JACOBIAN)]
    return ", ".join(each)


def _equation(library: Library, program: Program) -> str:
    """Return the closed form of the first answer, or the lecture step that it comes from."""
    problem = library.problems.get(program.name.removesuffix(JACOBIAN))
    if problem is None:
        return ""  # a step is no equation of the lecture
    mechanism = library.mechanism.posed(problem.name)
    way = plain_arrangement(mechanism, mechanism.lean(problem.name).problem)
    values: dict[Expr, Expr] = {}
    for definition in way.definitions:
        values[definition.symbol] = definition.value.xreplace(values)
    whole = mechanism.whole(problem.name)
    names = written_names(mechanism)
    each = [e.xreplace(values) for e in way.outputs]
    place = next((k for k, e in enumerate(each) if e.count_ops()), 0)  # no name alone, no zero
    symbol, answer = list(whole.answers)[place], each[place]
    if answer.count_ops() <= LONGEST:
        return sympy_equation_mathml(symbol, answer, names)
    step = next(iter(whole.steps), "")
    return equation_mathml(LECTURE[step]) if step else ""


def _answer(library: Library, program: Program) -> str:
    """Return the first function's results at seven tenths of all ranges."""
    given_to = [q for q in (*library.setup.inputs, *program.inputs) if q.role != "constants"]
    middle = {c: x for q in given_to for c, x in zip(q.components, _within(q), strict=True)}
    given = [middle[c] for q in library.setup.inputs for c in q.components]
    table, pairs = working(np.float64), extended(np.float64)
    made = run(library.setup, pairs, paired(np.array(given, float)))
    names = [c for q in library.setup.outputs for c in q.components]
    known = middle | {n: r[0] for n, r in zip(names, made, strict=True)}
    if program.arithmetic == "pairs" or program.has_arrays:
        return ""
    results = run(program, table, [known[c] for q in program.inputs for c in q.components])
    outputs = [(c, q.unit) for q in program.outputs for c in q.components][:3]
    shown = ", ".join(
        f"{c} = {float(r):.4g}{behind(u)}" for (c, u), r in zip(outputs, results, strict=False)
    )
    return f"{shown}, {LEFT_OVER}" if program.name == "steady" else shown


def _within(q: Quantity) -> list[float]:
    """Return a quantity at seven tenths of its range; an attitude has length 1."""
    one = float((3 * (q.low or 0) + 7 * (q.high or 0)) / 10)
    if [c[-2:] for c in q.components] != ["_w", "_x", "_y", "_z"]:
        return [one] * len(q.components)
    size = sqrt(1 + 3 * one * one)
    return [1 / size, *[one / size] * 3]
