"""The axes a, b, c along which a body's tensor is diagonal, b with the intermediate moment."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.motion.exact.diagonal import diagonalised
from derive.motion.exact.inertia import Inertia
from derive.program.operations import at_most, both, either, select, splitter
from derive.program.pairs import two_product, two_sum
from derive.program.tape import Number, Tape, Vector, named, number, seen_from

Change = Callable[[Vector], list[Number]]


@dataclass(frozen=True)
class BodyAxes:
    """Moments about a, b, c, and how a vector goes from the axes x, y, z to these and back.

    unit : kg m^2, what the moments are measured in
    rows : the axes a, b, c along x, y, z where they are turned; none where they are x, y, z
    """

    moments: list[Number]
    unit: Number
    along: Change
    back: Change
    rows: tuple[Vector, ...] = ()


def axes_of(tape: Tape, body: Inertia) -> BodyAxes:
    """Return the axes of a body; ``tape`` is that of the function in which vectors change."""
    match body.kind:
        case "general":
            return principal_body_axes(body)
        case "spherical":
            return counted_from(0, body)
        case "axisymmetric":
            return counted_from(body.places[0], body)
    return _chosen(tape, body)


def counted_from(first: int, body: Inertia) -> BodyAxes:
    """Return the axes x, y, z counted round from the one that is a; c is then a body's own."""

    def along(v: Vector) -> list[Number]:
        return [v[(first + i) % 3] for i in range(3)]

    def back(v: Vector) -> list[Number]:
        return [v[(i - first) % 3] for i in range(3)]

    return BodyAxes(along(body.tensor[:3]), number(1), along, back)


def _chosen(tape: Tape, body: Inertia) -> BodyAxes:
    """Return the axes where parameters decide which is which: two flags of set-up."""
    x, y, z = body.tensor[:3]
    tests = []
    for axis, order in (("x", (x, y, z)), ("y", (y, z, x))):
        says = f"1 where the axis after {axis} has the intermediate moment, else 0"
        tests.append(_flag(tape, f"from_{axis}", _between(*order), says))
    (at_x, hot_x), (at_y, hot_y) = tests

    def choice(is_x: Number, is_y: Number, v: Vector, step: int) -> list[Number]:
        cases = [[v[(i + step * first) % 3] for i in range(3)] for first in range(3)]
        return [select(is_x, p, select(is_y, q, r)) for p, q, r in zip(*cases, strict=True)]

    return BodyAxes(
        choice(at_x, at_y, body.tensor[:3], 1),
        number(1),
        lambda v: choice(hot_x, hot_y, v, 1),
        lambda v: choice(hot_x, hot_y, v, -1),
    )


def _flag(tape: Tape, name: str, truth: Number, says: str) -> tuple[Number, Number]:
    """Return a truth of set-up, and the same for a function: set-up hands on numbers only."""
    if truth.exact is not None:
        return truth, truth
    flag = named(name, select(truth, 1, 0), says)
    return truth, Number(tape, tape.record("less", (Fraction(0), seen_from(tape, flag))))


def _between(p: Number, q: Number, r: Number) -> Number:
    """Return the truth of q being between p and r."""
    return either(both(at_most(p, q), at_most(q, r)), both(at_most(r, q), at_most(q, p)))


def principal_body_axes(body: Inertia) -> BodyAxes:
    """Return the principal axes of any tensor, the smallest moment first."""
    found = diagonalised(body)
    rows = [
        [
            named(f"axis_{a}_{x}", entry, f"component along {x} of the principal axis {a}")
            for x, entry in zip("xyz", row, strict=True)
        ]
        for a, row in zip("abc", found.axes, strict=True)
    ]
    xx, yy, zz = body.tensor[:3]
    unit = (xx + yy + zz) / (found.moments[0] + found.moments[1] + found.moments[2])
    columns = [[row[i] for row in rows] for i in range(3)]
    return BodyAxes(
        list(found.moments),
        unit,
        lambda v: times(rows, v),
        lambda v: times(columns, v),
        tuple(rows),
    )


def times(rows: Sequence[Vector], v: Vector) -> list[Number]:
    """Return the product of a matrix and a vector."""
    return [row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in rows]


def lacking(tape: Tape, rows: Sequence[Vector]) -> list[list[Number]]:
    """Return (3, 3) what the inverse of A has that its transpose has not: -A^T (A A^T - 1).

    A vector that goes over by A of rounded entries and comes back by its transpose is changed by
    A A^T - 1, by a rounding and always alike: over a million steps lengths drift. What is lacking
    from the way back is added where nothing rounds it away.
    rows : A as a function reads it, three unit vectors but for their rounding
    """
    one = splitter(tape) / splitter(tape)  # an exact entry times one is that entry, rounded
    held = [[one * entry for entry in row] for row in rows]
    left = [[_left(tape, p, q, int(p is q)) for q in held] for p in held]
    return [
        [-(column[0] * e[0] + column[1] * e[1] + column[2] * e[2]) for e in left]
        for column in zip(*held, strict=True)
    ]


def _left(tape: Tape, p: Sequence[Number], q: Sequence[Number], whole: int) -> Number:
    """Return p . q less a whole number, to twice the digits (Ogita, Rump and Oishi 2005)."""
    total, errors = number(-whole), number(0)
    for a, b in zip(p, q, strict=True):
        product, error = two_product(a, b, splitter(tape))
        total, lost = two_sum(total, product)
        errors = errors + (error + lost)
    return total + errors
