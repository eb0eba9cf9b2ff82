"""Principal axes against fifty digits, on ordinary tensors and on the hard ones."""

from fractions import Fraction
from math import isclose
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import eigsy, matrix, mp, mpf

from derive import DeriveError
from derive.motion.exact import diagonal
from derive.program.tape import Number, number
from derive.solve.principal import PrincipalAxes, principal_axes

Rows = list[list[float]]
U = 2.0**-53
MOMENTS = 16 * U  # a few roundings of each rotation, five or six sweeps of three
DIRECTIONS = 64 * U  # the same, divided by the gap over the size of the part that was turned


def tensor_of(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> Rows:
    """Return rows; the products enter with minus."""
    return [[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]


def moments_of(tensor: Rows) -> list[mpf]:
    """Return the moments in fifty digits, ascending, beyond what any float rounding reaches."""
    with mp.workdps(50):
        return sorted(eigsy(matrix(tensor), eigvals_only=True))


def residual(tensor: Rows, axes: PrincipalAxes) -> float:
    """Return the largest |I n - moment n|, in fifty digits."""
    with mp.workdps(50):
        return float(
            max(
                abs(sum(mpf(row[k]) * n[k] for k in range(3)) - mpf(moment) * n[i])
                for moment, n in zip(axes.moments, axes.directions, strict=True)
                for i, row in enumerate(tensor)
            )
        )


def are_found(tensor: Rows, scale: float) -> bool:
    """Tell whether moments and directions are right to a few units of rounding of ``scale``."""
    axes = principal_axes(tensor)
    size = max(abs(entry) for row in tensor for entry in row)
    pairs = zip(axes.moments, moments_of(tensor), strict=True)
    moments = all(abs(mpf(found) - right) <= MOMENTS * size for found, right in pairs)
    n = axes.directions
    dots = (
        isclose(sum(a * b for a, b in zip(n[i], n[k], strict=True)), i == k, abs_tol=DIRECTIONS)
        for i in range(3)
        for k in range(3)
    )
    return moments and all(dots) and residual(tensor, axes) <= MOMENTS * scale + 2 * U * size


masses = st.lists(
    st.tuples(*[st.floats(-2, 2) for _ in range(3)], st.floats(0.1, 3)), min_size=4, max_size=7
)


@pytest.mark.long
@settings(max_examples=60)
@given(masses)
def test_the_axes_of_any_cloud_are_found(cloud: list[tuple[float, float, float, float]]) -> None:
    sums = [
        sum(m * (y * y + z * z) for x, y, z, m in cloud),
        sum(m * (z * z + x * x) for x, y, z, m in cloud),
        sum(m * (x * x + y * y) for x, y, z, m in cloud),
        sum(m * x * y for x, y, z, m in cloud),
        sum(m * x * z for x, y, z, m in cloud),
        sum(m * y * z for x, y, z, m in cloud),
    ]
    assert are_found(tensor_of(*sums), max(abs(each) for each in sums))


@pytest.mark.parametrize("small", [1e-4, 1e-8, 1e-11])
def test_nearly_equal_moments_keep_accurate_directions(small: float) -> None:
    xx, yy, zz = 1 + small, 1 - 2 * small, 1.0
    tensor = tensor_of(xx, yy, zz, 0.3 * small, -0.7 * small, 0.2 * small)
    axes = principal_axes(tensor)
    rest = [[tensor[i][k] - (i == k) for k in range(3)] for i in range(3)]
    with mp.workdps(50):
        _, exact = eigsy(matrix(rest))
        for n in axes.directions:
            best = max(abs(sum(exact[i, k] * n[i] for i in range(3))) for k in range(3))
            assert 1 - best < DIRECTIONS
    assert are_found(tensor, small)


@pytest.mark.parametrize("ratio", [1e-3, 1e-6, 1e-9, 1e-12])
def test_the_moment_of_a_thin_rod_about_itself_keeps_its_relative_accuracy(ratio: float) -> None:
    axes = principal_axes(tensor_of(1.0, 1.0 + ratio / 3, ratio, 0.1, ratio / 7, ratio / 9))
    right = moments_of(tensor_of(1.0, 1.0 + ratio / 3, ratio, 0.1, ratio / 7, ratio / 9))
    for found, exact in zip(axes.moments, right, strict=True):
        assert abs(mpf(found) / exact - 1) <= MOMENTS


@pytest.mark.parametrize("small", [5e-324, 1e-155, 2e-16])
def test_tiny_products_are_turned_away_by_short_numbers(small: float) -> None:
    tensor = tensor_of(1.0, 2.0, 3.0, small, small, small)
    assert are_found(tensor, 3.0)
    every = [1, 2, 3, *[small] * 3, *(i == k for i in range(3) for k in range(3))]
    values: list[Number] = [number(Fraction(x)) for x in every]
    for _ in range(diagonal.PASSES):
        values = diagonal._pass(values)
    longest = max((x.exact or Fraction(0)).denominator.bit_length() for x in values)
    assert longest <= diagonal.NOTHING + diagonal.BITS + 1


def test_a_sphere_has_any_axes_and_one_moment() -> None:
    axes = principal_axes(tensor_of(0.4, 0.4, 0.4, 0.0, 0.0, 0.0))
    assert axes.moments == (0.4, 0.4, 0.4)
    assert axes.directions == ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def test_the_triad_is_right_handed() -> None:
    x, y, z = principal_axes(tensor_of(3.0, 1.0, 2.0, 0.1, 0.2, 0.3)).directions
    assert x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) + x[2] * (
        y[0] * z[1] - y[1] * z[0]
    ) == pytest.approx(1.0)


def test_a_tensor_that_is_not_symmetric_is_refused() -> None:
    with pytest.raises(ValueError, match=r"inertia tensor: must be symmetric, but 1.0 faces 2.0"):
        principal_axes([[1, 1, 0], [2, 1, 0], [0, 0, 1]])


@pytest.mark.parametrize(
    ("tensor", "says"),
    [
        ([[1, 0], [0, 1]], r"must have the shape \(3, 3\), .* not \(2, 2\)"),
        ([[[1, 0, 0], [0, 1, 0], [0, 0, 1]]] * 2, r"must be one, of the shape"),
        ([["1", 0, 0], [0, 1, 0], [0, 0, 1]], "must be an array of real numbers"),
        (None, "must be an array of real numbers, not None"),
    ],
)
def test_what_is_no_tensor_is_refused(tensor: Any, says: str) -> None:
    with pytest.raises(DeriveError, match=says):
        principal_axes(tensor)


def test_a_tensor_that_is_not_finite_is_refused() -> None:
    with pytest.raises(ValueError, match="inertia tensor: must be finite"):
        principal_axes([[float("inf"), 0, 0], [0, 1, 0], [0, 0, 1]])
