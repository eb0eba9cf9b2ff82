"""Motions are run as the data say: exact steps, honest errors, glue that follows the manifest."""

import math
import shutil
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from bench.motion.case import cases
from bench.motion.glue import glue, movers
from bench.motion.runner import Job, built, methods_header, moved
from bench.motion.textbook import RK4, parameters, textbook
from bench.motion.wrong import wrong
from bench.report.point import FULL, SMALL
from bench.report.settings import gained, steps
from tests.bench.report.made_up import point

NEEDS_C = pytest.mark.skipif(not shutil.which("gcc"), reason="no gcc")
SOURCE = """\
#include "{scene}.h"
void drift_f64(const double attitude[4], const double omega[3], double time_step,
               const double remainder[1], double attitude_next[4], double omega_next[3],
               double remainder_next[1])
{{
    for (int i = 0; i < 4; i++) {{ attitude_next[i] = attitude[i]; }}
    for (int i = 0; i < 3; i++) {{ omega_next[i] = omega[i] + time_step; }}
    remainder_next[0] = remainder[0] + 1;
    if (remainder[0] < 0) {{ omega_next[0] = -1; }}
}}
"""
HEADER = (
    "void drift_f64(const double *, const double *, double, const double *, double *, double *,"
    " double *);\n"
)


def argument(name: str, direction: str, count: int) -> dict[str, object]:
    kind = "array" if count else "scalar"
    parts = [f"{name}_{n}" for n in range(count)] or [name]
    return {"name": name, "direction": direction, "type": kind, "components": parts}


def manifest() -> dict[str, object]:
    given = [("attitude", 4), ("omega", 3), ("time_step", 0), ("remainder", 1)]
    returned = [("attitude_next", 4), ("omega_next", 3), ("remainder_next", 1)]
    arguments = [argument(n, "in", c) for n, c in given]
    arguments += [argument(n, "out", c) for n, c in returned]
    return {
        "scene": "drift",
        "files": {"f64": {"header": "drift.h"}},
        "parameters": [],
        "constants": [],
        "functions": [
            {"name": "step_drift", "symbols": {"f64": "drift_f64"}, "returns": "void",
             "arguments": arguments},
            {"name": "step_drift_jacobian", "symbols": {"f64": "x"}, "arguments": arguments},
        ],
    }  # fmt: skip


@NEEDS_C
def test_a_stepper_is_called_as_its_manifest_says(tmp_path: Path) -> None:
    described = manifest()
    assert movers(described) == ["step_drift"]
    texts = {"drift.c": SOURCE.format(scene="drift"), "drift.h": HEADER}
    texts |= {"methods.h": methods_header("f64", 0), "methods.c": glue(described, "f64")}
    mover = built(texts, movers(described), 0, tmp_path)
    case = cases()["asym_ii_generic"]
    (motion,) = moved(mover, case, [], [Job("step_drift", 0.5, 8, rounds=2)])
    assert motion is not None
    assert motion.passes == 8
    assert motion.states == ((1.0, 0.0, 0.0, 0.0, 5.0, 4.5, 6.0),)


@NEEDS_C
def test_the_textbook_converges_to_the_reference(tmp_path: Path) -> None:
    pytest.importorskip("scipy")
    for name in ("full_tensor", "const_body_torque", "gyrostat_wheel", "heavy_top_asymmetric"):
        case = cases()[name]
        mover = textbook(case, "f64", tmp_path / name)
        step = float(case.time) / 2**14
        (motion,) = moved(mover, case, parameters(case), [Job(RK4, step, 2**14)])
        assert motion is not None
        # an h^4 of (0.003 s, 4 rad/s)^4 = 2e-8, less the constants of RK4
        assert wrong(case, motion.states[-1]).state < 1e-9


def test_the_reference_itself_has_no_error_and_the_other_sign_of_q_none() -> None:
    for case in cases().values():
        state = [float(x) for x in (*case.q_T, *case.omega_T)]
        opposite = [-x for x in state[:4]] + state[4:]
        for one in (state, opposite):
            assert wrong(case, one).state < 4 * 2.0**-53


def test_an_angle_of_attitude_is_found() -> None:
    case = cases()["asym_ii_generic"]
    a, x, y, z = (float(q) for q in case.q_T)
    c, s = math.cos(5e-4), math.sin(5e-4)
    turned = [a * c - x * s, x * c + a * s, y * c + z * s, z * c - y * s]
    found = wrong(case, [*turned, *map(float, case.omega_T)])
    assert abs(found.attitude - 1e-3) < 1e-15


def test_a_state_that_is_no_number_is_not_zero_wrong() -> None:
    assert math.isnan(wrong(cases()["sphere"], [math.nan] * 7).state)


@pytest.mark.parametrize("limits", [SMALL, FULL], ids=["small", "full"])
def test_so_many_steps_end_exactly_at_the_time(limits: object) -> None:
    for case in cases().values():
        for count in steps(case, limits):  # type: ignore[arg-type]
            step = case.time / count
            assert Fraction(float(np.float32(float(step)))) == step


def test_steps_become_finer_until_nothing_is_gained() -> None:
    falling = [point("step_rk4", 2.0**-n, 16.0**-n, 1.0) for n in range(8)]
    assert gained(falling, 0.0)
    flat = [*falling, *(point("step_rk4", 2.0**-n, 1e-8, 1.0) for n in range(8, 12))]
    assert not gained(flat, 0.0)
    assert not gained(falling, 1.0)
