"""Every quantity that a function takes or gives says what it is, and in which unit."""

import json
import re
from pathlib import Path

import pytest

from derive.emit.page.equation import written_names
from derive.mechanics.mechanism import mechanism
from derive.program.program import Quantity
from derive.scene import SceneError, parse_scene
from tests.made import scene_of

ROOT = Path(__file__).parents[2]
PAGES = [(ROOT / "docs" / f"{page}.md").read_text("utf-8") for page in ("scenes", "motion")]
EXAMPLES = [t for page in PAGES for t in re.findall(r"^```toml\n(.*?)^```$", page, re.M | re.S)]
FILES = sorted((ROOT / "tests").glob("*/*/*.toml"))
GENERATED = sorted((ROOT / "generated").glob("*/*.json"))
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
    assert (bearing.unit, bearing.meaning) == ("", "force of hold, each in its own unit")


def test_what_is_given_without_a_word_is_called_by_its_kind() -> None:
    words = mechanism(parse_scene(LONG, "example")).vocabulary
    said = {q.name: q.meaning for q in words.every()}
    assert [said[n] for n in ("m", "psi", "psi_dot", "psi_ddot", "W", "W_dot", "T")] == [
        "parameter m", "coordinate psi", "rate of psi", "acceleration of psi", "speed W",
        "rate of W", "input T",
    ]  # fmt: skip
    assert scene_of("gyrostat").parameters[0].meaning == "moment of inertia about x, wheels locked"
