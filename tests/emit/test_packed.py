"""Every CasADi module takes x, u, time_step, parameters in one order, whatever moves."""

import json
import re
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest

from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.emit.manifest import manifest
from derive.library.library import Library, library
from derive.scene import parse_scene
from tests.made import text_of

STEP = '["step_rk4"]'
WHEELS = '["state_rate", "step_rk4", "step_rk4_jacobian"]'
KINDS = {"satellite": '["step_rk4_unit", "step_rk4"]', "gyrostat": WHEELS, "quadrotor": STEP}
KINDS |= {"reaction_wheel_satellite": STEP, "cart_pendulum": STEP, "heavy_body": STEP}
PUSHED = """
wanted = ["step_rk4"]
axes   = { attitude = "quaternion" }
body   = { kind = "spherical", moment = "J" }
[parameters]
J = { unit = "kg m^2", range = [1, 2] }
w = { unit = "N m", range = [0.5, 2], meaning = "weight times distance" }
[inputs]
c = { unit = "N m", range = [-1, 1], components = ["x", "y"], meaning = "control moment" }
[point]
kind = "fixed"
[known]
moment = [
    "c_x + 2*w*(attitude_y*attitude_z + attitude_w*attitude_x)",
    "c_y - 2*w*(attitude_x*attitude_z - attitude_w*attitude_y)",
    "0",
]
"""


@cache
def made(name: str) -> Library:
    wanted = f"wanted = {KINDS[name]}"
    text = re.sub(r"wanted = \[.*?\]", wanted, text_of(name), count=1, flags=re.DOTALL)
    return library(parse_scene(text, name))


def module_of(name: str, folder: Path) -> ModuleType:
    return imported(f"{name}_casadi", casadi_file(made(name)), folder)


def drawn(module: ModuleType) -> dict[str, Any]:
    dice = np.random.default_rng(5)
    each = {"x": module.STATES, "u": module.INPUTS, "parameters": module.PARAMETERS}
    found = {n: [dice.uniform(*module.RANGES[c]) for c in parts] for n, parts in each.items()}
    return found | {"time_step": 0.01}


def unpacked(module: ModuleType, function: Any, given: dict[str, Any]) -> Any:
    """Return what a function of quantities gives, each found by the names of its components."""
    rows = dict(zip((*module.STATES, *module.INPUTS), (*given["x"], *given["u"]), strict=True))
    rows |= {"time_step": given["time_step"]}
    own = made(module.__name__.removesuffix("_casadi"))
    named = {q.name: q.components for p in (*own.printed(), *own.rates) for q in p.inputs}
    taken = {n: [rows[c] for c in named.get(n, ())] for n in function.name_in()}
    taken |= {"parameters": given["parameters"]} if "parameters" in taken else {}
    return ca.vertcat(*(function(**taken)[n] for n in function.name_out()))


@pytest.mark.long
@pytest.mark.parametrize("name", KINDS)
def test_the_packed_functions_are_the_scenes_own(name: str, tmp_path: Path) -> None:
    module = module_of(name, tmp_path)
    given, step = drawn(module), KINDS[name].split('"')[-2].removesuffix("_jacobian")
    step = "step_rk4_unit" if name == "satellite" else step
    assert module.ode().name_in() == ["x", "u", "parameters"]
    assert module.step().name_in() == ["x", "u", "time_step", "parameters"]
    rate = module.ode()(given["x"], given["u"], given["parameters"])
    after = module.step()(given["x"], given["u"], given["time_step"], given["parameters"])
    assert float(ca.norm_inf(rate - unpacked(module, module.state_rate(), given))) == 0
    assert float(ca.norm_inf(after - unpacked(module, getattr(module, step)(), given))) == 0


@pytest.mark.long
@pytest.mark.parametrize("name", KINDS)
def test_module_and_json_say_the_same(name: str, tmp_path: Path) -> None:
    module, said = module_of(name, tmp_path), json.loads(manifest(made(name), ()))
    for names, quantities in (
        (module.STATES, said["packed"]["x"]),
        (module.INPUTS, said["packed"]["u"]),
        (module.PARAMETERS, said["parameters"]),
    ):
        assert [c for q in quantities for c in q["components"]] == names
        for q in quantities:
            for c in q["components"]:
                assert module.UNITS[c] == q["unit"]
                assert q["range"] in (None, module.RANGES[c])
                assert module.SCALES[c] == q.get("scale", module.SCALES[c])


@pytest.mark.parametrize("name", ["satellite", "quadrotor", "cart_pendulum"])
def test_errors_vanish_at_the_target_for_either_sign_and_have_derivatives(
    name: str, tmp_path: Path
) -> None:
    module = module_of(name, tmp_path)
    q = [k for k, c in enumerate(module.STATES) if c.startswith("attitude")]
    target = np.array(drawn(module)["x"])
    target[q] /= np.linalg.norm(target[q]) if q else 1
    other = target.copy()
    other[q] *= -1
    error, x = module.error(), ca.MX.sym("x", len(target))
    assert error.size1_out(0) == len(target) - bool(q)
    slopes = ca.Function("slopes", [x], [ca.jacobian(error(x, target), x)])
    for state in (target, other):
        assert float(ca.norm_inf(error(state, target))) < 1e-15 * max(abs(target))
        found = np.array(ca.DM(slopes(state)))
        assert np.linalg.matrix_rank(found) == len(target) - bool(q)
        assert np.isfinite(found).all()


@pytest.mark.long
def test_a_small_error_of_attitude_is_its_rotation_vector(tmp_path: Path) -> None:
    module = module_of("satellite", tmp_path)
    vector = np.array([1e-5, -2e-5, 3e-5])
    q = ca.vertcat(1, *(vector / 2))
    found = module.error()(ca.vertcat(q, 0, 0, 0), [1, 0, 0, 0, 0, 0, 0])
    assert np.allclose(np.array(found)[:3, 0], vector, atol=1e-14)


def test_gravity_stands_beside_a_control_moment(tmp_path: Path) -> None:
    module = imported("top_casadi", casadi_file(library(parse_scene(PUSHED, "top"))), tmp_path)
    assert module.INPUTS == ["c_x", "c_y"]
    still = [1, 0, 0, 0, 0, 0, 0]
    assert np.array(module.ode()(still, [0.5, -1], [2, 1]))[4:6, 0].tolist() == [0.25, -0.5]


def test_a_scene_whose_rates_nobody_wants_has_no_packed_functions(tmp_path: Path) -> None:
    own = library(parse_scene(text_of("edge_runner_flat"), "runner"))
    module = imported("runner_casadi", casadi_file(own), tmp_path)
    assert not hasattr(module, "ode")
    assert json.loads(manifest(own, ()))["packed"] is None
