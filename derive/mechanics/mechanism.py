"""A machine in the lecture's terms: its words, its equations, and the ways to compute answers."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Expr, Integer, Symbol

from derive.mechanics.answers import Answers
from derive.mechanics.balances import Balances
from derive.mechanics.frames import Frames
from derive.mechanics.linearised import unsteady
from derive.mechanics.matter import Lean, lean
from derive.mechanics.pivots import where
from derive.mechanics.question import Question, substituted
from derive.mechanics.specialise import Specialised, specialise
from derive.mechanics.sweep import ranges, regular, weakest
from derive.mechanics.truth import Truth
from derive.mechanics.truth import truth as of_one_body
from derive.mechanics.vocabulary import Vocabulary
from derive.mechanics.words import Words, words
from derive.scene import Machine, Scene, SceneError


@dataclass
class Mechanism:
    """A machine with its words and balances; questions are asked once and kept."""

    scene: Machine
    made: Words
    answers: Answers
    questions: dict[str, Question] = field(default_factory=dict)
    leans: dict[str, Lean] = field(default_factory=dict)

    @property
    def words(self) -> Vocabulary:
        """Return the vocabulary."""
        return self.made.vocabulary

    def question(self, base: str) -> Question:
        """Return a wanted function as a question, everything that is given still in it."""
        if base not in self.questions:
            self.questions[base] = self.answers.question(base)
        return self.questions[base]

    def lean(self, base: str) -> Lean:
        """Return the question without what does not matter."""
        if base not in self.leans:
            found = lean(self.question(base), self.made)
            _require_unknowns(self, found.question)
            self.leans[base] = found
        return self.leans[base]


def _require_unknowns(known: Mechanism, question: Question) -> None:
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


Known = Specialised | Mechanism
"""A scene in the lecture's terms: of a single body, or of a machine."""


def single(known: Known) -> Specialised:
    """Return the terms of a single body, where a machine cannot be asked.

    Raises TypeError for a machine.
    """
    if isinstance(known, Mechanism):
        raise TypeError(f"scene '{known.scene.name}' is a machine, not a single body")
    return known


def doubts(known: Known) -> tuple[str, ...]:
    """Return the warnings of a scene, and those that take its equations to be found."""
    return (*known.scene.warnings, *doubts_at(known, {}))


def doubts_at(known: Known, given: Mapping[str, float]) -> tuple[str, ...]:
    """Return warnings that take a scene's equations to be found, where these values are set."""
    if not isinstance(known, Mechanism):
        return ()
    return tuple(unsteady(known.scene, known.answers.balances, given))


def in_terms(scene: Scene | Machine) -> Known:
    """Return a scene in the lecture's terms, of whichever kind it is."""
    return mechanism(scene) if isinstance(scene, Machine) else specialise(scene)


def truth_of(known: Known, base: str) -> Truth:
    """Return what the lecture says of a wanted function, of whichever kind the scene is."""
    return truth(known, base) if isinstance(known, Mechanism) else of_one_body(known, base)


def mechanism(machine: Machine) -> Mechanism:
    """Return ``machine`` in the lecture's terms."""
    made = words(machine)
    frames = Frames(machine, made)
    return Mechanism(machine, made, Answers(machine, frames, Balances(frames)))


def truth(known: Mechanism, base: str) -> Truth:
    """Return what the lecture says of a wanted function: named quantities, balances, answers."""
    try:
        known.lean(base)
    except ZeroDivisionError:
        rule = "must change at a finite rate where all that varies is 0, as the root of a square"
        raise SceneError(f"what '{base}' rests on {rule} does not") from None
    question = substituted(known.question(base), dict.fromkeys(known.made.hidden, Integer(1)))
    unknowns: list[Symbol] = [*question.definitions, *question.unknowns]
    residuals: list[Expr] = [value - s for s, value in question.definitions.items()]
    residuals += question.rows
    for s, value in question.answers.items():
        if s not in question.unknowns:
            unknowns.append(s)
            residuals.append(value - s)
    steps = tuple(dict.fromkeys(question.steps))
    return Truth(base, question.says, question.outputs, tuple(unknowns), tuple(residuals), steps)


def pole(known: Mechanism, base: str) -> str:
    """Return words on where the balances of a function depend on each other, "" if nowhere."""
    question, label = known.question(base), known.made.sheet.label
    slopes = [known.made.sheet.split(row)[1] for row in question.rows]
    entries = [[own.get(u, Integer(0)) for u in question.unknowns] for own in slopes]
    if not entries:
        return ""
    of = ranges(known.made)
    worst = weakest(of, question.definitions, lambda at: regular(at, entries))
    names = ", ".join(f"'{label(u)}'" for u in question.unknowns)
    return f"the divisor of {names} vanishes {where(worst.place)}" if worst.vanishes else ""


def dropped(known: Mechanism, base: str) -> Mapping[str, tuple[str, ...]]:
    """Return what was found not to matter to a function: what cancels, what never enters."""
    sheet, machine = known.made.sheet, known.scene
    found = known.lean(base)
    cancelled = {sheet.label(s) for s in found.cancelled}
    used = {sheet.label(s) for s in known.question(base).arguments()}
    every = [c for q in (*known.words.parameters, *known.words.states, *known.words.inputs)
             for c in q.components]  # fmt: skip
    asked = known.question(base).unknowns
    unasked = [u.name for u in machine.unknowns if sheet.symbols[u.name] not in asked]
    return {
        "cancels": tuple(c for c in every if c in cancelled),
        "never enters": tuple(c for c in every if c not in used),
        "unknowns left out": tuple(unasked),
    }


def depends_on(known: Mechanism, base: str) -> tuple[str, ...]:
    """Return the parameters, states and inputs that the answers of a function change with."""
    used = {known.made.sheet.label(s) for s in known.lean(base).question.arguments()}
    every = (*known.words.parameters, *known.words.states, *known.words.inputs)
    return tuple(c for q in every for c in q.components if c in used)
