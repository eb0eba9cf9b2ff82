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
from derive.check.call import c_functions as callable_functions
from derive.check.compiler import CompilerError, compiled, find_compiler

DIGITS, SAMPLES = 60, 400
Form = Callable[[Row, Any], Row]
Functions = Mapping[str, CFunction]


@dataclass(frozen=True)
class Formula:
    """A hard formula: what it is given, the naive form of it, ours, and what it should be."""

    name: str
    naive_says: str
    naive: Form
    ours_says: str
    ours: Callable[[Functions, Row, Any], Row]
    samples: Callable[[random.Random, str], Row]
    true: Callable[[Row], Sequence[Any]]
    bound: float  # in u
    why: str


def formulas(folder: Path) -> Iterator[Hard]:
    """Yield the rows of formulas. Raises ImportError without mpmath and numpy."""
    return rows(FORMULAS, callable_by_precision(emission("formulas"), folder))


def rows(of: Sequence[Formula], called: Mapping[str, Functions]) -> Iterator[Hard]:
    """Yield the row of each formula; the digits of references end with it."""
    import mpmath

    for formula in of:
        with mpmath.workdps(DIGITS):
            naive = {p: (worst_of(formula, formula.naive, p),) for p in PRECISIONS}
            ours = {
                p: (worst_of(formula, partial(formula.ours, own), p),) for p, own in called.items()
            }
        bound = {p: formula.bound * ROUNDOFF[p] for p in PRECISIONS}
        yield Hard(formula.name, "relative", formula.naive_says, naive, formula.ours_says, ours,
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


def worst_of(formula: Formula, form: Form, precision: str) -> float:
    """Return the largest error over the samples, relative to the norm of what it should be.

    A form is given numbers of a type, and every operation of it is rounded to that.
    """
    import numpy as np

    real: Any = np.float32 if precision == "f32" else np.float64
    dice = random.Random(formula.name)
    errors = []
    with np.errstate(all="ignore"):
        for _ in range(SAMPLES):
            given = rounded(formula.samples(dice, precision), precision)
            found = [float(x) for x in form([real(x) for x in given], real)]
            errors.append(_error(found, formula.true(given)))
    return math.nan if any(map(math.isnan, errors)) else max(errors)


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


def _called(named: str, own: Functions, given: Row, _: Any) -> Row:
    (name,) = (a.name for a in own[named].arguments if not a.output)
    (found,) = own[named]({name: [float(x) for x in given]}).values()
    return found


def _formula(name: str, naive_says: str, naive: Form, ours: str, *more: Any) -> Formula:
    """Return a formula of which ours is a function of its own."""
    return Formula(name, naive_says, naive, ours, partial(_called, ours), *more)


FORMULAS = (
    _formula("norm of 1e-200 (double), 1e-25 (float)", "q / sqrt(q . q)", normalised,
             "quaternion_normalise", tiny, true_unit, 4.0, "a few roundings"),
    _formula("norm of 1e200 (double), 1e25 (float)", "q / sqrt(q . q)", normalised,
             "quaternion_normalise", huge, true_unit, 4.0, "a few roundings"),
    _formula("logarithm of a small turn", "2 acos(w) v / sqrt(1 - w^2)", logarithm,
             "quaternion_log", small_turn, true_logarithm, 8.0, "a few roundings"),
    _formula("matrix of nearly half a turn", "from the trace", from_matrix,
             "quaternion_from_matrix", half_turn, true_from_matrix, 8.0,
             "the rounding of the nine entries"),
)  # fmt: skip
