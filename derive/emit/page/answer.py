"""What a function answers, told in a few lines: closed forms where these are short, and figures.

Figures are results of the function at seven tenths of all declared ranges.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from markupsafe import Markup

from derive.emit.notation import name_mathml
from derive.emit.page.equation import letter, taken_names, written_names
from derive.emit.page.glance import at_a_glance
from derive.library.library import Library
from derive.program.arithmetic import extended, paired, working
from derive.program.program import Program, Quantity
from derive.program.run import run
from derive.scene.machine import LEFT_OVER
from derive.scene.unit import behind
from derive.scene.wanted import JACOBIAN

_SHOWN = 6  # components of a function's results
_PARTS = ("_w", "_x", "_y", "_z")


@dataclass(frozen=True)
class AnswerLine:
    """A function, what it is for, equations that tell its answers, and its results as a line."""

    function: str
    says: str
    equations: tuple[Markup, ...]
    figures: Markup


def answer_lines(library: Library) -> tuple[AnswerLine, ...]:
    """Return the answers of a scene in their order, derivatives left out."""
    asked = [p for p in library.functions if not p.name.endswith(JACOBIAN)]
    middle = _middle(library)
    return tuple(
        AnswerLine(p.name, p.says, closed_forms(library, p), results_line(library, p, middle))
        for p in asked
    )


def closed_forms(library: Library, program: Program) -> tuple[Markup, ...]:
    """Return the closed forms of a function's answers, or the law that they come from."""
    base = program.name.removesuffix(JACOBIAN)
    if base not in library.problems:
        return ()  # a step is no equation of the lecture
    return tuple(map(Markup, at_a_glance(library, base)))  # (MathML of checked names)


def _middle(library: Library) -> dict[str, float]:
    """Return the parameters and all constants of set-up, well inside the declared ranges."""
    given = {c: x for q in library.setup.inputs
             for c, x in zip(q.components, _within(q), strict=True)}  # fmt: skip
    made = run(library.setup, extended(np.float64), paired(np.array([*given.values()], float)))
    names = [c for q in library.setup.outputs for c in q.components]
    return given | {n: r[0] for n, r in zip(names, made, strict=True)}


def results_line(library: Library, program: Program, middle: Mapping[str, float]) -> Markup:
    """Return a function's first results at seven tenths of all ranges, each with its name."""
    if program.arithmetic == "pairs" or program.has_arrays:
        return Markup("")
    given = [q for q in program.inputs if q.role != "constants"]
    own = {c: x for q in given for c, x in zip(q.components, _within(q), strict=True)}
    known = {**own, **middle}
    results = run(program, working(np.float64),
                  [known[c] for q in program.inputs for c in q.components])  # fmt: skip
    outputs = [(q, c) for q in program.outputs for c in q.components]
    every = [
        f"{_name(library, q, c)} = {_four_digits(float(r))}{behind(q.unit).replace('^2', '²')}"
        for place, ((q, c), r) in enumerate(zip(outputs, results, strict=True))
        if program.results[place] not in (*own, 0)  # which say nothing: given, or none
    ]
    left = [LEFT_OVER] if program.name in library.scene.steady else []
    rest = [f"and {len(every) - _SHOWN} more"] * (len(every) > _SHOWN)
    return Markup(", ".join([*every[:_SHOWN], *rest, *left]))  # noqa: S704 (numbers, units and checked names)


def _four_digits(value: float) -> str:
    """Return a number as people write it.

    >>> _four_digits(-20059.3), _four_digits(0.0000123456)
    ('−2.006 · 10<sup>4</sup>', '1.235 · 10<sup>−5</sup>')
    """
    digits, _, power = f"{value:.4g}".replace("-", "−").partition("e")
    sign, size = power[:1].replace("+", ""), power[1:].lstrip("0")
    return f"{digits} · 10<sup>{sign}{size}</sup>" if power else digits


def _name(library: Library, q: Quantity, component: str) -> str:
    """Return a component as the page's equations write it."""
    names = written_names(library.mechanism)
    symbol = library.mechanism.words.sheet.symbols.get(component)
    if symbol in names:
        return name_mathml(names[symbol], "scalar")
    of_state = {c: v.name for v in library.vocabulary.states for c in v.components}
    start = q.name if component.startswith(q.name) else of_state.get(component, "")
    if not start or not component.startswith(start):
        return name_mathml(component, "scalar")
    new = letter(start, taken_names(library.mechanism))
    return name_mathml(new + component.removeprefix(start), "scalar")


def _within(q: Quantity) -> Sequence[float]:
    """Return a quantity at seven tenths of its range; an attitude has length 1."""
    one = float((3 * (q.low or 0) + 7 * (q.high or 0)) / 10)
    if tuple(c[-2:] for c in q.components) != _PARTS:
        return [one] * len(q.components)
    size = sqrt(1 + 3 * one * one)
    return [1 / size, *[one / size] * 3]


def first_answer(library: Library) -> AnswerLine:
    """Return the first answer of a scene, or what its first step gives if there is none."""
    program = (*library.functions, *library.motions)[0]
    return AnswerLine(program.name, program.says, closed_forms(library, program),
                  results_line(library, program, _middle(library)))  # fmt: skip
