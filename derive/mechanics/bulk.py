"""How mass is spread about a point: its sum, its first moments and its second ones."""

from dataclasses import dataclass

from sympy import Expr, Integer, Matrix, zeros

from derive.mechanics.frames import ZERO


@dataclass(frozen=True)
class Bulk:
    """A mass with its first and second moments about a point, sums of m, m r and m r r^T."""

    mass: Expr
    first: Matrix
    second: Matrix

    def __add__(self, other: "Bulk") -> "Bulk":
        """Return both masses as one."""
        return Bulk(self.mass + other.mass, self.first + other.first, self.second + other.second)

    def moved(self, by: Matrix) -> "Bulk":
        """Return it moved: every mass by the same."""
        offset = self.first * by.T
        second = self.second + offset + offset.T + self.mass * by * by.T
        return Bulk(self.mass, self.first + self.mass * by, second)


NO_BULK = Bulk(Integer(0), ZERO, zeros(3, 3))


def at_point(m: Expr, place: Matrix) -> Bulk:
    """Return a mass that is all at one place."""
    return Bulk(m, m * place, m * place * place.T)
