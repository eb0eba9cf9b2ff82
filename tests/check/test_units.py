"""Every unit that is stated is the one that the emitted function has: it scales as its unit does.

Lengths, masses and times are counted in other units, by powers of two, and what comes back must be
the same quantities in those units. Nothing here knows how a formula was made.
"""

import importlib.util
import json
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import casadi
import pytest

from derive.emit.files import manifests
from derive.scene import SceneError, parse_scene
from derive.scene.unit import BESIDE_SI, behind, dimension, misnamed
from tests.made import thinned

GENERATED = Path(__file__).parents[2] / "generated"
SCENES = manifests(GENERATED)
Units = tuple[float, float, float]
SI, OTHER = (
    (1.0, 1.0, 1.0),
    (2.0**4, 2.0**6, 2.0**-4),
)  # of a metre, kilogram, second: even powers, for square roots
ROUNDING = 1e-9  # powers of two change no digit, but the last terms of series may come and go
MIXED = ""  # of constants, matrices and derivatives, whose components differ


def factor(unit: str, units: Units) -> float:
    """Return how many of these units of length, mass and time a unit is."""
    powers = dimension(BESIDE_SI.get(unit, (unit, ""))[0])
    found = 1.0
    for base, power in zip(units, powers, strict=True):
        found *= base ** float(power)
    return found


def loaded(path: Path, described: Mapping[str, Any]) -> Any:
    """Return the CasADi module of a scene."""
    file = path.parent / described["files"]["casadi"]
    spec = importlib.util.spec_from_file_location(path.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def values(argument: Mapping[str, Any], units: Units) -> list[float]:
    """Return values inside an argument's range, counted in these units."""
    low, high = argument["range"] or (-1.0, 1.0)
    count = len(argument["components"])
    found = [low + (high - low) * (0.55 + 0.3 * k / count) for k in range(count)]
    if argument["unit"] == MIXED:
        return [0.0] * count
    return [x * factor(argument["unit"], units) for x in found]


def results(
    made: Any,
    names: Sequence[str],
    described: Mapping[str, Any],
    function: Mapping[str, Any],
    units: Units,
) -> dict[str, Any]:
    """Return what a function of CasADi makes of those values, by output."""
    own = {q["name"]: q for q in described["parameters"]}
    given = {"parameters": [x for name in names for x in values(own[name], units)]}
    given |= {a["name"]: values(a, units) for a in function["arguments"] if a["direction"] == "in"}
    known = {name: casadi.DM(x) for name, x in given.items() if name in made.name_in()}
    return {name: x.full().ravel() for name, x in made.call(known).items()}


def moves_or_derives(name: str) -> bool:
    """Return whether a function is a step, a motion or a derivative, which take long to build."""
    return name.startswith(("step_", "flow_", "plan_")) or "_jacobian" in name


def contradictions(
    path: Path, described: Mapping[str, Any], skipped: Callable[[str], bool] = moves_or_derives
) -> list[str]:
    """Return the outputs that do not scale as their units say."""
    module, found = loaded(path, described), []
    for function in described["functions"]:
        if function["name"] == "setup" or "same_as" in function or skipped(function["name"]):
            continue
        made = getattr(module, function["name"])()
        names = getattr(module, "PARAMETERS", ())
        here, there = (results(made, names, described, function, u) for u in (SI, OTHER))
        for q in function["arguments"]:
            if q["direction"] == "out" and q["unit"] != MIXED:
                x, y, ratio = here[q["name"]], there[q["name"]], factor(q["unit"], OTHER)
                if not abs(y / ratio - x).max() <= ROUNDING * abs(x).max():
                    found.append(f"{function['name']}: {q['name']} in {q['unit']}")
    return found


@pytest.mark.parametrize("path", thinned(SCENES, 5), ids=lambda p: p.stem)
def test_every_output_has_the_unit_that_is_stated(path: Path) -> None:
    assert contradictions(path, json.loads(path.read_text(encoding="utf-8"))) == []


@pytest.mark.long
@pytest.mark.parametrize("path", thinned(SCENES, 5), ids=lambda p: p.stem)
def test_every_step_and_derivative_has_the_units_that_are_stated(path: Path) -> None:
    described = json.loads(path.read_text(encoding="utf-8"))
    assert contradictions(path, described, lambda name: not moves_or_derives(name)) == []


def test_a_wrong_unit_is_seen() -> None:
    path = GENERATED / "rigid_body" / "rigid_body.json"
    text = path.read_text(encoding="utf-8").replace('"unit": "J"', '"unit": "W"')
    assert contradictions(path, json.loads(text)) == ["kinetic_energy: kinetic_energy in W"]


@pytest.mark.parametrize("path", thinned(SCENES, 5), ids=lambda p: p.stem)
def test_no_name_claims_a_unit_that_is_not_its_own(path: Path) -> None:
    described = json.loads(path.read_text(encoding="utf-8"))
    arguments = [a for f in described["functions"] for a in f["arguments"]]
    assert [d for a in arguments if (d := misnamed(a["name"], a["unit"]))] == []


def test_no_number_on_a_page_is_followed_by_the_unit_one() -> None:
    for page in GENERATED.rglob("*.html"):
        assert not re.search(r"= -?[0-9.e+-]+ 1(?![/\w])", page.read_text(encoding="utf-8")), page
    assert behind("1") == ""


CLOCK = """
wanted = ["turn_minutes"]
[parameters]
J = { unit = "kg m^2", range = [1, 2], meaning = "moment" }
[speeds]
w = { unit = "rad/s", range = [1, 2], rate = 0, meaning = "rate" }
[frames]
body.angular_velocity = ["0", "0", "w"]
[bodies]
body = { frame = "body", kind = "axisymmetric", axis = "z", axial = "J", transverse = "J" }
[results]
"""


def test_a_result_may_be_given_in_a_unit_beside_si_and_is_then_no_part_of_formulas() -> None:
    given = CLOCK + 'turn_minutes = { formula = "2*pi/w", unit = "min" }\n'
    scene = parse_scene(given, "clock")
    (result,) = scene.results  # type: ignore[union-attr]
    assert (result.unit, str(result.formula)) == ("min", "2*pi/w/60")
    assert not any("turn_minutes" in warning for warning in scene.warnings)
    with pytest.raises(SceneError, match="turn_minutes"):
        parse_scene(given + 'twice = "2*turn_minutes"\n', "clock")


def test_a_unit_that_is_not_that_of_the_formula_is_refused_and_a_name_that_says_so_doubted() -> (
    None
):
    with pytest.raises(SceneError, match="a formula in s cannot be given in 'm'"):
        parse_scene(CLOCK + 'turn_minutes = { formula = "2*pi/w", unit = "m" }\n', "clock")
    with pytest.raises(SceneError, match="unknown part 'fortnight'"):
        parse_scene(CLOCK + 'turn_minutes = { formula = "2*pi/w", unit = "fortnight" }\n', "clock")
    doubted = parse_scene(CLOCK + 'turn_minutes = "2*pi/w/60"\n', "clock")
    assert "'turn_minutes' is called after minutes, but its unit is s" in doubted.warnings
