"""Product, exp, log, normalise and rotation keep their promise at every scale and angle."""

import numpy as np
import pytest

from tests.motion.attitude import cases, truth
from tests.motion.attitude.measured import PRECISIONS, UNIT, called, error, errors, promise
from tests.motion.attitude.truth import plain

pytestmark = pytest.mark.long

both = pytest.mark.parametrize("dtype", PRECISIONS)


@both
def test_a_product_keeps_its_promise(dtype):
    q = np.concatenate([cases.units(dtype), cases.hard_units(dtype)])
    other = np.roll(q, 17, axis=0)
    assert max(errors("quaternion_product", truth.times, q, other)) <= promise("quaternion_product")


@both
def test_a_quaternion_of_any_length_is_normalised(dtype):
    q = cases.of_any_length(4, dtype)
    assert max(errors("quaternion_normalise", truth.unit, q)) <= promise("quaternion_normalise")


@both
def test_the_quaternion_zero_says_no_rotation(dtype):
    zero = np.zeros((1, 4), dtype)
    assert called("quaternion_normalise", zero).tolist() == [[1, 0, 0, 0]]
    assert called("quaternion_log", zero).tolist() == [[0, 0, 0]]


@both
def test_the_logarithm_keeps_its_promise_at_any_length_and_angle(dtype):
    q = np.concatenate([cases.units(dtype), cases.hard_units(dtype), cases.of_any_length(4, dtype)])
    assert max(errors("quaternion_log", truth.log, q)) <= promise("quaternion_log")


@both
def test_the_logarithm_bears_parts_of_different_scales(dtype):
    q = cases.of_mixed_scales(dtype)
    assert max(errors("quaternion_log", truth.log, q)) <= promise("quaternion_log")


@both
def test_the_angle_of_a_logarithm_is_at_most_a_half_turn(dtype):
    q = np.concatenate([cases.hard_units(dtype), cases.of_mixed_scales(dtype)])
    angle = np.linalg.norm(called("quaternion_log", q).astype(np.float64), axis=1)
    assert np.max(angle) <= np.pi * (1 + 4 * UNIT[dtype])


@both
def test_one_and_minus_one_have_the_logarithm_zero(dtype):
    q = np.array([(1, 0, 0, 0), (-1, 0, 0, 0), (1e30, 0, 0, 0), (-1e-40, 0, 0, 0)], dtype)
    assert not np.any(called("quaternion_log", q))


@both
def test_exp_keeps_its_promise_and_keeps_small_vector_parts(dtype):
    v = cases.rotation_vectors(dtype)
    for found, given in zip(called("quaternion_exp", v), v, strict=True):
        true = plain(truth.exp, given)
        assert error(found, true, dtype) <= promise("quaternion_exp")
        if np.linalg.norm(given.astype(np.float64)) <= np.pi:
            assert error(found[1:], true[1:], dtype) <= promise("quaternion_exp")


@both
def test_exp_of_zero_is_one(dtype):
    assert called("quaternion_exp", np.zeros((1, 3), dtype)).tolist() == [[1, 0, 0, 0]]


@both
def test_exp_of_anything_is_of_unit_length_about_its_axis(dtype):
    v = cases.of_any_length(3, dtype)
    q = called("quaternion_exp", v).astype(np.longdouble)
    # sine and cosine, the remainder, the ratio and three products: less than 4 u in all
    assert np.max(np.abs(np.sqrt(np.sum(q * q, axis=1)) - 1)) <= 4 * UNIT[dtype]
    size = np.max(np.abs(v), axis=1)[:, None].astype(np.longdouble)
    off = np.max(np.abs(np.cross(q[:, 1:], v / size)), axis=1)
    largest = np.max(np.abs(q[:, 1:]), axis=1)
    tiny = np.finfo(dtype).smallest_subnormal
    assert np.all(off <= 4 * UNIT[dtype] * largest + 2 * tiny)


@both
@pytest.mark.parametrize("name", ["quaternion_rotate", "quaternion_rotate_back"])
def test_a_rotated_vector_keeps_its_promise(name, dtype):
    q = np.concatenate([cases.units(dtype), cases.hard_units(dtype)])
    size = 10.0 ** np.random.default_rng(3).integers(-30, 30, (len(q), 1))
    v = (cases.vectors(len(q), np.float64) * size).astype(dtype)
    true = truth.rotate if name == "quaternion_rotate" else truth.rotate_back
    assert max(errors(name, true, q, v)) <= promise(name)
