"""A machine in the lecture's terms: its words, its equations, and the ways to compute answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from sympy import Expr, Integer, Pow

from derive.mechanics.answers import Answers
from derive.mechanics.balances import Balances
from derive.mechanics.frames import Frames
from derive.mechanics.linearised import unsteady
from derive.mechanics.matter import Lean, lean
from derive.mechanics.pivots import where
from derive.mechanics.problem import Problem, substituted
from derive.mechanics.sweep import ranges, regular, weakest
from derive.mechanics.vocabulary import Vocabulary
from derive.mechanics.words import Words, words
from derive.scene import Scene, SceneError

SOUGHT = ("acceleration", "accelerations", "state_rate")
"""Functions that find accelerations; what else may be asked of a body, its motion says."""


@dataclass
class Mechanism:
    """A machine with its words and balances; questions are asked once and kept."""

    scene: Scene
    made: Words
    answers: Answers
    questions: dict[str, Problem] = field(default_factory=dict)
    leans: dict[str, Lean] = field(default_factory=dict)
    inverse: Mechanism | None = None

    @property
    def words(self) -> Vocabulary:
        """Return the vocabulary, in which an input may be the answer of another function."""
        return self.made.spoken

    def posed(self, base: str) -> Mechanism:
        """Return the machine as a function poses it: its motion sought, or given."""
        return self if self.inverse is None or base in SOUGHT else self.inverse

    def question(self, base: str) -> Problem:
        """Return a wanted function as a question, everything that is given still in it."""
        if base not in self.questions:
            self.questions[base] = self.posed(base).answers.question(base)
        return self.questions[base]

    def lean(self, base: str) -> Lean:
        """Return the question without what does not matter."""
        if base not in self.leans:
            found = lean(self.question(base), self.posed(base).made)
            _require_unknowns(self, found.question)
            self.leans[base] = found
        return self.leans[base]


def _require_unknowns(known: Mechanism, question: Problem) -> None:
    """Refuse a residual of steady motion that does not change with each of its unknowns."""
    steady = known.scene.steady
    if steady is None or question.outputs[0].name != "steady":
        return
    used = {known.made.sheet.label(s) for s in question.arguments()}
    if missing := [name for name in steady.unknown if name not in used]:
        raise SceneError(
            f"the steady residual must depend on {' and '.join(missing)}, but it does not; "
            "name another steady.unknown, or what vanishes by steady.vanishes"
        )


def doubts(known: Mechanism) -> tuple[str, ...]:
    """Return the warnings of a scene, and those that take its equations to be found."""
    return (*known.scene.warnings, *doubts_at(known, {}))


def doubts_at(known: Mechanism, given: Mapping[str, float]) -> tuple[str, ...]:
    """Return warnings that take a scene's equations to be found, where these values are set."""
    return tuple(unsteady(known.scene, known.answers.balances, given))


def mechanism(machine: Scene) -> Mechanism:
    """Return ``machine`` in the lecture's terms."""
    made = words(machine)
    frames = Frames(machine, made)
    inverse = mechanism(machine.inverse) if machine.inverse else None
    return Mechanism(machine, made, Answers(machine, frames, Balances(frames)), inverse=inverse)


def problem(known: Mechanism, base: str) -> Problem:
    """Return what the lecture says of a wanted function: named quantities, balances, answers."""
    known = known.posed(base)
    try:
        known.lean(base)
    except ZeroDivisionError:
        if known.scene.merging:
            rule = "formulas must have a value on all of the declared ranges"
            raise SceneError(f"{rule}, but {known.scene.merging}") from None
        rule = "must change at a finite rate where all that varies is 0, as the root of a square"
        raise SceneError(f"what '{base}' rests on {rule} does not") from None
    found = substituted(known.question(base), dict.fromkeys(known.made.hidden, Integer(1)))
    return replace(found, name=base, steps=tuple(dict.fromkeys(found.steps)))


def pole(known: Mechanism, base: str) -> str:
    """Return words on what a function divides by that vanishes in its ranges, "" if nothing."""
    known = known.posed(base)
    question, label = known.question(base), known.made.sheet.label
    slopes = [known.made.sheet.split(row)[1] for row in question.rows]
    entries = [[own.get(u, Integer(0)) for u in question.unknowns] for own in slopes]
    divided = [(question.unknowns, entries)] if entries else []
    values = {**question.definitions, **question.answers}
    divided += [((s,), [[d]]) for s, value in values.items() for d in _divisors(value)]
    of = ranges(known.made)
    for symbols, matrix in divided:
        worst = weakest(of, question.definitions, partial(regular, entries=matrix))
        if worst.vanishes:
            names = ", ".join(f"'{label(s)}'" for s in symbols)
            return f"the divisor of {names} vanishes {where(worst.place)}"
    return ""


def _divisors(value: Expr) -> list[Expr]:
    """Return what an expression divides by, in an order that rests on nothing but itself."""
    return sorted((p.base for p in value.atoms(Pow) if p.exp.is_negative), key=str)


def dropped(known: Mechanism, base: str) -> Mapping[str, tuple[str, ...]]:
    """Return what was found not to matter to a function: what cancels, what never enters."""
    known = known.posed(base)
    sheet, machine, words = known.made.sheet, known.scene, known.made.vocabulary
    found = known.lean(base)
    cancelled = {sheet.label(s) for s in found.cancelled}
    used = {sheet.label(s) for s in known.question(base).arguments()}
    every = [c for q in (*words.parameters, *words.states, *words.inputs)
             for c in q.components]  # fmt: skip
    asked = known.question(base).unknowns
    named = [u.name for u in machine.unknowns if u.name.isidentifier()]  # as a user may
    unasked = [name for name in named if sheet.symbols[name] not in asked]
    return {
        "cancels": tuple(c for c in every if c in cancelled),
        "never enters": tuple(c for c in every if c not in used),
        "unknowns left out": tuple(unasked),
    }


def depends_on(known: Mechanism, base: str) -> tuple[str, ...]:
    """Return the parameters, states and inputs that the answers of a function change with."""
    known = known.posed(base)
    used = {known.made.sheet.label(s) for s in known.lean(base).question.arguments()}
    words = known.made.vocabulary
    every = (*words.parameters, *words.states, *words.inputs)
    return tuple(c for q in every for c in q.components if c in used)
