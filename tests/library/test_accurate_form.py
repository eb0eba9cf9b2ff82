"""The accurate form is right to the last bit even where the moment cancels the gyroscopic term."""

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derive.check import check_library
from derive.check.compiler import find_compiler
from derive.check.emitted import Files
from derive.library.library import Library, library
from derive.program.arithmetic import EXACT, extended, paired, working
from derive.program.precision import F32
from derive.program.program import Program
from derive.program.run import run
from derive.scene import SceneError, load, parse_scene
from derive.scene.wanted import ATTITUDES, OF_MACHINES, WANTED, moves
from derive.verify.draw import with_motion
from derive.verify.measure import exact, replayed
from derive.verify.sample import Sample, samples
from derive.verify.scale import measured_outputs
from tests.check.mutants import printed
from tests.made import thinned

PARAMETERS = [
    Fraction(n, 64) for n in (90, 110, 125, 7, -5, 3)
]  # I_xx .. I_yz, exact in both types
OMEGA = (1.6123456789012345, -2.6789012345678901, 4.3456789012345678)
# One rounding of the result, and what the pairs leave: far below a thousandth of it.
ROUNDED_ONCE = 0.501
CANCELS_TO = Fraction(1, 10**4)


@cache
def made(form: str) -> Library:
    text = load("free_body").text
    return library(parse_scene(f'form = "{form}"\n{text}', "free_body"))


def exact_constants(lib: Library) -> list[Fraction]:
    return run(lib.setup, EXACT | {"low": lambda a: a * 0}, PARAMETERS)


def nearly_cancelling(lib: Library, dtype: type) -> list[Fraction]:
    """Return omega and a moment that leaves one part in ten thousand of the gyroscopic term."""
    omega = [Fraction(float(dtype(w))) for w in OMEGA]
    still = run(lib["moment"], EXACT, [*exact_constants(lib), *omega, *[Fraction(0)] * 3])
    return [*omega, *(Fraction(float(dtype(float(m * (1 + CANCELS_TO))))) for m in still)]


def worst(form: str, dtype: type) -> float:
    """Return the worst error of omega_dot in ulps of the result."""
    lib = made(form)
    inputs = nearly_cancelling(made("fast"), dtype)
    truth = run(lib["acceleration"], EXACT, [*exact_constants(lib), *inputs])
    given = np.array([float(x) for x in PARAMETERS], dtype)
    constants = [high for high, _ in run(lib.setup, extended(dtype), paired(given))]
    values = np.array([*constants, *[float(x) for x in inputs]], dtype)
    if form == "accurate":
        found = [high for high, _ in run(lib["acceleration"], extended(dtype), paired(values))]
    else:
        found = run(lib["acceleration"], working(dtype), list(values))
    return max(
        float(abs(Fraction(float(f)) - t) / Fraction(float(np.spacing(abs(dtype(float(t)))))))
        for f, t in zip(found, truth, strict=True)
    )


@pytest.mark.long
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_accurate_form_rounds_once(dtype):
    assert worst("accurate", dtype) <= ROUNDED_ONCE


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_fast_form_does_not(dtype):
    assert worst("fast", dtype) > 10


def test_the_accurate_form_does_the_same_operations():
    fast, accurate = made("fast"), made("accurate")
    for a, b in zip(fast.functions, accurate.functions, strict=True):
        assert b.arithmetic == "pairs"
        joined = sum(name.endswith("_low") for q in b.inputs for name in q.components)
        assert len(b.ops) - len(a.ops) <= joined


SPINNING = """
form = "accurate"
wanted = ["WANTED"]
[parameters]
A = { unit = "kg m^2", range = [1, 2] }
B = { unit = "kg m^2", range = [2, 2.5] }
C = { unit = "kg m^2", range = [2.5, 3] }
m = { unit = "kg", range = [1, 2] }
[axes]
attitude = "quaternion"
[body]
kind = "principal"
mass = "m"
moments = ["A", "B", "C"]
[known]
moment = [0, 0, 0]
"""
FALLING = """
form = "accurate"
wanted = ["WANTED"]
[parameters]
l = { unit = "m", range = [1, 2] }
m = { unit = "kg", range = [1, 2] }
[coordinates]
x = { unit = "rad", range = [-1, 1] }
[frames]
arm.turned = ["z x"]
[bodies]
bob = { frame = "arm", shape = "point", mass = "m", centre = ["l", 0, 0] }
[loads]
weight = { gravity = [0, "-9.81", 0], along = "inertial" }
pin = { on = "bob", force = ["?f_x", "?f_y", "?f_z"], couple = ["?c_x", "?c_y", "0"] }
[results]
lift = "2*f_y"
"""
OF_A_MACHINE = (
    *("accelerations", "state_rate", "kinetic_energy", "potential_energy", "energy"),
    *("angular_momentum", "f_x", "lift", "accelerations_jacobian"),
)


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(WANTED, 4))
def test_whatever_is_wanted_is_in_pairs_or_refuses_the_accurate_form_by_its_name(name: str) -> None:
    try:
        lib = library(parse_scene(SPINNING.replace("WANTED", name), "spinning"))
    except SceneError as error:
        assert f"form = 'accurate' is not for '{name}'" in str(error)  # noqa: PT017
        assert moves(name)
        return
    kinds = {p.arithmetic for p in lib.printed()}
    assert kinds == ({"working"} if name in ATTITUDES else {"pairs"})


