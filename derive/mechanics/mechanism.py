"""A machine in the lecture's terms: its words, its equations, and the ways to compute answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, TypeVar

from numpy.typing import NDArray
from sympy import Expr, Integer, Pow

from derive.mechanics.answers import Answers
from derive.mechanics.balances import Balances
from derive.mechanics.box import ranges
from derive.mechanics.contradiction import idle_enforcer
from derive.mechanics.follows import wants_small_motion, with_what_follows
from derive.mechanics.frames import Frames
from derive.mechanics.held import Bindings, bindings
from derive.mechanics.inertia import vanishing
from derive.mechanics.linearised import unsteady
from derive.mechanics.loads import idle_springs
from derive.mechanics.matter import Lean, lean
from derive.mechanics.problem import Problem, substituted
from derive.mechanics.rotation import FreeRotation, free_rotation
from derive.mechanics.sheet import below
from derive.mechanics.signs import signs_taken
from derive.mechanics.sweep import regular, weakest
from derive.mechanics.vocabulary import Vocabulary
from derive.mechanics.words import Words, words
from derive.scene import Scene, SceneError

T = TypeVar("T")


@dataclass
class Mechanism:
    """A machine with its words and balances; problems are posed once and kept.

    inverse : the machine with its motion given, and what moves it sought
    told    : what is found once of a function or of some unknowns, by what it is and of which
    """

    scene: Scene
    words: Words
    answers: Answers
    inverse: Mechanism | None = None
    wholes: dict[str, Problem] = field(default_factory=dict)
    leans: dict[str, Lean] = field(default_factory=dict)
    told: dict[tuple[str, str], Any] = field(default_factory=dict)

    def told_once(self, what: str, base: str, make: Callable[[], T]) -> T:
        """Return what is told of a function or of unknowns, made when it is asked for first."""
        place = what, base
        if place not in self.told:
            self.told[place] = make()
        found: T = self.told[place]
        return found

    @property
    def vocabulary(self) -> Vocabulary:
        """Return the vocabulary, in which an input may be the answer of another function."""
        return self.words.spoken

    def posed(self, base: str) -> Mechanism:
        """Return the machine as a function poses it: its motion sought, or given."""
        return self.inverse or self if self.scene.posed(base) is self.scene.inverse else self

    def whole(self, base: str) -> Problem:
        """Return a wanted function as a problem, everything that is given still in it."""
        own = self.posed(base)
        if base not in own.wholes:
            own.wholes[base] = own.answers.problem(base)
        return own.wholes[base]

    def lean(self, base: str) -> Lean:
        """Return the problem without what does not matter."""
        own = self.posed(base)
        if base not in own.leans:
            found = lean(self.whole(base), own.words)
            _require_unknowns(own, found.problem)
            own.leans[base] = found
        return own.leans[base]

    def problem(self, base: str) -> Problem:
        """Return what the lecture says of a wanted function: named quantities, balances, answers.

        Raises SceneError if it has none, or none on all of the declared ranges.
        """
        own = self.posed(base)
        try:
            own.lean(base)
        except ZeroDivisionError:
            if own.scene.merging:
                rule = "formulas must have a value on all of the declared ranges"
                raise SceneError(f"{rule}, but {own.scene.merging}") from None
            rule = "must change at a finite rate where all that varies is 0, as the root of a"
            raise SceneError(f"what '{base}' rests on {rule} square does not") from None
        found = substituted(own.whole(base), dict.fromkeys(own.words.hidden, Integer(1)))
        return replace(found, name=base, steps=tuple(dict.fromkeys(found.steps)))

    @cached_property
    def body_by_body(self) -> Mechanism:
        """Return the machine with balances of single bodies, about their mass centres only."""
        a = self.answers
        plain = Answers(a.machine, a.frames, a.balances.body_by_body())
        return replace(self, answers=plain, wholes={}, leans={}, told={})

    def rotation(self) -> FreeRotation | None:
        """Return the rotation of the only body that turns freely, None if there is none."""
        return free_rotation(self.answers.frames)

    @cached_property
    def said(self) -> tuple[str, ...]:
        """Return what a scene is made of, and whose signs its equations rest on."""
        return (*self.scene.told, *self.signs)

    @cached_property
    def signs(self) -> tuple[str, ...]:
        """Return a sentence for each root of a square that is taken as what is squared."""
        return tuple(dict.fromkeys(signs_taken(self.answers.frames)))

    def doubts(self) -> tuple[str, ...]:
        """Return the warnings of a scene, and those that take its equations to be found."""
        idle = idle_springs(self.answers.frames)
        says = (*self.scene.warnings, *idle, *self.redundant, *self.doubts_at({}))
        named = any(c.load not in ("", c.name) for c in self.scene.constraints)
        enforcer = idle_enforcer(self.answers.balances) if named else ""
        return (*says, enforcer) if enforcer else says

    @property
    def redundant(self) -> tuple[str, ...]:
        """Return a sentence for each part of a constraint that the others hold anyway."""
        return self.held.doubts

    @property
    def held(self) -> Bindings:
        """Return the conditions of its constraints."""
        return bindings(self.answers.frames)

    def doubts_at(self, given: Mapping[str, float]) -> tuple[str, ...]:
        """Return warnings that take a scene's equations to be found, where these values are set."""
        return tuple(unsteady(self.scene, self.answers.balances, given))

    def fulfilling(self, here: NDArray[Any]) -> NDArray[Any] | None:
        """Return the values of all that is given at which the constraints hold, nearest to some."""
        return ranges(self.words).fulfilling(here)

    def pole(self, base: str) -> str:
        """Return words on what a function divides by that vanishes in its ranges, "" if nothing."""
        own, problem = self.posed(base), self.whole(base)
        entries = [[row.get(u, Integer(0)) for u in problem.unknowns] for _, row in problem.parts]
        divided = [(problem.unknowns, entries)] if entries else []
        values = {**problem.definitions, **problem.answers}
        divided += [((s,), [[d]]) for s, value in values.items() for d in _divisors(value)]
        of = ranges(own.words)
        for symbols, matrix in divided:
            needed = below(problem.definitions, [e for row in matrix for e in row])
            exprs = (*needed.values(), *(e for row in matrix for e in row))
            if not {s for e in exprs for s in e.free_symbols} <= {*of.symbols, *needed}:
                continue  # it holds what is found, which has no range
            worst = weakest(of, needed, partial(regular, entries=matrix))
            if worst.vanishes:
                says = vanishing(own.answers.balances, symbols, matrix, worst)
                names = ", ".join(f"'{own.words.sheet.label(s)}'" for s in symbols)
                return says or f"the divisor of {names} vanishes {worst.where}"
        return ""

    def dropped(self, base: str) -> Mapping[str, tuple[str, ...]]:
        """Return what was found not to matter to a function: what cancels, what never enters."""
        own, whole = self.posed(base), self.whole(base)
        symbols, used = own.words.sheet.symbols, _labels(own.words, whole)
        cancelled = {own.words.sheet.label(s) for s in self.lean(base).cancelled}
        named = [u.name for u in own.scene.unknowns if u.name.isidentifier()]  # as a user may
        every = _components(own)
        return {
            "cancels": tuple(c for c in every if c in cancelled),
            "never enters": tuple(c for c in every if c not in used),
            "unknowns left out": tuple(u for u in named if symbols[u] not in whole.unknowns),
        }

    def depends_on(self, base: str) -> tuple[str, ...]:
        """Return the parameters, states and inputs that the answers of a function change with."""
        own = self.posed(base)
        used = _labels(own.words, self.lean(base).problem)
        return tuple(c for c in _components(own) if c in used)


