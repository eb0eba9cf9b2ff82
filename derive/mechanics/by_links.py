"""The ways that links offer to what moves or drives them, each held against the balances.

Links are solved without the reactions between them. That these do no work is not looked into: a
way that yields other answers than the balances at trial points is none.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from sympy import Expr, Integer, Symbol

from derive.mechanics.absolute_angles import absolute_angles, relative
from derive.mechanics.articulated import articulated
from derive.mechanics.articulated_plane import articulated_plane
from derive.mechanics.beside import reactions
from derive.mechanics.held_together import held_together
from derive.mechanics.implied import Implied, by_passes, by_rows
from derive.mechanics.links import Links
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.probe import NOTHING, PROBES, random_probe
from derive.mechanics.problem import Problem, answered
from derive.mechanics.recursion import driven, recursion
from derive.mechanics.survey import links
from derive.mechanics.words import Words

ARTICULATED = "articulated bodies"
MOST_PAIRS = 45
"""Links that carry others, a chain of ten: beyond, a mass matrix is dearer, and takes long."""
OnTheWay = Mapping[Symbol, Expr]


def by_links(
    mechanism: Mechanism, base: str
) -> Iterator[tuple[str, OnTheWay, Implied | None]]:  # fmt: skip
    """Yield ways to the unknowns of a function: how, values in order, what they stand on before.

    Beside these stands what slopes of the unknowns follow from, where a mass matrix was solved.
    """
    found, sheet = mechanism.lean(base), mechanism.answers.frames.sheet
    problem = found.problem
    held = frozenset(s for e in problem.answers.values() for s in e.free_symbols)
    sought = held & frozenset(problem.unknowns)  # what else balances hold is a reaction
    free = frozenset(sheet.symbols[m.unknown] for m in mechanism.scene.moving if m.free)
    ways: Iterator[tuple[str, OnTheWay, Implied | None]]
    long = False
    if mechanism.scene.constraints:
        names = " ".join(sorted(map(str, sought)))
        every = mechanism.told_once(
            "held together", names, lambda: tuple(held_together(mechanism, sought))
        )
        ways = ((how, own, None) for how, own in every)
    else:
        moved = free if sought and not free.isdisjoint(problem.unknowns) else sought
        machine = links(mechanism.answers.frames, moved)
        beside = reactions(mechanism.answers.balances, moved, sought - moved)
        if machine is None or not machine.links or beside is None:
            return
        if moved not in (machine.free, machine.driving):
            return
        ways = ((how, {**own, **beside}, implied)
                for how, own, implied in _solved(machine, sorted(moved, key=str)))  # fmt: skip
        long = _pairs(machine) > MOST_PAIRS
    known = dict.fromkeys(mechanism.words.hidden, Integer(1)) | dict(found.taken)
    for how, own, implied in ways:
        more = implied.expressions() if implied else ()
        needed = sheet.needed([*own.values(), *problem.answers.values(), *more])
        way = {s: e.xreplace(known) for s, e in {**needed, **own}.items()}
        if _same_answers(mechanism.words, problem, way):
            yield how, way, implied and implied.xreplace(known)
            if how == ARTICULATED and long:
                return


def _solved(
    machine: Links, unknowns: Sequence[Symbol]
) -> Iterator[tuple[str, OnTheWay, Implied | None]]:  # fmt: skip
    if not machine.free:
        yield "recursion", driven(machine), None
        return
    if machine.drives:
        return
    others = [u for u in unknowns if u not in machine.turning]
    if machine.plain:
        yield ARTICULATED, articulated_plane(machine, others) or articulated(machine, others), None
    absolute, system = absolute_angles(machine), recursion(machine)
    for order in _orders(machine, unknowns):
        if absolute is not None:
            own, found = absolute.system.solved(order)
            rows = by_rows(absolute.system, own, found)
            told = absolute.told(rows) if machine.plain else replace(rows, plain=False)
            yield "absolute angles", {**own.definitions, **relative(machine, found)}, told
        own, found = system.solved(order)
        passes = by_passes(machine, own, found)
        yield "recursion", {**own.definitions, **found}, replace(passes, plain=machine.plain)


def _pairs(machine: Links) -> int:
    """Return how many links carry others, each counted for each."""
    return sum(len(machine.path(k)) - 1 for k in range(len(machine.links)))


def _orders(machine: Links, unknowns: Sequence[Symbol]) -> list[tuple[Symbol, ...]]:
    """Return orders to solve in: from the leaves, with what does not turn last or first."""
    leaves = machine.turning
    others = [u for u in unknowns if u not in leaves]
    return list(dict.fromkeys([(*leaves, *others), (*others, *leaves), (*others, *leaves[::-1])]))


def _same_answers(words: Words, problem: Problem, way: OnTheWay) -> bool:
    """Tell whether values yield at trial points what a problem's answers are."""
    for number in range(PROBES):
        probe = random_probe(words, number)
        probe.define(problem.definitions)
        true = answered(problem, probe)
        probe = random_probe(words, number)
        try:
            probe.define(way)
        except ZeroDivisionError:  # by what was put for a mass that does not matter
            return False
        found = [probe.value(e) for e in problem.answers.values()]
        if any(abs(y - x) > NOTHING * max(1, abs(x)) for x, y in zip(true, found, strict=True)):
            return False
    return True
