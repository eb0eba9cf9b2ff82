"""What choosing balances saves: the same answers body by body, about mass centres."""

from collections.abc import Iterator
from dataclasses import dataclass

from derive.library.function import graphed
from derive.library.library import Library
from derive.lower.arrange.matching import UndeterminedError
from derive.lower.arrange.plan import plain_arrangement
from derive.lower.forms import cost
from derive.lower.lower import lower
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


def savings(library: Library) -> Iterator[Saving]:
    """Yield what each function of a machine was spared."""
    mechanism = library.mechanism
    for program in library.functions:
        base = program.name.removesuffix(JACOBIAN)
        if base != program.name:
            continue
        found = mechanism.dropped(base)
        balanced = bool(mechanism.whole(base).balances)
        yield Saving(
            library.scene.name,
            base,
            found["unknowns left out"] if balanced else (),
            found["cancels"],
            program.flops(),
            _plain(library, base) if balanced else None,
        )


def _plain(library: Library, base: str) -> int | None:
    """Return the operations of a function body by body; None where that does not determine it."""
    plain = library.mechanism.posed(base).body_by_body
    try:
        way = plain_arrangement(plain, plain.whole(base))
    except (SceneError, UndeterminedError):
        return None
    terms = graphed(plain)
    hidden = {s: terms.graph.parameter(what) for s, what in plain.words.hidden.items()}
    return cost(terms.graph, lower(terms.graph, way, terms.by_symbol() | hidden))[0]