def mechanism(machine: Scene) -> Mechanism:
    """Return ``machine`` in the lecture's terms."""
    made = words(machine)
    frames = Frames(machine, made)
    if wants_small_motion(machine) and (chosen := with_what_follows(frames)) is not machine:
        return mechanism(chosen)
    inverse = mechanism(machine.inverse) if machine.inverse else None
    return Mechanism(machine, made, Answers(machine, frames, Balances(frames)), inverse)


def _divisors(value: Expr) -> list[Expr]:
    """Return what an expression divides by, in an order that rests on nothing but itself."""
    return sorted((p.base for p in value.atoms(Pow) if p.exp.is_negative), key=str)


def _components(own: Mechanism) -> list[str]:
    return [c for q in own.words.vocabulary.given() for c in q.components]


def _labels(words: Words, problem: Problem) -> set[str]:
    return {words.sheet.label(s) for s in problem.arguments()}


def _require_unknowns(own: Mechanism, problem: Problem) -> None:
    """Refuse a residual of steady motion that does not change with each of its unknowns."""
    steady = own.scene.steady.get(problem.outputs[0].name)
    if steady is None:
        return
    used = _labels(own.words, problem)
    if missing := [name for name in steady.unknown if name not in used]:
        raise SceneError(
            f"the steady residual must depend on {' and '.join(missing)}, but it does not; "
            "name another steady.unknown, or what vanishes by steady.vanishes"
        )
