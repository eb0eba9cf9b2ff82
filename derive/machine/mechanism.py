"""A machine in the lecture's terms: its words, its equations, and the ways to compute answers."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import prod

from sympy import Add, Expr, Integer, Mul, Pow, Symbol, sin

from derive.draft import Arrangement, Stage
from derive.machine.answers import Answers
from derive.machine.balances import Balances
from derive.machine.frames import Frames
from derive.machine.linearised import unsteady
from derive.machine.matter import Lean, lean
from derive.machine.pivots import Pivots, where
from derive.machine.probe import point
from derive.machine.question import Question, substituted
from derive.machine.sheet import Sheet
from derive.machine.solve import solved
from derive.machine.sweep import ranges, regular, weakest
from derive.machine.words import Words, words
from derive.motion import reduced
from derive.scene import Machine, Scene, SceneError
from derive.specialise import Specialised, specialise
from derive.truth import Truth
from derive.truth import truth as of_one_body
from derive.vocabulary import Vocabulary

LONGEST_TIDIED = 150  # operations of a term in which squares of sines are looked for
MANY_TERMS = 10  # a named quantity of more terms is not multiplied out by its users


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
    except SceneError as error:
        raise SceneError(f"scene '{known.scene.name}': {error}") from None
    except ZeroDivisionError:
        rule = "must change at a finite rate where all that varies is 0, as the root of a square"
        raise SceneError(
            f"scene '{known.scene.name}': what '{base}' rests on {rule} does not"
        ) from None
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


def arrange(known: Mechanism, fact: Truth) -> tuple[Arrangement, ...]:
    """Return the way to compute the outputs of ``fact``."""
    return (plain_arrangement(known, known.lean(fact.name).question),)


def plain_arrangement(known: Mechanism, question: Question) -> Arrangement:
    """Return the stages of a question: named quantities, solved balances, answers."""
    question = tidied(with_parameters_put_in(question, known.words), known.made.sheet)
    named = dict(question.definitions)
    if question.rows:
        probe = point(known.made, 0)
        probe.define(question.definitions)
        pivots = Pivots(ranges(known.made), question.definitions, known.made.sheet.label)
        found = solved(question.rows, question.unknowns, known.made.sheet.split, probe, pivots)
        named |= {stage.symbol: stage.value for stage in found.stages}
    outputs = tuple(question.answers.values())
    return Arrangement(tuple(staged(named)), outputs)


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


def with_parameters_put_in(question: Question, words: Vocabulary) -> Question:
    """Return the question without names for short sums of parameters: set-up finds them itself."""
    fixed = {words.symbols[c] for q in words.parameters for c in q.components}
    known: dict[Symbol, Expr] = {}
    for symbol, value in question.definitions.items():
        made = value.xreplace(known)
        if made.free_symbols <= fixed and _terms(made, {}) <= MANY_TERMS:
            known[symbol] = made
    return substituted(question, known)


def tidied(question: Question, sheet: Sheet) -> Question:
    """Return the question with sin^2 + cos^2 = 1 used wherever it makes a term shorter."""
    rows = []
    for row in question.rows:
        rest, slopes = sheet.split(row)
        rows.append(_shorter(rest) + sum(_shorter(c) * u for u, c in slopes.items()))
    return replace(
        question,
        definitions={s: _shorter(e) for s, e in question.definitions.items()},
        rows=tuple(rows),
        answers={s: _shorter(e) for s, e in question.answers.items()},
    )


def _shorter(e: Expr) -> Expr:
    squares = any(p.exp == 2 and isinstance(p.base, sin) for p in e.atoms(Pow))
    if not squares or e.count_ops() > LONGEST_TIDIED:
        return e
    other = reduced(e)
    return other if other.count_ops() < e.count_ops() else e


def staged(named: Mapping[Symbol, Expr]) -> list[Stage]:
    """Return the named quantities as stages; one that would multiply out to much is cut off."""
    sizes: dict[Symbol, int] = {}
    stages = []
    for symbol, value in named.items():
        size = _terms(value, sizes)
        sizes[symbol] = 1 if size > MANY_TERMS else size
        stages.append(Stage("cut" if size > MANY_TERMS else "let", symbol, value))
    return stages


def _terms(e: Expr, sizes: Mapping[Symbol, int]) -> int:
    """Return how many terms an expression has when it is multiplied out."""
    if isinstance(e, Add):
        return sum(_terms(part, sizes) for part in e.args)
    if isinstance(e, Mul):
        return int(prod(_terms(part, sizes) for part in e.args))
    if isinstance(e, Pow) and e.exp.is_Integer and e.exp > 0:
        return int(_terms(e.base, sizes) ** min(int(e.exp), 4))
    return sizes.get(e, 1)


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
