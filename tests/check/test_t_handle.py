"""The T-handle flips as expected: rates, attitude and period by the exact flow, in C and CasADi."""

from collections.abc import Callable
from functools import cache
from math import hypot
from pathlib import Path

import casadi
import pytest

from derive.check.compiler import find_compiler
from derive.check.emitted import Files, loaded
from derive.emit.files import scene_files
from derive.solve.instrument import Instrument, opened
from derive.verify.sample import Sample
from tests.check.expected import DATA, HANDLE_START, HANDLE_TIMES, handle_expected
from tests.made import library_of

DOUBLE = 1e-9
Flow = Callable[[float], dict[str, float]]


@cache
def instrument() -> Instrument:
    return opened("t_handle_flip")


def flow(time: object) -> dict[str, float]:
    return instrument().answer("flow_exact", HANDLE_START | {"time": time})


def close(found: float, name: str) -> bool:
    return abs(found - handle_expected(name)) <= DOUBLE * abs(handle_expected(name))


@pytest.mark.parametrize("when", HANDLE_TIMES)
def test_the_rates_at_a_time_are_the_expected_ones(when: str) -> None:
    found = flow(HANDLE_TIMES[when])
    assert all(close(found[f"omega_{a}_next"], f"w_{a}_{when}") for a in "xyz")


def test_the_attitude_after_five_seconds_is_the_expected_one() -> None:
    found = flow(5.0)
    w, x, y, z = (found[f"attitude_{p}_next"] for p in "wxyz")
    R = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    assert all(close(R[i][k], f"R{i + 1}{k + 1}_t5") for i in range(3) for k in range(3))


def test_it_flips_after_the_expected_interval() -> None:
    t = casadi.SX.sym("t")
    rule = {
        "x": t,
        "g": instrument().answer("flow_exact", HANDLE_START | {"time": t})["omega_y_next"],
    }
    finder = casadi.rootfinder("zero", "newton", rule)
    first, second = (float(finder(x0=start)["x"]) for start in (3.5, 9.7))
    assert close(second - first, "flip_interval")
    assert close(2 * (second - first), "polhode_period")


def test_energy_and_momentum_are_the_expected_ones() -> None:
    energy = instrument().answer("kinetic_energy", HANDLE_START)["kinetic_energy"]
    momentum = instrument().answer("angular_momentum", HANDLE_START)
    assert close(2 * energy, "two_T")
    assert close(hypot(*momentum.values()), "L_norm")


def test_every_expected_number_of_the_handle_is_looked_at() -> None:
    rates = {f"w_{a}_{when}" for a in "xyz" for when in HANDLE_TIMES}
    attitude = {f"R{i}{k}_t5" for i in (1, 2, 3) for k in (1, 2, 3)}
    rest = {"polhode_period", "flip_interval", "two_T", "L_norm"}
    assert rates | attitude | rest == set(DATA["t_handle_flip"]["expected"])


FAR = 2.5e-5  # sixty seconds at 15 rad/s: the float next to the given rate turns this far by then


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_compiled_c_gives_the_expected_rates(precision: str, tmp_path: Path) -> None:
    made = library_of("t_handle_flip")
    texts = {p.partition("/")[2]: t for p, t in scene_files(made, ()).items()}
    each = loaded(made, Files(texts, ""), tmp_path, find_compiler())
    one = next(e for e in each if e.precision.name == precision)
    names = [c for q in made["flow_exact"].outputs for c in q.components]
    for when, time in HANDLE_TIMES.items():
        held = {
            n: float(one.precision.dtype(x)) for n, x in (HANDLE_START | {"time": time}).items()
        }
        results = one.results(made["flow_exact"], Sample(0, "data", held))
        found = dict(zip(names, results, strict=True))
        allowed = DOUBLE if precision == "f64" else FAR
        for a in "xyz":
            expected = handle_expected(f"w_{a}_{when}")
            assert abs(found[f"omega_{a}_next"] - expected) <= allowed * abs(expected)
