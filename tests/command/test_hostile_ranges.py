"""Ranges as large or small as TOML can write them: a scene is made or refused, never warned of.

Warnings are errors here, and the blanket that covers the command line lies above ``made``.
"""

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from derive import cli
from derive.library.library import library
from derive.scene import SceneError, load, parse_scene
from derive.solve.generation import made
from derive.verify.kept import Measuring
from derive.verify.prove import ProofError
from derive.verify.search import Sampling
from tests.made import thinned

FEW = Measuring(Sampling(64, 1, 64, 2, 2, 1, 1, 1), None)
BODY = """
wanted = ["{wanted}"]
[parameters]
A = {{ unit = "kg m^2", range = {inertia} }}
[axes]
fixed_in = "body"
attitude = "quaternion"
[body]
kind = "axisymmetric"
axis = "z"
axial = "A"
transverse = "1.5*A"
[known]
angular_velocity = {{ range = {speed} }}
moment = [0, 0, 0]
[motion]
{time} = {{ range = {span} }}
"""
TIMES = {
    "time": ("flow_exact",),
    "time_step": ("step_dmv", "step_split", "step_rk4", "step_rk4_compensated", "step_taylor12"),
}
SPANS = ("[0, 1e30]", "[0, 1e300]", "[1e-300, 1e-299]", "[-1e38, 1e38]", "[0, 1e-45]")
MOTIONS = [
    (name, "[1, 2]", "[-10, 10]", time, span)
    for time, names in TIMES.items()
    for name, span in product(names, SPANS)
]
INERTIAS = ("[1e-300, 1e-299]", "[1e37, 3e38]", "[1e-44, 1e-43]", "[1e-38, 1e38]")
SPEEDS = ("[-1e38, 1e38]", "[1e-300, 1e-299]", "[-1e300, 1e300]")
LECTURE = ("acceleration", "kinetic_energy", "acceleration_jacobian", "angular_momentum_rate")
BODIES = [
    (*case, "time_step", "[0, 1]") for case in product((*LECTURE, "step_rk4"), INERTIAS, SPEEDS)
]
BEYOND = "must fit a float, up to 3.4e38"


def outcome(path: Path, *case: str) -> str:
    """Return the sentence that refuses a scene, "" if it is made."""
    names = ("wanted", "inertia", "speed", "time", "span")
    text = BODY.format(**dict(zip(names, case, strict=True)))
    file = path / "hostile.toml"
    file.write_text(text, encoding="utf-8")
    try:
        made(library(load(str(file))), FEW)
    except (SceneError, ProofError) as error:
        return str(error)
    return ""


@pytest.mark.long
@pytest.mark.parametrize("case", [*thinned(MOTIONS, 15), *thinned(BODIES, 20)], ids=" ".join)
def test_a_hostile_range_is_measured_or_refused_by_one_sentence(
    case: tuple[str, ...], tmp_path: Path
) -> None:
    says = outcome(tmp_path, *case)
    assert says == "" or says.startswith("scene 'hostile': ")
    assert (BEYOND in says) == any("e300]" in part for part in case) or "inertia" in says


@pytest.mark.parametrize(("time", "name"), [("time", "flow_exact"), ("time_step", "step_rk4")])
def test_a_time_beyond_the_floats_is_refused_by_its_name(
    time: str, name: str, tmp_path: Path
) -> None:
    says = outcome(tmp_path, name, "[1, 2]", "[-10, 10]", time, "[0, 1e300]")
    assert says == f"scene 'hostile': the range of '{time}' {BEYOND}, not 1e+300"


def test_no_command_lets_a_warning_of_numpy_through(monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[object] = []

    def seen(_: object) -> int:
        found.extend(np.geterr().values())
        return 0

    monkeypatch.setitem(cli.COMMANDS, "lecture", (lambda p: p.set_defaults(run=seen), "says", ()))
    assert cli.main(["lecture"]) == 0
    assert set(found) == {"ignore"}


HEAVY = """
wanted = ["kinetic_energy"]
[parameters]
m = { unit = "kg", range = [1, 8.31e34] }
r = { unit = "m", range = [1e-10, 1e-9] }
[body]
shape = "box"
mass = "m"
lengths = ["r", "2*r", "3*r"]
"""


@pytest.mark.long
def test_a_small_energy_that_set_up_cannot_compute_is_not_called_too_large() -> None:
    with pytest.raises(SceneError, match="a value on the way to it, in set-up too, is too large"):
        made(library(parse_scene(HEAVY, "heavy")), FEW)
