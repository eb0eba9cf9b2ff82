"""A quaternion's rotation and rate without a matrix, by cross products.

Where an attitude has w = 1 and x = y = z = 0 nothing is turned; so a column that a quaternion turns
shows what is turned, and its rate shows omega / 2. Lecture steps "rotation_of_vector",
"quaternion_rate_scalar" and "quaternion_rate_vector" say the rest.
"""

from sympy import Integer, Matrix, zeros

from derive.lecture.stated import by_law
from derive.lower.arrange.column import NamedColumns

LONGEST = 150  # operations of a column that is multiplied out


def turned_by_quaternion(column: Matrix, columns: NamedColumns) -> Matrix | None:
    """Return a column that some attitude turns, or turns back, as v + w t + q x t, t = 2 q x v."""
    for q in columns.quaternions:
        w, axis = q[0], Matrix(q[1:])
        if not all(e.has(*q) and e.count_ops() <= LONGEST for e in column):
            continue
        v = _with_none_turned(column, q)
        for turned in (w, -w):
            made = by_law("rotation_of_vector", {"q_w": turned, "q_v": axis, "v": v})
            if (made - column).expand() == zeros(3, 1):
                v = columns.column("v", v)
                t = columns.column("t", columns.column("d", 2 * axis).cross(v))
                return v + turned * t + axis.cross(t)
    return None


def _with_none_turned(column: Matrix, q: Matrix) -> Matrix:
    return column.xreplace(dict(zip(q, map(Integer, (1, 0, 0, 0)), strict=True)))


def quaternion_rate(parts: Matrix, columns: NamedColumns) -> Matrix | None:
    """Return four components that are the rate of some attitude as q (0, omega / 2)."""
    for q in columns.quaternions:
        if not parts.has(*q):
            continue
        w, axis = q[0], Matrix(q[1:])
        half = Matrix(_with_none_turned(parts, q)[1:])
        law = {"q_w": w, "q_v": axis, "omega": 2 * half}
        scalar, vector = (by_law(f"quaternion_rate_{part}", law) for part in ("scalar", "vector"))
        if (Matrix([scalar, *vector]) - parts).expand() == zeros(4, 1):
            half = columns.column("half", half)
            return Matrix([-axis.dot(half), *(w * half + axis.cross(half))])
    return None
