"""Hard cases of single formulas: norms, logarithms, half turns.

References are worked out in 60 digits from the very floats that the functions were given.
"""

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from bench.motion.ours import Emission, emission
from bench.motion.wrong import ROUNDOFF
from bench.report.case_run import PRECISIONS
from bench.report.formula_samples import (
    Row,
    from_matrix,
    half_turn,
    huge,
    logarithm,
    normalised,
    small_turn,
    tiny,
    true_from_matrix,
    true_logarithm,
    true_unit,
)
from bench.report.hard import Hard
from derive.check.call import CFunction
from derive.check.call import functions as callable_functions
from derive.check.compiler import CompilerError, compiled, find_compiler

DIGITS, SAMPLES = 60, 400
Form = Callable[[Row, Any], Row]


@dataclass(frozen=True)
class Formula:
    """A hard formula: what it is given, the naive form of it, ours, and what it should be."""

    name: str
    measure: str
    naive_says: str
    naive: Form
    ours: str
    samples: Callable[[random.Random, str], Row]
    true: Callable[[Row], Sequence[Any]]
    bound: float  # in u
    why: str


def formulas(folder: Path) -> Iterator[Hard]:
    """Yield the rows of formulas. Raises ImportError without mpmath and numpy."""
    called = callable_by_precision(emission("formulas"), folder)
    for formula in FORMULAS:
        yield _row(formula, called)


def _row(formula: Formula, called: Mapping[str, Mapping[str, CFunction]]) -> Hard:
    """Return the row of a formula; the digits of references end with it."""
    import mpmath

    with mpmath.workdps(DIGITS):
        naive = {p: (_largest(formula, partial(_plain, formula.naive, p), p),) for p in PRECISIONS}
        ours = {
            p: (_largest(formula, partial(_ours, own[formula.ours]), p),)
            for p, own in called.items()
            if formula.ours in own
        }
    bound = {p: formula.bound * ROUNDOFF[p] for p in PRECISIONS}
    return Hard(formula.name, formula.measure, formula.naive_says, naive, formula.ours, ours,
                bound, formula.why)  # fmt: skip


def callable_by_precision(made: Emission, folder: Path) -> Mapping[str, Mapping[str, CFunction]]:
    """Return the functions of a scene, compiled, by precision; none without a compiler."""
    found = {}
    for precision in PRECISIONS:
        try:
            source = made.manifest["files"][precision]["source"]
            texts = {n: t for n, t in made.texts.items() if n.endswith((".c", ".h"))}
            library = compiled(texts, source, folder / "formulas", find_compiler())
        except CompilerError:
            continue
        found[precision] = callable_functions(made.manifest, library, precision)
    return found


def _largest(formula: Formula, form: Callable[[Row], Row], precision: str) -> float:
    """Return the largest error over the samples, relative to the norm of what it should be."""
    dice = random.Random(formula.name)
    worst = 0.0
    for _ in range(SAMPLES):
        given = rounded(formula.samples(dice, precision), precision)
        error = _error(form(given), formula.true(given))
        worst = error if math.isnan(error) else max(worst, error)
        if math.isnan(worst):
            return worst
    return worst


def _error(found: Row, true: Sequence[Any]) -> float:
    import mpmath

    if not all(map(math.isfinite, found)):
        return math.nan
    apart = mpmath.norm([mpmath.mpf(a) - b for a, b in zip(found, true, strict=True)])
    return float(apart / mpmath.norm(list(true)))


def rounded(values: Row, precision: str) -> Row:
    """Return numbers as a precision holds them."""
    import numpy as np

    return [float(np.float32(x)) for x in values] if precision == "f32" else values


def _plain(naive: Form, precision: str, given: Row) -> Row:
    """Return what a naive form makes of numbers of a type, every operation rounded to it."""
    import numpy as np

    real: Any = np.float32 if precision == "f32" else np.float64
    with np.errstate(all="ignore"):
        return [float(x) for x in naive([real(x) for x in given], real)]


def _ours(function: CFunction, given: Row) -> Row:
    (name,) = (a.name for a in function.arguments if not a.output)
    (found,) = function({name: given}).values()
    return found


FORMULAS = (
    Formula("norm of 1e-200 (double), 1e-25 (float)", "relative", "q / sqrt(q . q)", normalised,
            "quaternion_normalise", tiny, true_unit, 4.0, "a few roundings"),
    Formula("norm of 1e200 (double), 1e25 (float)", "relative", "q / sqrt(q . q)", normalised,
            "quaternion_normalise", huge, true_unit, 4.0, "a few roundings"),
    Formula("logarithm of a small turn", "relative", "2 acos(w) v / sqrt(1 - w^2)", logarithm,
            "quaternion_log", small_turn, true_logarithm, 8.0, "a few roundings"),
    Formula("matrix of nearly half a turn", "relative", "from the trace", from_matrix,
            "quaternion_from_matrix", half_turn, true_from_matrix, 8.0,
            "the rounding of the nine entries"),
)  # fmt: skip
