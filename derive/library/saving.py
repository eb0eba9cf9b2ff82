"""What choosing balances saves: the same answers body by body, about mass centres."""

from collections.abc import Iterator
from dataclasses import dataclass

from derive.library.function import graphed
from derive.library.library import Library
from derive.lower.arrange.matching import UndeterminedError
from derive.lower.arrange.plan import plain_arrangement
from derive.lower.forms import cost
from derive.lower.lower import lower
from derive.mechanics.answers import Answers
from derive.mechanics.balances import Balances
from derive.mechanics.mechanism import Mechanism, dropped
from derive.scene import SceneError
from derive.scene.wanted import JACOBIAN


@dataclass(frozen=True)
class Saving:
    """What a function of a machine does not need, and its operations beside those of plain ones."""

    scene: str
    function: str
    unknowns: tuple[str, ...]
    cancels: tuple[str, ...]
    operations: int
    plain: int | None


def _body_by_body(balances: Balances) -> Balances:
    """Return the balances of single bodies, about their mass centres only."""
    fewer = Balances(balances.frames)
    fewer.rows = tuple(
        row
        for row in balances.rows
        if len(row.balance.bodies) == 1 and (row.balance.kind == "force" or row.balance.central)
    )
    return fewer


def savings(library: Library) -> Iterator[Saving]:
    """Yield what each function of a machine was spared."""
    known = library.known
    for program in library.functions:
        base = program.name.removesuffix(JACOBIAN)
        if base != program.name:
            continue
        found = dropped(known, base)
        balanced = bool(known.question(base).balances)
        yield Saving(
            known.scene.name,
            base,
            found["unknowns left out"] if balanced else (),
            found["cancels"],
            program.flops(),
            _plain(known, base) if balanced else None,
        )


def _plain(known: Mechanism, base: str) -> int | None:
    """Return the operations of a function body by body; None where that does not determine it."""
    known = known.posed(base)
    answers = known.answers
    plain = Answers(answers.machine, answers.frames, _body_by_body(answers.balances))
    try:
        question = plain.question(base)
        way = plain_arrangement(known, question)
    except (SceneError, UndeterminedError):
        return None
    scene = graphed(known)
    hidden = {s: scene.graph.parameter(what) for s, what in known.made.hidden.items()}
    return cost(scene.graph, lower(scene.graph, way, scene.by_symbol() | hidden))[0]
