"""The derivatives of steps beside differences of the steps themselves, in balls of 500 bits.

A central difference over 2^-130 is wrong by 2^-260 of the third derivative: a slope that differs
from it is wrong. Errors of attitude turn the quaternion from the right, before and after.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, ctx

from derive.library.library import Library
from derive.program.largest import largest
from derive.program.program import Program
from derive.verify.convergence import BITS, unit_attitude
from derive.verify.measure import results

SHIFT = arb(2) ** -130  # exact
GAP = 1e-70
"""A relative difference between what a difference leaves out, 2^-260, and a wrong slope."""
ERROR = "attitude_error_"


@dataclass(frozen=True)
class ComparedSlope:
    """One derivative: by which input, of which output, as returned and as differences give it."""

    row: str
    column: str
    found: float
    gap: float


def slopes(
    library: Library, program: Program, values: Mapping[str, float]
) -> Iterator[ComparedSlope]:
    """Yield every derivative that a step gives, in its pattern or not, beside its difference."""
    ((output, pattern),) = (program.sparsity or {}).items()
    with ctx.workprec(BITS):
        given = unit_attitude(library, {c: arb(x) for c, x in values.items()})
        parts = _attitude(library)
        here = results(library, program, given)
        (quantity,) = (q for q in program.outputs if q.name == output)
        entries = dict(zip(pattern.places(), (here[c] for c in quantity.components), strict=True))
        for k, column in enumerate(pattern.columns):
            above, below = (
                results(library, program, _shifted(given, column, parts, s)) for s in (1, -1)
            )
            apart = [_difference((here, above, below), row, parts) for row in pattern.rows]
            rises = [change / (2 * SHIFT) for change in apart]
            size = largest([1.0, *map(abs, rises)])
            for i, row in enumerate(pattern.rows):
                found = entries.get((i, k), arb(0))
                yield ComparedSlope(row, column, float(found), abs(float(found - rises[i])) / size)


def _attitude(library: Library) -> tuple[str, ...]:
    """Return the components of the quaternion that errors of attitude turn."""
    states = library.vocabulary.states
    return next((q.components for q in states if q.is_quaternion), ())


def _shifted(
    values: Mapping[str, Any], column: str, parts: Sequence[str], sign: int
) -> dict[str, Any]:
    """Return the values with one of them, or the attitude by an error about one axis, shifted."""
    if not column.startswith(ERROR):
        return {**values, column: values[column] + sign * SHIFT}
    axis = "xyz".index(column[-1])
    half = [sign * SHIFT / 2 if k == axis else arb(0) for k in range(3)]
    turned = product([values[part] for part in parts], [arb(1), *half])
    return {**values, **dict(zip(parts, turned, strict=True))}


def _difference(
    ends: tuple[Mapping[str, Any], Mapping[str, Any], Mapping[str, Any]],
    row: str,
    parts: Sequence[str],
) -> Any:
    """Return by how much two results of a step differ, seen from a third one between them."""
    here, above, below = ends
    if not row.startswith(ERROR):
        return above[row] - below[row]
    w, *v = (here[f"{part}_next"] for part in parts)
    change = [above[f"{part}_next"] - below[f"{part}_next"] for part in parts]
    return 2 * product([w, *(-x for x in v)], change)["wxyz".index(row[len(ERROR)])]


def product(p: Sequence[Any], q: Sequence[Any]) -> list[Any]:
    """Return the Hamilton product of two quaternions, scalar first."""
    a, b, c, d = p
    w, x, y, z = q
    return [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
