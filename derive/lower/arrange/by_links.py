"""The ways that a machine's links offer, each held against the balances at trial points.

Links are solved without the reactions between them. That these do no work is not looked into: a
way that yields other answers than the balances is none.
"""

from collections.abc import Iterator
from dataclasses import replace

from derive.lower.arrange.absolute_angles import AbsoluteAngles, orders, solved
from derive.lower.arrange.arrangement import Arrangement, Definition
from derive.mechanics.links import links
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.probe import NOTHING, PROBES, random_probe
from derive.mechanics.problem import Problem, answered
from derive.mechanics.words import Words


def by_links(mechanism: Mechanism, base: str) -> Iterator[Arrangement]:
    """Yield the ways to compute answers by the accelerations of links about parallel axes."""
    found, frames = mechanism.lean(base), mechanism.answers.frames
    problem, sheet = found.problem, frames.sheet
    machine = links(frames, frozenset(problem.unknowns))
    if machine is None or machine.unknowns != {*problem.unknowns}:
        return
    system = AbsoluteAngles(machine)
    for order in orders(machine, problem.unknowns):
        own = solved(system, order)
        needed = sheet.needed([*(d.value for d in own), *problem.answers.values()])
        before = [Definition("let", s, value) for s, value in needed.items()]
        definitions = tuple(
            replace(d, value=d.value.xreplace(found.taken)) for d in (*before, *own)
        )
        way = Arrangement(definitions, tuple(problem.answers.values()))
        if same_answers(mechanism.words, problem, way):
            yield way


def same_answers(words: Words, problem: Problem, way: Arrangement) -> bool:
    """Tell whether definitions yield at trial points what a problem's answers are."""
    for number in range(PROBES):
        probe = random_probe(words, number)
        probe.define(problem.definitions)
        true = answered(problem, probe)
        probe = random_probe(words, number)
        probe.define({d.symbol: d.value for d in way.definitions})
        if any(
            abs(probe.value(e) - x) > NOTHING * max(1, abs(x))
            for e, x in zip(way.outputs, true, strict=True)
        ):
            return False
    return True