@pytest.mark.parametrize("name", thinned([*OF_A_MACHINE, *OF_MACHINES], 6))
def test_answers_of_machines_are_in_pairs_or_refuse_the_accurate_form(name: str) -> None:
    if name.endswith("_tangent") or "_unit" in name:
        pytest.skip("of a quaternion, and this machine has none")
    try:
        lib = library(parse_scene(FALLING.replace("WANTED", name), "falling"))
    except SceneError as error:
        assert f"form = 'accurate' is not for '{name}'" in str(error)  # noqa: PT017
        return
    assert {p.arithmetic for p in lib.printed()} == {"pairs"}


def test_loops_for_small_memories_refuse_the_accurate_form() -> None:
    text = SPINNING.replace("WANTED", "step_rk4").replace("[par", 'emission = "compact"\n[par', 1)
    with pytest.raises(SceneError, match="'step_rk4' needs emission = 'fast'"):
        parse_scene(text, "spinning")


STEPS = ("step_rk4", "step_lie", "step_rk4_jacobian", "step_lie_tangent", "step_split")
# Half an ulp is u of the largest component where that is just above a power of two; pairs leave
# a thousandth of it at most.
ONE_ROUNDING = 1.001


def step_errors(form: str) -> list[float]:
    """Return the largest error of each step in float, of full tensors of rods at condition 1e5."""
    text = load("free_body").text
    wanted = ", ".join(f'"{name}"' for name in STEPS)
    text = re.sub(r"wanted\s*=\s*\[[^\]]*\]", f'form = "{form}"\nwanted = [{wanted}]', text)
    text = text.replace('fixed_in = "body"', 'attitude = "quaternion"')
    text = re.sub(r"moment\s*=.*", "moment = [0, 0, 0]", text)
    lib = library(parse_scene(text, "rods"))
    every = samples(lib.mechanism, F32, 1, 6).each
    drawn = [s for s in every if s.kind == "turned, ill-conditioned"]
    each = with_motion(lib, drawn, F32)
    results = replayed(lib, each, F32, working(F32.dtype))
    return [max(of_the_largest(lib, lib[name], each, results[name])) for name in STEPS]


def of_the_largest(
    lib: Library, step: Program, each: Sequence[Sample], columns: Sequence[Any]
) -> Iterator[float]:
    """Yield the error of each output of a step, in u of its largest component."""
    for n, sample in enumerate(each):
        true = [float(x.mid()) for x in exact(lib, step, sample)]
        for _, span in measured_outputs(step):
            off = [abs(float(c[n]) - x) for c, x in zip(columns[span], true[span], strict=True)]
            yield max(off) / max(map(abs, true[span])) / F32.unit_roundoff


@pytest.mark.long
def test_accurate_steps_of_rods_err_by_one_rounding_of_the_state() -> None:
    assert max(step_errors("fast")) > 10
    assert max(step_errors("accurate")) <= ONE_ROUNDING


@pytest.mark.long
@pytest.mark.parametrize(
    "name", ["step_split", "step_lie", "step_rk4_jacobian", "step_lie_tangent"]
)
def test_accurate_steps_have_the_bits_of_their_programs_in_c_and_casadi(
    name: str, tmp_path: Path
) -> None:
    lib = library(parse_scene(SPINNING.replace("WANTED", name), "spinning"))
    rows = [*check_library(lib, Files(printed(lib), "made"), tmp_path, find_compiler(), 4)]
    assert [row for row in rows if row.outcome == "FAILS"] == []
    assert {"bits of the program", "CasADi's bits"} <= {row.check for row in rows}
