"""Ordinary and hard attitudes: tiny, huge, turned by 180 degrees, locked, and next to all that."""

from collections.abc import Sequence
from itertools import permutations, product

import numpy as np

from tests.motion.attitude.measured import Rows

COMMON = (1e-40, 1e-25, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e18, 1e25, 2e38)
WIDE = (1e-320, 1e-310, 1e-200, 1e-160, 1e100, 1e155, 1e200, 1e307)
NEAR = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12, 1e-25, 1e-40)


def scales(dtype: type) -> tuple[float, ...]:
    """Return sizes from the smallest denormal to nearly the largest float."""
    info = np.finfo(dtype)
    ends = (float(info.smallest_subnormal), 3 * float(info.tiny), float(info.max))
    return (*ends, *COMMON, *(WIDE if dtype is np.float64 else ()))


def rows(values: Sequence[Sequence[float]], dtype: type) -> Rows:
    """Return samples in a precision, without those that overflow there or are zero."""
    with np.errstate(over="ignore"):
        found = np.array(values, np.float64).astype(dtype)
    return found[np.all(np.isfinite(found), axis=1) & np.any(found != 0, axis=1)]


def directions(size: int, dtype: type) -> Rows:
    """Return vectors along the axes and between them, and some others."""
    dice = np.random.default_rng(size)
    plain = [d for d in product((-1, 0, 1), repeat=size) if any(d)][::3]
    return rows([*plain, *dice.uniform(-1, 1, (40, size))], dtype)


def of_any_length(size: int, dtype: type) -> Rows:
    """Return vectors of every scale."""
    some = directions(size, np.float64)
    with np.errstate(over="ignore"):
        every = [some[n::3] * s for n, s in enumerate(scales(dtype) * 2)]
    return rows(np.concatenate(every), dtype)


def of_mixed_scales(dtype: type) -> Rows:
    """Return quaternions whose scalar and vector part are of different scales."""
    every = [
        (sign * s, t, -0.7 * t, 0.3 * t)
        for s in scales(dtype)
        for t in scales(dtype)
        for sign in (1, -1)
    ]
    return rows(every, dtype)


def units(dtype: type, count: int = 120) -> Rows:
    """Return ordinary unit quaternions, rounded."""
    q = np.random.default_rng(5).normal(size=(count, 4))
    return (q / np.linalg.norm(q, axis=1)[:, None]).astype(dtype)


def hard_units(dtype: type) -> Rows:
    """Return unit quaternions of no turn, of half turns, quarter turns and thirds, and next to."""
    dice = np.random.default_rng(7)
    corners = {
        tuple(s * c for s, c in zip(signs, corner, strict=True))
        for shape in ((1, 0, 0, 0), (1, 1, 0, 0), (1, 1, 1, 1))
        for corner in permutations(shape)
        for signs in product((1, -1), repeat=4)
    }
    base = [np.array(c) / np.linalg.norm(c) for c in sorted(corners)]
    near = [
        b + d * kick
        for b in base
        for d in dice.choice(NEAR, 3, replace=False)
        for kick in (dice.normal(size=4), np.eye(4)[dice.integers(4)])
    ]
    q = np.array([*base, *near])
    return (q / np.linalg.norm(q, axis=1)[:, None]).astype(dtype)


def vectors(count: int, dtype: type) -> Rows:
    return np.random.default_rng(11).normal(size=(count, 3)).astype(dtype)


def rotation_vectors(dtype: type) -> Rows:
    """Return rotation vectors up to the root of 1/u rad, whole turns and half turns among them."""
    limit = 2.0**25 if dtype is np.float64 else 2.0**11
    some = directions(3, np.float64)
    sizes = [s for s in (*scales(dtype), 2.0**-30, 2.0**-29, 0.1, 10.0, limit) if s <= limit]
    turns = [(n * np.pi * (1 + e), e, -e) for n in (1, 2, 3, 4) for e in (0, 1e-12, 1e-7, -1e-3)]
    return rows(
        [*turns, *np.concatenate([some[n % 2 :: 2] * s for n, s in enumerate(sizes)])], dtype
    )
