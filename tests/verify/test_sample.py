"""Samples are bodies in motion, the same on every machine, all bits of their precision in use."""

import hashlib
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from derive.mechanics.mechanism import Mechanism, mechanism
from derive.program.precision import F32, F64, PRECISIONS, Precision
from derive.scene import catalogue, load
from derive.verify.draw import Sampled
from derive.verify.hard_bodies import BODIES, TURN, admissible
from derive.verify.sample import CORNERS, LARGE_SPIN, Samples, samples
from tests.made import library_of, thinned


@cache
def scene(name: str) -> Mechanism:
    return mechanism(load(name))


def drawn(name: str, precision: Precision) -> Samples:
    return _drawn(name, PRECISIONS.index(precision))


@cache
def _drawn(name: str, place: int) -> Samples:
    return samples(scene(name), PRECISIONS[place], 6, 2)


@pytest.mark.parametrize("name", thinned(catalogue(), 5))
@pytest.mark.parametrize("precision", PRECISIONS, ids=lambda p: p.name)
def test_every_value_is_a_float_of_the_precision(name: str, precision: Precision) -> None:
    for sample in drawn(name, precision).each:
        assert all(float(precision.dtype(x)) == x for x in sample.values.values())


@pytest.mark.parametrize("name", thinned(catalogue(), 5))
def test_every_sample_is_a_body(name: str) -> None:
    known, fits = scene(name), Sampled(library_of(name), F64).bodies
    each = drawn(name, F64).each
    assert all(fits(known.scene, s.values) for s in each)


@pytest.mark.parametrize("name", thinned(catalogue(), 5))
def test_ordinary_samples_lie_on_the_declared_ranges(name: str) -> None:
    known = scene(name)
    for sample in drawn(name, F64).each:
        if sample.kind == "ordinary":
            for q in known.vocabulary.given():
                values = [sample.values[c] for c in q.components]
                assert all((q.low or 0) <= Fraction(x) <= (q.high or 0) for x in values), q.name


@pytest.mark.parametrize("name", thinned(catalogue(), 5))
def test_every_corner_is_there_or_counted_as_skipped(name: str) -> None:
    found = drawn(name, F32)
    kinds = {s.kind for s in found.each} - {"ordinary"}
    assert kinds | set(found.skipped) == {*CORNERS, *(hard.kind for hard in BODIES)}
    assert not kinds & set(found.skipped)


def test_the_same_numbers_come_on_every_machine() -> None:
    text = repr([s for p in PRECISIONS for s in drawn("gyrostat", p).each])
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == "8fc20df6ae8810a9"


def kinds(name: str, kind: str) -> list[dict[str, float]]:
    return [dict(s.values) for s in drawn(name, F64).each if s.kind == kind]


def test_nearly_equal_moments_differ_by_less_than_a_hundred_millionth() -> None:
    for values in kinds("free_body_principal", "near sphere"):
        moments = [values[f"I_{a}{a}"] for a in "xyz"]
        assert 0 < max(moments) / min(moments) - 1 <= 1e-8


def test_ill_conditioned_tensors_have_condition_1e9() -> None:
    for v in kinds("free_body", "turned, ill-conditioned"):
        off = [[0, -v["I_xy"], -v["I_xz"]], [0, 0, -v["I_yz"]], [0, 0, 0]]
        tensor = np.diag([v["I_xx"], v["I_yy"], v["I_zz"]]) + np.array(off) + np.array(off).T
        assert 1e8 < np.linalg.cond(tensor) < 2e9


def test_spin_is_large_denormals_are_denormal_and_half_turns_are_half_turns() -> None:
    fast = [max(abs(v[f"omega_{a}"]) for a in "xyz") for v in kinds("free_body", "large spin")]
    assert all(LARGE_SPIN / 10 < w <= LARGE_SPIN for w in fast)
    smallest = float(np.finfo(np.float64).smallest_normal)
    assert all(0 < abs(v["omega_x"]) < smallest for v in kinds("free_body", "denormal"))
    assert all(v["attitude_w"] == 0 for v in kinds("rigid_body", "half turn"))


def test_the_turn_of_hard_bodies_is_a_rotation() -> None:
    rows = np.array(TURN).reshape(3, 3)
    assert np.allclose(rows @ rows.T, np.eye(3), atol=1e-15)
    assert np.isclose(np.linalg.det(rows), 1)


def test_a_tensor_that_breaks_the_triangle_inequality_is_no_body() -> None:
    known = scene("free_body_principal")
    assert admissible(known.scene, {"I_xx": 1.0, "I_yy": 1.0, "I_zz": 2.0})
    assert not admissible(known.scene, {"I_xx": 1.0, "I_yy": 1.0, "I_zz": 2.1})
