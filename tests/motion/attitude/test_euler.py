"""Twelve sequences of Euler angles keep their promise, at gimbal lock and next to it too."""

from functools import partial

import flint
import numpy as np
import pytest

from derive.scene.wanted import SEQUENCES
from tests.made import thinned
from tests.motion.attitude import cases, truth
from tests.motion.attitude.measured import PRECISIONS, UNIT, Rows, called, error, errors, promise
from tests.motion.attitude.truth import plain

both = pytest.mark.parametrize("dtype", PRECISIONS)
each = pytest.mark.parametrize("sequence", thinned(SEQUENCES, 5))


def locked(sequence: str, q: Rows) -> np.ndarray:
    """Tell which attitudes are gimbal lock exactly: first and third turn about one line."""
    i, j, k = (1 + "xyz".index(axis) for axis in sequence)
    if i == k:
        k = 6 - i - j
        return ~np.any(q[:, [0, i]], axis=1) | ~np.any(q[:, [j, k]], axis=1)
    found = np.zeros(len(q), bool)
    for sign in (1, -1):
        s = sign if (j - i) % 3 == 1 else -sign
        found |= (q[:, 0] == -s * q[:, j]) & (q[:, i] == -sign * q[:, k])
    return found


def next_to(true: list[flint.arb], found: np.ndarray) -> list[flint.arb]:
    """Return the true angles, whole turns added so that -pi and pi are one."""
    turns = [round(float(f - float(t)) / (2 * np.pi)) for f, t in zip(found, true, strict=True)]
    with flint.ctx.workprec(truth.BITS):
        return [t + n * 2 * flint.arb.pi() for t, n in zip(true, turns, strict=True)]


def next_to_lock(sequence: str, dtype: type) -> Rows:
    """Return attitudes from 1e-3 rad to the last digit away from gimbal lock."""
    i, j, k = ("xyz".index(axis) for axis in sequence)
    dice = np.random.default_rng(i + 3 * j + 9 * k)
    middle = (0, np.pi) if i == k else (np.pi / 2, -np.pi / 2)
    given = [
        (dice.uniform(-3, 3), m + d * dice.choice((-1, 1)), dice.uniform(-3, 3))
        for m in middle
        for d in (*cases.NEAR, 0)
    ]
    true = [plain(partial(truth.from_euler, sequence), angles) for angles in given]
    return np.array([[float(c) for c in q] for q in true], dtype)


@both
@each
def test_angles_keep_their_promise(sequence, dtype):
    name = f"quaternion_to_euler_{sequence}"
    hard = cases.hard_units(dtype)[::3]
    q = np.concatenate([cases.units(dtype, 30), hard, next_to_lock(sequence, dtype)])
    free = q[~locked(sequence, q)]
    for found, given in zip(called(name, free), free, strict=True):
        true = next_to(plain(partial(truth.to_euler, sequence), given), found)
        assert error(found, true, dtype) <= promise(name)


@both
@each
def test_at_gimbal_lock_the_third_angle_is_zero_and_the_rotation_is_right(sequence, dtype):
    q = cases.hard_units(dtype)
    q = q[locked(sequence, q)]
    assert len(q) > 10
    found = called(f"quaternion_to_euler_{sequence}", q)
    assert not np.any(found[:, 2])
    for angles, given in zip(found, q, strict=True):
        back = plain(partial(truth.from_euler, sequence), angles)
        true = plain(truth.unit, given)
        # Two angles of up to pi, each rounded to u of itself, and halved in the quaternion.
        off = min(
            float(max(abs(b - s * t) for b, t in zip(back, true, strict=True))) for s in (1, -1)
        )
        assert off <= 4 * UNIT[dtype]


@both
@each
def test_the_quaternion_of_angles_keeps_its_promise(sequence, dtype):
    name = f"quaternion_from_euler_{sequence}"
    angles = cases.of_any_length(3, dtype)
    angles = np.concatenate(
        [angles[np.max(abs(angles), axis=1) < 1e4][::3], cases.vectors(20, dtype)]
    )
    assert max(errors(name, partial(truth.from_euler, sequence), angles)) <= promise(name)


@both
def test_the_angles_of_no_rotation_are_zero_in_every_sequence(dtype):
    one = np.array([(1, 0, 0, 0), (-1, 0, 0, 0)], dtype)
    for sequence in SEQUENCES:
        assert not np.any(called(f"quaternion_to_euler_{sequence}", one))
