"""A pivot is a pole where it vanishes, and nowhere else, however sizes of its terms grow."""

import numpy as np
import pytest
from sympy import Expr, Matrix, cos, symbols

from derive.lower.arrange.pivots import Pivots
from derive.mechanics.box import Box
from derive.mechanics.probe import Probe

x, first, second = symbols("x first second")


def pivots(of_x: Expr) -> Pivots:
    """Return those on named quantities, one the cube of what the other is of x in [0, 1]."""
    ends = np.zeros(1), np.ones(1)
    box = Box((x,), ("x",), *ends, (False,), frozenset(), ())
    return Pivots(box, Probe({}), {first: of_x, second: first**3}, str)


@pytest.mark.parametrize(
    ("of_x", "outcome"),
    [(100 * cos(x / 20) - 99, "regular"), (100 * cos(x / 5) - 99, "pole"), (3 * x - 1, "pole")],
)
def test_sizes_that_multiply_from_one_name_to_the_next_make_no_pole(
    of_x: Expr, outcome: str
) -> None:
    vanishes = pivots(of_x).vanish(Matrix([[second]]), [(0, 0)])
    assert vanishes == (outcome == "pole")
