"""A scene's functions for arrays: compiled and by CasADi the same bits, and what they refuse."""

import copy
import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import derive
from derive.check import compiler
from derive.program.arithmetic import extended, paired, working
from derive.program.precision import F32
from derive.program.run import run
from derive.solve.bound import Accuracy, By
from tests.made import thinned

MANY = 2000
CASES = [
    ("heavy_top", "state_rate"),
    ("edge_runner_flat", "N"),
    ("sleeping_top", "step_rk4"),
    ("sleeping_top", "linearised"),
    ("heavy_top", "state_rate_jacobian_dense"),
    ("rigid_body", "state_rate"),
    ("satellite", "step_rk4_jacobian"),
    ("tumbling_body", "flow_exact"),
    ("attitude", "quaternion_to_matrix"),
]
TOP = {"A": 1.5e-3, "C": 6e-4, "m": 0.6, "g": 9.8, "l": 0.04}


@cache
def function_of(scene: str, name: str, by: By) -> derive.SceneFunction:
    return derive.load(scene).function(name, by=by)


def drawn(function: derive.SceneFunction, count: int) -> dict[str, NDArray[Any]]:
    """Return members of a batch within the declared ranges; attitudes have length 1."""
    dice = np.random.default_rng(7)
    found = {}
    for q in (*function.inputs, *function.parameters):
        low, high = map(float, q.ends)
        values = dice.uniform(low, high, (count, *q.shape))
        unit = np.linalg.norm(values, axis=-1, keepdims=True) if q.is_quaternion else 1.0
        found[q.name] = values / unit
    return found


def bits(found: Any) -> list[bytes]:
    """Return results to the last bit, but for the signs of zeros: CasADi loses some."""
    each = found if isinstance(found, tuple) else (found,)
    return [(x + 0.0).tobytes() for x in each]


@pytest.mark.long
@pytest.mark.parametrize("case", thinned(CASES, 3))
def test_compiled_and_by_casadi_a_batch_has_the_same_bits(case: tuple[str, str]) -> None:
    compiled, own = (function_of(*case, by) for by in ("compiler", "casadi"))
    given = drawn(compiled, MANY)
    assert bits(compiled(**given)) == bits(own(**given))
    one = {n: x[3] for n, x in given.items()}
    shared = given | {q.name: one[q.name] for q in compiled.parameters}
    assert bits(compiled(**shared)) == bits(own(**shared))
    assert bits(compiled(**one)) == bits(own(**one))


@pytest.mark.long
def test_a_member_of_a_batch_has_the_bits_of_a_single_call_however_axes_lie() -> None:
    rate = function_of("heavy_top", "state_rate", "compiler")
    given = drawn(rate, 6)
    many = rate(**given).omega_dot
    fixed = {n: float(given[n][0]) for n in TOP}
    bound = derive.load("heavy_top").function("state_rate", fixed, by="compiler")
    theta, omega = given["theta"].reshape(2, 3, 1), np.asfortranarray(given["omega"][:4])
    table = bound(theta, omega)
    assert table.omega_dot.shape == (2, 3, 4, 3)
    for i, j, k in np.ndindex(2, 3, 4):
        single = bound(theta[i, j, 0], omega[k])
        assert bits(single.omega_dot) == bits(table.omega_dot[i, j, k])
    one = rate(**{n: x[5] for n, x in given.items()}).omega_dot
    assert bits(one) == bits(many[5])
    assert bound(theta[:0], omega).omega_dot.shape == (0, 3, 4, 3)


def test_a_function_in_float_has_the_bits_of_its_program_in_float() -> None:
    energy = derive.load("heavy_top").function("kinetic_energy", precision="float")
    given = drawn(energy, 50)
    library = derive.load("heavy_top").library
    columns = [given[q.name].astype(np.float32) for q in library.setup.inputs]
    made = [x[0] for x in run(library.setup, extended(F32.dtype), paired(np.array(columns)))]
    omega = given["omega"].astype(np.float32).T
    (expected,) = run(library["kinetic_energy"], working(F32.dtype), [*made, *omega])
    found = energy(**given)
    assert found.dtype == np.float32
    assert bits(found) == bits(expected)


