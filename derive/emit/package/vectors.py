"""Reference vectors: inputs on the declared ranges, and the bits that every function gives there.

They come from the programs that the C is printed from, replayed in floats of its precision.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from derive.library.library import Library
from derive.program.arithmetic import LIBM, TURNS
from derive.program.own_sine import FITTED
from derive.program.precision import Precision
from derive.program.program import Program, component_names
from derive.verify.columns import Plan, Supplied, arithmetics, in_columns
from derive.verify.draw import Dice, Sampled, complete, drawn
from derive.verify.operators import Column

VECTORS = 20
DRAWN = 64
"""Samples of which the first are taken at which every function gives numbers."""
SMALL = (1.5694008 * 2.0**-33, 1.9551697 * 2.0**-33, 1.0071509 * 2.0**-33)
"""Numbers whose difference from 1 libgcc's doubles for a Cortex-M3 or M4 may get wrong."""


@dataclass(frozen=True)
class BitsOf:
    """What functions are given and give, by component: bits, of each vector a row.

    exact : functions of which every bit must be so; the others call the C library's arctangent, or
            its sines of large angles
    """

    given: Mapping[str, list[str]]
    returned: Mapping[str, list[list[str]]]
    exact: frozenset[str]


def bits_at(library: Library, precision: Precision) -> BitsOf:
    """Return the reference vectors of a scene in one precision."""
    of = Sampled(library, precision)
    seed = f"derive: {library.scene.name} {precision.name} package"
    rows = drawn(of, Dice(seed), DRAWN)
    for name, x in library.fixed.items():
        rows[of.names.index(name)] = x
    at = complete(of, rows)
    plans = {plan.program.name: plan for plan in (of.setup, *of.plans)}
    found = {
        program.name: _returned(plans[program.name], at, precision) for program in library.in_c()
    }
    finite = np.all([np.isfinite(c) for each in found.values() for c in each], axis=0)
    taken = np.flatnonzero(np.broadcast_to(finite, (DRAWN,)))[:VECTORS]
    given = {c for p in library.in_c() for c in _given(p)}
    return BitsOf(
        {name: bits(at.own[name][taken], precision) for name in at.own if name in given},
        {
            name: by_vector([bits(column[taken], precision) for column in each])
            for name, each in found.items()
        },
        frozenset(p.name for p in library.in_c() if is_exact(p, plans, at, precision)),
    )


def is_exact(
    program: Program, plans: Mapping[str, Plan], at: Supplied, precision: Precision
) -> bool:
    """Tell whether a function has the same bits wherever + - * / and roots are IEEE's."""
    if program.makes("constants") or program.arithmetic == "pairs":
        return True
    if not TURNS & {*program.count}:
        return not LIBM & {*program.count}
    angles, own = list[Column](), arithmetics(precision.dtype).own
    watched = {name: _watched(angles, own[name]) for name in TURNS}
    with np.errstate(all="ignore"):
        in_columns(plans[program.name], {**own, **watched}, at.own)
    most = max(float(np.max(np.abs(x))) for x in angles)
    return not LIBM & {*program.count} and most <= FITTED[precision.bits].largest


def _watched(angles: list[Column], sine: Callable[[Column], Column]) -> Callable[[Column], Column]:
    def seen(x: Column) -> Column:
        angles.append(x)
        return sine(x)

    return seen


def by_vector(columns: Sequence[Sequence[str]]) -> list[list[str]]:
    """Return columns as rows.

    >>> by_vector(["ab", "cd"])
    [['a', 'c'], ['b', 'd']]
    """
    return [list(row) for row in zip(*columns, strict=True)]


def _given(program: Program) -> list[str]:
    return [c for q in program.inputs if q.role != "constants" for c in q.components]


def _returned(plan: Plan, at: Supplied, precision: Precision) -> list[Column]:
    """Return the columns that a program gives; those of set-up are made already."""
    program, by = plan.program, arithmetics(precision.dtype)
    if program.makes("constants"):
        return [at.own[c] for c in component_names(program)]
    with np.errstate(all="ignore"):
        if program.arithmetic == "pairs":
            pairs = {name: (x, x * 0) for name, x in at.own.items()}
            found = [x[0] for x in in_columns(plan, by.made, pairs)]
        else:
            found = in_columns(plan, by.own, at.own)
    return [np.broadcast_to(x, (DRAWN,)).astype(precision.dtype) for x in found]


def bits(column: Column, precision: Precision) -> list[str]:
    """Return the bits of floats as C writes them.

    >>> from derive.program.precision import F32
    >>> bits(np.array([1.0, -0.0]), F32)
    ['0x3F800000U', '0x80000000U']
    """
    size = precision.dtype().itemsize
    kind, end = (np.uint32, "U") if size == 4 else (np.uint64, "ULL")
    whole = np.ascontiguousarray(column.astype(precision.dtype)).view(kind)
    return [f"0x{int(x):0{2 * size}X}{end}" for x in whole]
