"""What a scene's functions cost and how wrong they are, in both forms and both precisions."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from derive.library.library import Library
from derive.program.precision import PRECISIONS, Precision
from derive.program.program import Program
from derive.report.hard import HardCase, cases_of
from derive.report.price import price_of
from derive.report.wishes import OTHER_FORM
from derive.scene.wanted import ATTITUDES
from derive.verify.draw import Sampled
from derive.verify.search import Sampling, sampled_at, worst
from derive.verify.stated import at_rows, at_samples

LOOKED = sampled_at(8192)
"""How widely: seconds, not the minutes that stated errors take."""


@dataclass(frozen=True)
class FunctionFigures:
    """One function in one form and one precision.

    weighted_operations : as ``price_of`` says        median, largest : errors in u of the
    largest product in an output's equation, of the output that is worst
    """

    function: str
    form: str
    precision: str
    weighted_operations: int
    median: float
    largest: float


def functions_of(library: Library) -> tuple[Program, ...]:
    """Return the functions of a scene that move nothing: the lecture's, and those of attitudes."""
    return (*library.functions, *(p for p in library.motions if p.name in ATTITUDES))


def found_of(
    library: Library, other: Library | None
) -> tuple[tuple[FunctionFigures, ...], tuple[HardCase, ...]]:
    """Return figures of a scene's functions that move nothing, in both forms, and hard cases.

    other : the library of the other form, None if there is none
    """
    form, own = library.scene.form, functions_of(library)
    figures = [*figures_in_form(library, form)]
    if other is not None:
        figures += figures_in_form(other, OTHER_FORM[form])
    only = _alone(library)
    return tuple(figures), tuple(case for p in own for case in cases_of(only, p, other))


def figures_in_form(library: Library, form: str) -> Iterator[FunctionFigures]:
    """Yield what the functions of a library cost and how wrong they are."""
    own = functions_of(library)
    for precision in PRECISIONS if own else ():
        yield from _figures(_alone(library), form, precision, own, LOOKED)


def _alone(library: Library) -> Library:
    """Return a library without what moves something."""
    own = functions_of(library)
    return replace(library, motions=tuple(p for p in own if p not in library.functions))


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
