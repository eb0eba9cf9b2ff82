"""Every quantity that a function takes or gives says what it is, and in which unit."""

import json
import re
from pathlib import Path

import pytest

from derive.emit.files import manifests
from derive.emit.page.equation import written_names
from derive.mechanics.mechanism import mechanism
from derive.program.program import Quantity
from derive.scene import SceneError, parse_scene
from tests.made import scene_of

ROOT = Path(__file__).parents[2]
PAGES = [(ROOT / "docs" / f"{page}.md").read_text("utf-8") for page in ("scenes", "motion")]
EXAMPLES = [t for page in PAGES for t in re.findall(r"^```toml\n(.*?)^```$", page, re.M | re.S)]
FILES = sorted((ROOT / "tests").glob("*/*/*.toml"))
GENERATED = manifests(ROOT / "generated")
LONG = """
wanted = ["bearing", "phi_rate"]
parameters.m = { unit = "kg", range = [1, 2] }
[coordinates]
psi.unit = "rad"
psi.range = [-1, 1]
psi.rate.range = [1, 2]
psi.acceleration.range = [1, 2]
phi = { unit = "rad", range = [-1, 1] }
[speeds]
W = { unit = "rad/s", range = [1, 2], rate = { range = [1, 2] }, components = ["x", "y"] }
[inputs]
T = { unit = "N m", range = [1, 2] }
[frames]
arm = { angular_velocity = ["W_x", "W_y", "psi_dot"] }
[bodies]
bob = { frame = "arm", shape = "box", mass = "m", lengths = [1, 2, 3], turned = ["x phi", "z psi"] }
[loads]
motor = { on = "bob", couple = ["T", 0, 0] }
hold = { on = "bob", force = ["?bearing_x", "?bearing_y", 0], couple = [0, "?M", "?bearing_z"] }
[results]
phi_rate = "M/m"
"""


def without(quantities: list[tuple[str, str, str]]) -> list[str]:
    """Return the names of those that do not say what they are, or not in which unit."""
    return [name for name, unit, says in quantities
            if not says or not (unit or " unit" in says)]  # fmt: skip


def told(quantities: tuple[Quantity, ...]) -> list[tuple[str, str, str]]:
    """Return name, unit and meaning of quantities."""
    return [(q.name, q.unit, q.meaning) for q in quantities]


@pytest.mark.parametrize("file", GENERATED, ids=lambda f: f.stem)
def test_every_argument_of_the_catalogue_has_a_meaning_and_a_unit(file: Path) -> None:
    functions = json.loads(file.read_text(encoding="utf-8"))["functions"]
    found = [a for f in functions for a in f["arguments"]]
    assert without([(a["name"], a["unit"], a["meaning"]) for a in found]) == []


@pytest.mark.parametrize("text", [LONG, *EXAMPLES, *(f.read_text("utf-8") for f in FILES)])
def test_every_quantity_of_other_scenes_has_a_meaning_and_a_unit(text: str) -> None:
    try:
        known = mechanism(parse_scene(text, "example"))
    except SceneError:
        return
    for one in (known, *([known.inverse] if known.inverse else [])):
        assert without(told(one.vocabulary.every())) == []


def test_a_result_named_as_the_rate_of_a_state_is_given_in_its_own_unit() -> None:
    known = mechanism(parse_scene(LONG, "example"))
    (rate,) = known.problem("phi_rate").outputs
    assert (rate.unit, rate.meaning) == ("m^2/s^2", "M/m")
    names = written_names(known)
    assert names[known.vocabulary.symbols["phi_rate"]] == "phi_rate"  # and no dot over phi


def test_components_of_several_units_are_not_given_in_that_of_the_first() -> None:
    (bearing,) = mechanism(parse_scene(LONG, "example")).problem("bearing").outputs
    assert (bearing.unit, bearing.frame, bearing.meaning) == ("", "arm", (
        "force of hold on bob along x; force of hold on bob along y; "
        "couple of hold on bob along z, each in its own unit"))  # fmt: skip


