"""What rounding leaves of a turn to other axes and back: not quite the same vector.

A vector that goes over by a matrix A of rounded entries and comes back by its transpose is changed
by A A^T - 1, by a rounding and always alike: over a million steps lengths drift. The part that is
lacking from the way back is worked out here, and added where nothing rounds it away.
"""

from collections.abc import Sequence

from derive.motion.runge_kutta.compensated import two_product, two_sum
from derive.program.operations import splitter
from derive.program.tape import Number, Tape, number

Rows = Sequence[Sequence[Number]]


def lacking(tape: Tape, rows: Rows) -> list[list[Number]]:
    """Return (3, 3) what the inverse of A has that its transpose has not: -A^T (A A^T - 1).

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