WRONG: Mapping[str, tuple[tuple[Any, ...], dict[str, Any]]] = {
    "'state_rate' needs A, C, m, g, l": ((1.0, [1, 2, 3]), {}),
    "'state_rate' needs omega": ((1.0,), TOP),
    "has 2 inputs, not 3: theta, omega": ((1.0, [1, 2, 3], 4), TOP),
    "is given 'theta' twice": ((1.0, [1, 2, 3]), {"theta": 2} | TOP),
    "takes no 'omga' (did you mean 'omega'?)": ((1.0,), {"omga": [1, 2, 3]} | TOP),
    "takes no 'omega_x': it is a component of omega": ((1.0,), {"omega_x": 1} | TOP),
    "omega must have the shape (3,), or that behind leading axes, not (4,)": (
        (1.0, np.zeros(4)),
        TOP,
    ),
    "omega must have the shape (3,), or that behind leading axes, not ()": ((1.0, 2.0), TOP),
    "must broadcast, but theta has (5,), omega has (4,)": ((np.ones(5), np.zeros((4, 3))), TOP),
    "theta must be a real number, not (1+2j)": ((1 + 2j, [1, 2, 3]), TOP),
    "theta must be a real number, not 'one'": (("one", [1, 2, 3]), TOP),
    "theta must be a real number, not True": ((True, [1, 2, 3]), TOP),
    "omega must be an array of real numbers, not an array of object": ((1.0, [None, 2, 3]), TOP),
    "omega must be an array with rows of one length, not a list of 2": (
        (1.0, [[1, 2, 3], [1, 2]]),
        TOP,
    ),
    "a parameter is not finite at A = nan": ((1.0, [1, 2, 3]), TOP | {"A": np.nan}),
    "(status 4) in member 2": ((1.0, [1, 2, 3]), TOP | {"A": np.array([1e-3, 1e-3, -1.0])}),
    "(status 4) in member (1, 0)": ((1.0, [1, 2, 3]), TOP | {"A": np.array([[1e-3], [-1.0]])}),
}


@pytest.mark.parametrize("by", ["compiler", "casadi"])
def test_a_call_that_makes_no_sense_is_refused_in_one_sentence(by: By) -> None:
    rate = function_of("heavy_top", "state_rate", by)
    for sentence, (given, named) in WRONG.items():
        with pytest.raises(derive.DeriveError) as refused:
            rate(*given, **named)
        assert str(refused.value).startswith("scene 'heavy_top': ")
        assert sentence in str(refused.value)


def test_a_function_that_cannot_be_had_is_refused_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = derive.load("heavy_top")
    for sentence, asked in {
        "has no function 'state_rat' (did you mean 'state_rate'?)": {"name": "state_rat"},
        "'state_rate' has no parameter 'B'": {"name": "state_rate", "parameters": {"B": 1}},
        "l must be one number": {"name": "state_rate", "parameters": {"l": [1, 2]}},
        "inertia must be positive definite": {"name": "state_rate", "parameters": TOP | {"A": -1}},
        "precision must be one of double, float": {"name": "state_rate", "precision": "half"},
        "by must be one of": {"name": "state_rate", "by": "magic"},
    }.items():
        with pytest.raises(derive.DeriveError, match="scene 'heavy_top'") as refused:
            scene.function(**asked)
        assert sentence in str(refused.value)
    monkeypatch.setattr(compiler.shutil, "which", lambda _: None)
    monkeypatch.setattr(compiler, "find_spec", lambda _: None)
    with pytest.raises(derive.DeriveError, match=r"not give .* in float; by = .any. t"):
        scene.function("angular_momentum", precision="float", by="casadi")
    assert scene.function("angular_momentum").kernel.by == "CasADi"
    assert scene.function("angular_momentum", precision="float").kernel.by == "NumPy"
    with pytest.raises(derive.DeriveError, match="scene 'heavy_top': no C compiler"):
        scene.function("angular_momentum", by="compiler")


LOOPED = [
    ("heavy_top", "state_rate", "float"),
    ("rigid_body_steps", "step_rk4", "double"),
    ("satellite", "step_taylor", "float"),
    ("tumbling_body", "step_taylor", "float"),
]


@pytest.mark.parametrize("case", thinned(LOOPED, 4))
def test_without_a_compiler_what_casadi_rounds_otherwise_has_the_bits_of_c(
    case: tuple[str, str, Accuracy], monkeypatch: pytest.MonkeyPatch
) -> None:
    name, function, precision = case
    scene = derive.load(name)
    compiled = scene.function(function, precision=precision, by="compiler")
    monkeypatch.setattr(compiler.shutil, "which", lambda _: None)
    monkeypatch.setattr(compiler, "find_spec", lambda _: None)
    own = scene.function(function, precision=precision)
    assert own.kernel.by == "NumPy"
    given = drawn(compiled, 200)
    for values in (given, {n: x[0] for n, x in given.items()}):
        found, expected = own(**values), compiled(**values)
        assert [x.tobytes() for x in found] == [x.tobytes() for x in expected]
    fixed = {q.name: float(given[q.name][0]) for q in compiled.parameters}
    inputs = {q.name: given[q.name] for q in compiled.inputs}
    bound = scene.function(function, fixed, precision)
    assert bound.kernel is own.kernel
    expected = compiled(**inputs, **fixed)
    assert [x.tobytes() for x in bound(**inputs)] == [x.tobytes() for x in expected]