HINGED = """
wanted = ["pin", "push", "angular_momentum", "kinetic_energy", "accelerations"]
[coordinates]
psi = { unit = "rad", range = [-1, 1], rate.range = [1, 2], acceleration.range = [1, 2] }
[speeds]
u = { unit = "rad/s", range = [1, 2] }
[frames]
arm = { turned = ["z psi"] }
rod = { parent = "arm", angular_velocity = [0, 0, "u"] }
[bodies]
bob = { frame = "arm", shape = "box", mass = 1, lengths = [1, 2, 3], centre = [1, 0, 0] }
tip = { frame = "rod", shape = "box", mass = 1, lengths = [1, 2, 3] }
[loads]
pin = { on = "bob", along = "inertial", force = "?pin", couple = ["?twist_y", "?twist_z", 0] }
ground = { on = "tip", against = "bob", force = ["?a", "?b", "-?push"] }
drive = { on = "bob", couple = [0, 0, "?drive_z"] }
[angular_momentum]
frame = "arm"
at = [1, 0, 0]
"""


def test_forces_and_momenta_say_along_which_axes_they_lie_and_of_which_bodies_they_are() -> None:
    said = {q.name: (q.frame, q.meaning)
            for q in mechanism(parse_scene(HINGED, "example")).vocabulary.outputs}  # fmt: skip
    assert said["pin"] == ("inertial", "force of pin on bob")
    assert said["pin_y"] == ("inertial", "force of pin on bob along y")
    assert said["twist_z"] == ("inertial", "couple of pin on bob along y")
    assert said["a"] == ("rod", "force of ground on tip against bob along x")
    assert said["push"] == (
        "rod", "unknown of the force (a, b, -push) of ground on tip against bob")  # fmt: skip
    assert said["drive_z"] == ("arm", "couple of drive on bob along z")
    assert said["angular_momentum"] == (
        "arm", "angular momentum of bob, tip about (1, 0, 0) of arm")  # fmt: skip
    assert said["u_dot"][1] == "rate of u"


@pytest.mark.parametrize("file", GENERATED, ids=lambda f: f.stem)
def test_every_load_sought_and_momentum_of_the_catalogue_names_its_axes(file: Path) -> None:
    made = json.loads(file.read_text(encoding="utf-8"))
    header = file.with_name(f"{file.stem}_f64.h").read_text(encoding="utf-8")
    names = {u.name.removesuffix(f"_{a}") for u in scene_of(file.stem).unknowns for a in " xyz"}
    for a in (a for f in made["functions"] for a in f["arguments"]):
        if a["direction"] == "out" and a["name"] in {*names, "angular_momentum"}:
            assert a["frame"]
            size = f"[{len(a['components'])}]" if a["type"] == "array" else ""
            assert f"{a['name']}{size}  {a['unit']}  along {a['frame']}  " in header


ONE_BODY = re.compile(r"(F|M|T|K|l|l_dot|l_N_dot) = ")


@pytest.mark.parametrize("file", GENERATED, ids=lambda f: f.stem)
def test_equations_of_a_body_are_said_to_be_so_where_there_are_several(file: Path) -> None:
    functions = json.loads(file.read_text(encoding="utf-8"))["functions"]
    header = file.with_name(f"{file.stem}_f64.h").read_text(encoding="utf-8")
    several = len(scene_of(file.stem).bodies) > 1
    for p in (p for f in functions for p in f.get("postconditions", ())):
        own = ONE_BODY.match(p["equation"]) is not None
        assert p["holds"].startswith("for each body") == (several and own), p
    assert ("Follows from, for each body" in header) == any(
        p["holds"].startswith("for each body")
        for f in functions for p in f.get("postconditions", ()))  # fmt: skip
    for f in functions:
        moments = [p for p in f.get("postconditions", ()) if p["equation"].startswith("M = ")]
        assert len(moments) < 2 or all("M about" in p["holds"] for p in moments), moments


@pytest.mark.parametrize("file", GENERATED, ids=lambda f: f.stem)
def test_pages_say_of_constants_what_the_data_say(file: Path) -> None:
    setup = json.loads(file.read_text(encoding="utf-8"))["functions"][0]
    page = file.with_suffix(".html").read_text(encoding="utf-8")
    assert (setup["name"] == "setup") == ("operations on pairs of floats; " in page)
    if setup["name"] == "setup":
        assert f"operations on pairs of floats; {setup['error']}." in page


def test_what_is_given_without_a_word_is_called_by_its_kind() -> None:
    words = mechanism(parse_scene(LONG, "example")).vocabulary
    said = {q.name: q.meaning for q in words.every()}
    assert [said[n] for n in ("m", "psi", "psi_dot", "psi_ddot", "W", "W_dot", "T")] == [
        "parameter m", "coordinate psi", "rate of psi", "acceleration of psi", "speed W",
        "rate of W", "input T",
    ]  # fmt: skip
    assert scene_of("gyrostat").parameters[0].meaning == "moment of inertia about x, wheels locked"
