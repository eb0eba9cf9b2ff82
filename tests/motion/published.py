"""The series of preprocessed discrete Moser-Veselov as it was published, in any arithmetic.

Source: Hairer and Vilmart, J. Phys. A 39 (2006) 13225, section 5, to order ten; so are the names.
"""

from collections.abc import Callable, Sequence
from typing import Any

Rows = tuple[tuple[Any, ...], ...]


def series(moments: Sequence[Any], turned: Sequence[Any]) -> tuple[Any, Any]:
    """Return s and d for moments and the angles (rad) of one step about the axes."""
    N = sum((i * w) ** 2 for i, w in zip(moments, turned, strict=True)) / 2
    H = sum(i * w * w for i, w in zip(moments, turned, strict=True)) / 2
    return 1 + total(rows_of_s(moments), N, H), total(rows_of_d(moments), N, H)


def total(rows: Rows, N: Any, H: Any) -> Any:
    """Return the sum of row k, entry i, times N^(k + 1 - i) H^i."""
    places = ((k, i, value) for k, row in enumerate(rows) for i, value in enumerate(row))
    return sum((value * N ** (k + 1 - i) * H**i for k, i, value in places), N * 0)


def power_sums(moments: Sequence[Any]) -> tuple[list[Any], list[Any]]:
    """Return the sums of the moments' first four powers, and of those of their inverses."""
    s = [sum(i**k for i in moments) for k in (1, 2, 3, 4)]
    x = [sum(1 / i**k for i in moments) for k in (1, 2, 3, 4)]
    return s, x


def mixed(moments: Sequence[Any]) -> Callable[[int, int], Any]:
    """Return X(p, r), the sum of powers p of two moments over the power r of the third."""
    a, b, c = moments
    return lambda p, r: (a**p + b**p) / c**r + (b**p + c**p) / a**r + (c**p + a**p) / b**r


def rows_of_s(moments: Sequence[Any]) -> Rows:
    """Return the coefficients of s - 1, a row an order."""
    a, b, c = moments
    t, X = a * b * c, mixed(moments)
    (s1, s2, s3, s4), (x1, x2, x3, x4) = power_sums(moments)
    return (
        (s1 / (6 * t), -x1 / 3),
        ((s2 / t - x1) / (30 * t), (1 - X(1, 1)) / (30 * t), (3 * s1 / t + 2 * x2) / 60),
        (
            (4 * t + 17 * s3 - 15 * t * X(1, 1)) / (2520 * t**3),
            (9 * s1 + 10 * t * x2 - 6 * X(2, 1)) / (420 * t**2),
            ((6 * X(1, 2) - 100 * x1) * t + 53 * s2) / (2520 * t**2),
            (15 - t * x3 - 2 * X(1, 1)) / (630 * t),
        ),
        (
            (62 * s4 - 94 * t * X(2, 1) + 66 * t**2 * x2 + 81 * t * s1) / (45360 * t**4),
            (-77 * X(3, 1) + 75 * t * X(1, 2) + 214 * s2 - 240 * t * x1) / (22680 * t**3),
            (26 * t * X(2, 2) + 55 * s3 + 204 * t - 50 * t**2 * x3 - 59 * t * X(1, 1))
            / (7560 * t**3),
            (137 * t * x2 - t * X(1, 3) + 3 * s1 - 69 * X(2, 1)) / (11340 * t**2),
            (2 * t**2 * x4 + 5 * t * X(1, 2) - 171 * t * x1 + 159 * s2) / (45360 * t**2),
        ),
    )


def rows_of_d(moments: Sequence[Any]) -> Rows:
    """Return the coefficients of d, a row an order."""
    a, b, c = moments
    t, X = a * b * c, mixed(moments)
    (s1, s2, s3, s4), (x1, x2, x3, _) = power_sums(moments)
    return (
        (-1 / (3 * t), s1 / (6 * t)),
        (-s1 / (60 * t**2), x1 / (10 * t) - s2 / (60 * t**2), -(9 + X(1, 1)) / (60 * t)),
        (
            (34 * t * x1 - 19 * s2) / (2520 * t**3),
            (s3 + 2 * t * X(1, 1) - 85 * t) / (1260 * t**3),
            (47 * s1 + 13 * X(2, 1) - 38 * t * x2) / (2520 * t**2),
            (9 * t * x1 + t * X(1, 2) - 11 * s2) / (1260 * t**2),
        ),
        (
            (60 * t * X(1, 1) - 61 * s3 - 247 * t) / (45360 * t**4),
            (54 * t * s1 - s4 + 218 * t * X(2, 1) - 426 * t**2 * x2) / (45360 * t**4),
            (125 * t * x1 - 5 * X(3, 1) - 130 * s2 + 4 * t * X(1, 2)) / (7560 * t**3),
            (67 * s3 - 735 * t - 15 * t * X(2, 2) + 87 * t * X(1, 1) + 34 * t**2 * x3)
            / (22680 * t**3),
            (165 * s1 - t * X(1, 3) - 9 * X(2, 1) - 145 * t * x2) / (45360 * t**2),
        ),
    )