def test_results_and_functions_go_to_another_process() -> None:
    rate = derive.load("heavy_top").function("state_rate", TOP, by="compiler")
    found = rate([0.5, 1.0], [1.0, 2.0, 3.0])
    there = pickle.loads(pickle.dumps(found))  # noqa: S301
    assert type(there) is type(found)
    assert [x.tobytes() for x in there] == [x.tobytes() for x in found]
    again = pickle.loads(pickle.dumps(rate))  # noqa: S301
    assert (again.fixed, again.name, again.kernel.by) == (rate.fixed, rate.name, rate.kernel.by)
    assert bits(again([0.5, 1.0], [1.0, 2.0, 3.0])) == bits(found)
    assert bits(copy.deepcopy(rate)(0.5, [1.0, 2.0, 3.0])) == bits(rate(0.5, [1.0, 2.0, 3.0]))


def test_a_masked_array_is_refused_for_its_mask_is_no_value() -> None:
    rate = function_of("heavy_top", "state_rate", "compiler")
    theta = np.ma.array([0.5, 1.0], mask=[0, 1])
    for value in (theta, [theta, theta]):
        with pytest.raises(derive.DeriveError, match=r"theta must have a value everywhere.*masked"):
            rate(value, [1, 2, 3], **TOP)
    whole = np.ma.array([0.5, 1.0])
    assert bits(rate(whole, [1, 2, 3], **TOP)) == bits(rate(whole.data, [1, 2, 3], **TOP))


def test_a_whole_number_that_a_double_holds_is_a_number() -> None:
    moment = derive.load(BALL, "ball").function("moment", by="compiler")
    assert moment([5 * 10**30, 0, 0])[0] == 0.4 * 5e30
    with pytest.raises(derive.DeriveError, match="omega_dot must be within float64"):
        moment([10**400, 0, 0])


def test_a_pattern_says_the_shape_of_its_matrix() -> None:
    pattern = function_of("heavy_top", "state_rate_jacobian_dense", "compiler").sparsity
    assert pattern is not None
    assert pattern.shape == (6, 6) == (len(pattern.rows), len(pattern.columns))


def test_what_was_made_once_is_kept() -> None:
    scene = derive.load("heavy_top")
    assert derive.load("heavy_top") is scene
    first, second = (scene.function("state_rate", by="compiler") for _ in range(2))
    assert first.kernel is second.kernel


def test_a_function_and_a_scene_say_what_they_are() -> None:
    rate = derive.load("heavy_top").function("state_rate", {"m": 0.5}, by="compiler")
    for says in ("state_rate of scene 'heavy_top', in double", "omega            (3,)   rad/s",
                 "fixed     m = 0.5", "nutation, from the vertical"):  # fmt: skip
        assert says in repr(rate)
    assert "parameter  l       m  distance of the mass centre" in repr(derive.load("heavy_top"))


BALL = {"wanted": ["moment"], "body": {"kind": "spherical", "moment": 0.4}}
ELSEWHERE = f"""
import derive
print(derive.load({BALL}, 'ball').function('moment')([5, 0, 0]).tolist())
"""


def test_nothing_is_left_in_the_temporary_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    moment = derive.load(BALL, "left").function("moment", by="compiler")
    assert moment([5.0, 0.0, 0.0]).tolist() == [2.0, 0.0, 0.0]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
@pytest.mark.whole
def test_processes_do_not_meet_in_the_temporary_folder(tmp_path: Path) -> None:
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    command = [sys.executable, "-c", ELSEWHERE]
    each = [
        subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
        for _ in range(4)
    ]
    assert [one.communicate()[0] for one in each] == ["[2.0, 0.0, 0.0]\n"] * 4
    assert list(tmp_path.iterdir()) == []


def test_threads_do_not_meet_in_the_memory_of_a_single_call() -> None:
    rate = derive.load("heavy_top").function("state_rate", TOP, by="compiler")
    theta = np.linspace(0.3, 2.8, 200)
    expected = bits(rate(theta, [1.0, 2.0, 3.0]))

    def each(_: int) -> list[bytes]:
        rows = [rate(x, [1.0, 2.0, 3.0]) for x in theta]
        return bits(tuple(np.array(own) for own in zip(*rows, strict=True)))

    with ThreadPoolExecutor(4) as pool:
        assert all(found == expected for found in pool.map(each, range(8)))


def test_a_large_batch_takes_one_call() -> None:
    energy = derive.load("heavy_top").function("kinetic_energy", TOP, by="compiler")
    omega = np.random.default_rng(3).uniform(-10, 10, (100_000, 3))
    found = energy(omega)
    A, C = TOP["A"], TOP["C"]
    expected = 0.5 * (A * omega[:, 0] ** 2 + A * omega[:, 1] ** 2 + C * omega[:, 2] ** 2)
    assert np.allclose(found, expected, rtol=8 * 2.0**-53, atol=0)  # sums of terms of one sign
