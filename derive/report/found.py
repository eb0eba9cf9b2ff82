"""What a scene's functions cost and how wrong they are, in both forms and both precisions."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from derive.library.library import Library
from derive.program.precision import PRECISIONS, Precision
from derive.program.program import Program
from derive.report.hard import HardCase, cases_of
from derive.report.price import price_of
from derive.scene.wanted import ATTITUDES
from derive.verify.draw import Sampled
from derive.verify.search import Sampling, sampled_at, worst
from derive.verify.stated import at_rows, at_samples

LOOKED = sampled_at(8192)
"""How widely: seconds, not the minutes that stated errors take."""


@dataclass(frozen=True)
class FunctionFigures:
    """One function in one form and one precision.

    flops : + - * / and roots, and a sine as its weight      median, largest : errors in u of the
    largest product in an output's equation, of the output that is worst
    """

    function: str
    form: str
    precision: str
    operations: int
    median: float
    largest: float


def functions_of(library: Library) -> tuple[Program, ...]:
    """Return the functions of a scene that move nothing: the lecture's, and those of attitudes."""
    return (*library.functions, *(p for p in library.motions if p.name in ATTITUDES))


def figures_in_form(
    library: Library, form: str, tell: Callable[[str], None]
) -> Iterator[FunctionFigures]:
    """Yield what the functions of a library cost and how wrong they are."""
    own = functions_of(library)
    only = replace(library, motions=tuple(p for p in own if p not in library.functions))
    for precision in PRECISIONS if own else ():
        tell(f"errors of functions, {form} form, {precision.scalar}")
        yield from _figures(only, form, precision, own, LOOKED)


def _figures(
    library: Library, form: str, precision: Precision, own: Sequence[Program], by: Sampling
) -> Iterator[FunctionFigures]:
    of = Sampled(library, precision)
    found = worst(of, by)
    for program in own:
        mine = [w for w in found if w.function == program.name]
        each = at_rows(of, [w.rows for w in mine], 0)
        errors = [e for one in at_samples(of, program, each) for e in one.largest()]
        yield FunctionFigures(
            program.name, form, precision.name, price_of(program),
            max(w.median for w in mine), max(errors),
        )  # fmt: skip


def hard_cases(
    library: Library, other: Library | None, tell: Callable[[str], None]
) -> tuple[HardCase, ...]:
    """Return the hardest cases of each function that moves nothing."""
    own = functions_of(library)
    only = replace(library, motions=tuple(p for p in own if p not in library.functions))
    found = list[HardCase]()
    for program in own:
        tell(f"hard cases of {program.name}")
        found += cases_of(only, program, other)
    return tuple(found)
