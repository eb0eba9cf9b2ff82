"""An attitude's error has three components, none of them NaN, and derivatives that are exact."""

from itertools import product
from typing import Any

import casadi as ca
import numpy as np
import pytest

from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import library
from derive.motion.attitude.functions import attitude_program
from derive.scene import parse_scene
from tests.motion.attitude import cases, truth
from tests.motion.attitude.measured import PRECISIONS, UNIT, called, errors, promise
from tests.motion.systems import at, mpf

BOTH = ("quaternion_error", "quaternion_error_tangent")
TRUE = {BOTH[0]: truth.attitude_error, BOTH[1]: truth.error_slopes}
SMALL = mpf(10) ** -20  # a central difference over it errs by its square
ROUNDED = 4e-15  # some roundings in CasADi's own order


@pytest.fixture(scope="module")
def module(tmp_path_factory: pytest.TempPathFactory) -> Any:
    made = library(
        parse_scene(f'title = "Errors"\nwanted = ["{BOTH[0]}", "{BOTH[1]}"]\n', "errors")
    )
    return imported("errors_casadi", casadi_file(made), tmp_path_factory.mktemp("errors"))


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("name", BOTH)
def test_errors_and_slopes_keep_their_promise(name: str, dtype: type) -> None:
    q = cases.units(dtype)
    assert max(errors(name, TRUE[name], q, np.roll(q, 17, axis=0))) <= promise(name)


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_a_small_error_is_off_by_roundings_of_one_and_is_the_rotation_vector(dtype: type) -> None:
    q = cases.units(dtype)
    for size in (1e-2, 1e-5, 1e-12):
        v = cases.vectors(len(q), np.float64) * size / 4
        turns = called("quaternion_exp", v)
        turned = called("quaternion_product", q.astype(np.float64), turns).astype(dtype)
        found = called(BOTH[0], q, turned).astype(np.float64)
        assert np.max(np.abs(found - v)) <= size**3 + 16 * UNIT[dtype]


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_no_error_is_exactly_zero_whatever_the_sign_with_slopes_of_one(dtype: type) -> None:
    q = cases.hard_units(dtype)
    for sign in (1, -1):
        assert not np.any(called(BOTH[0], q, dtype(sign) * q))
        slopes = called(BOTH[1], q, dtype(sign) * q).astype(np.float64)
        assert np.max(np.abs(slopes - np.eye(3).ravel())) <= 16 * UNIT[dtype]


def test_half_a_turn_has_an_error_of_two_and_no_nan() -> None:
    one, half = np.array([[1.0, 0, 0, 0]]), np.array([[0.0, 0.6, 0, 0.8]])
    assert called(BOTH[0], one, half).tolist() == [[1.2, 0, 1.6]]
    assert called(BOTH[0], one, -half).tolist() == [[-1.2, 0, -1.6]]
    slopes = called(BOTH[1], one, half).reshape(3, 3)
    assert np.linalg.matrix_rank(slopes) == 2
    zero = np.zeros((1, 4))
    assert all(np.isfinite(called(n, *given)).all() for n in BOTH
               for given in product((one, zero), repeat=2))  # fmt: skip


def values(places: list[float]) -> dict[str, Any]:
    program = attitude_program(BOTH[0])
    names = [c for q in program.inputs for c in q.components]
    return {n: mpf(x) for n, x in zip(names, places, strict=True)}


@pytest.mark.parametrize("column", range(3))
def test_the_tangent_is_the_slope_through_the_exponential_map(column: int) -> None:
    dice = np.random.default_rng(3)
    for sign in (1, -1):
        p, q = (x / np.linalg.norm(x) for x in dice.normal(size=(2, 4)))
        here = values([*p, *(sign * q)])
        attitude = [here[f"attitude_{k}"] for k in "wxyz"]
        ends = []
        for side in (1, -1):
            half = [side * SMALL / 2 if k == column else mpf(0) for k in range(3)]
            w, x, y, z = attitude
            a, b, c = half
            turned = [w - x * a - y * b - z * c, x + w * a + y * c - z * b,
                      y + w * b + z * a - x * c, z + w * c + x * b - y * a]  # fmt: skip
            moved = here | {f"attitude_{k}": v for k, v in zip("wxyz", turned, strict=True)}
            ends.append(at(attitude_program(BOTH[0]), moved))
        found = at(attitude_program(BOTH[1]), here)[3 * column : 3 * column + 3]
        slopes = [(a - b) / (2 * SMALL) for a, b in zip(*ends, strict=True)]
        assert max(abs(a - b) for a, b in zip(found, slopes, strict=True)) < mpf(10) ** -35


def test_casadi_gives_the_same_bits_and_the_same_slopes(module: Any) -> None:
    own, tangent = (getattr(module, name)() for name in BOTH)
    p, q = ca.SX.sym("p", 4), ca.SX.sym("q", 4)
    w, x, y, z = ca.vertsplit(q)
    rows = [(-x, -y, -z), (w, -z, y), (z, w, -x), (-y, x, w)]
    lift = ca.vertcat(*(ca.horzcat(*row) for row in rows)) / 2
    slopes = ca.Function("slopes", [p, q], [ca.jacobian(own(p, q), q) @ lift])
    units = cases.units(np.float64, 20)
    for a, b in zip(units, np.roll(units, 3, axis=0), strict=True):
        here = [np.array([v]) for v in (a, b)]
        assert np.array_equal(own(a, b).full().ravel(), called(BOTH[0], *here)[0])
        ours = tangent(a, b).full().ravel()
        assert np.array_equal(ours, called(BOTH[1], *here)[0])
        theirs = np.array(slopes(a, b).full().T.ravel())
        assert np.max(np.abs(theirs - ours)) <= ROUNDED


def test_what_they_cost_is_little_more_than_a_product() -> None:
    assert attitude_program(BOTH[0]).flops() <= 31
    assert attitude_program(BOTH[1]).flops() <= 32
