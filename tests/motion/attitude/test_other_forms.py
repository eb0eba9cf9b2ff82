"""Matrices and Rodrigues parameters keep their promise at every attitude."""

import numpy as np
import pytest

from tests.motion.attitude import cases, truth
from tests.motion.attitude.measured import PRECISIONS, UNIT, called, error, errors, promise
from tests.motion.attitude.truth import plain

both = pytest.mark.parametrize("dtype", PRECISIONS)


def attitudes(dtype):
    return np.concatenate([cases.units(dtype), cases.hard_units(dtype)])


@both
def test_a_matrix_keeps_its_promise(dtype):
    q = attitudes(dtype)
    assert max(errors("quaternion_to_matrix", truth.by_column, q)) <= promise(
        "quaternion_to_matrix"
    )


@both
def test_a_matrix_gives_its_quaternion_back_at_any_angle(dtype):
    q = attitudes(dtype)
    matrices = np.array([[float(e) for e in plain(truth.by_column, one)] for one in q], dtype)
    for found, given in zip(called("quaternion_from_matrix", matrices), q, strict=True):
        true = plain(truth.unit, given)
        off = min(error(found, true, dtype), error(-found, true, dtype))
        assert off <= promise("quaternion_from_matrix")
        assert found[0] >= 0


@both
def test_rodrigues_parameters_keep_their_promise(dtype):
    q = attitudes(dtype)
    assert max(errors("quaternion_to_mrp", truth.mrp, q)) <= promise("quaternion_to_mrp")


@both
def test_rodrigues_parameters_are_no_longer_than_one(dtype):
    found = called("quaternion_to_mrp", attitudes(dtype)).astype(np.float64)
    assert np.max(np.linalg.norm(found, axis=1)) <= 1 + 4 * UNIT[dtype]


@both
def test_any_rodrigues_parameters_have_a_unit_quaternion(dtype):
    mrp = np.concatenate([cases.of_any_length(3, dtype), cases.vectors(100, dtype)])
    for found, given in zip(called("quaternion_from_mrp", mrp), mrp, strict=True):
        true = plain(truth.from_mrp, given)
        assert error(found, true, dtype) <= promise("quaternion_from_mrp")
        assert error(found[1:], true[1:], dtype) <= promise("quaternion_from_mrp")


@both
def test_rodrigues_parameters_zero_say_no_rotation(dtype):
    assert called("quaternion_from_mrp", np.zeros((1, 3), dtype)).tolist() == [[1, 0, 0, 0]]
