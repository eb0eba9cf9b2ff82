"""Single turns about axes: their matrices, and sines and cosines brought to one form."""

from math import inf

from sympy import Expr, Integer, Matrix, Pow, cos, eye, sin, zeros

from derive.lecture.polynomial import Multiplied, NotAPolynomialError
from derive.lecture.stated import by_law

ADDED = "angular_velocities_add"
PLACE = {"x": 0, "y": 1, "z": 2}


def unit_vector(axis: str) -> Matrix:
    """Return the unit vector of an axis.

    >>> unit_vector("y").T
    Matrix([[0, 1, 0]])
    """
    return Matrix([Integer(axis == name) for name in PLACE])


def turn_matrix(axis: str, angle: Expr) -> Matrix:
    """Return R that takes components along turned axes to components along the old ones.

    >>> from sympy import Symbol
    >>> turn_matrix("z", Symbol("a"))[0, 1]
    -sin(a)
    """
    k = PLACE[axis]
    i, j = (k + 1) % 3, (k + 2) % 3
    R = eye(3)
    R[i, i] = R[j, j] = cos(angle)
    R[j, i], R[i, j] = sin(angle), -sin(angle)
    return R


def reduced(expression: Expr, most: float = inf) -> Expr:
    """Return ``expression`` multiplied out, with sin^2 = 1 - cos^2.

    A polynomial stays as it is if that makes more than so many terms of it.

    >>> from sympy import Symbol
    >>> a = Symbol("a")
    >>> reduced(sin(a) ** 3 + sin(a) * cos(a) ** 2)
    sin(a)
    """
    by = Multiplied()
    try:
        terms = by.without_squared_sines(by.of(expression))
        return by.written(terms) if len(terms) <= most else expression
    except NotAPolynomialError:
        pass
    lowered = expression.expand().replace(
        lambda e: isinstance(e, Pow) and isinstance(e.base, sin) and e.exp.is_Integer and e.exp > 1,
        lambda e: (1 - cos(e.base.args[0]) ** 2) ** (e.exp // 2) * e.base ** (e.exp % 2),
    )
    return lowered.expand()


def angular_velocities_summed(R: Matrix, first: Matrix, own: Matrix) -> Matrix:
    """Return the angular velocity of axes by that of their parent and their own in it."""
    if first == zeros(3, 1):
        return own
    return by_law(ADDED, {"R_2": R, "Omega": first, "Omega_2": own})
