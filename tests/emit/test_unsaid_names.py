"""Pages and JSON of a body in short form speak of what its file says, not of how it is written."""

import json
import re
from collections.abc import Iterator

import pytest

from derive.emit.manifest import manifest
from derive.emit.page.equation import notes, passages
from derive.emit.page.scene import scene_page
from derive.library.library import Library, library
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.scene import parse_scene
from derive.scene.wanted import EQUATIONS, without_ending
from tests.lower import test_unusual_scenes as unusual
from tests.made import SHORT, library_of, scene_of, thinned

UNSAID = re.compile(r"[Ff]rame|\b[Bb]ody body|\bon body|xyz\.\w|of xyz|\bexternal:|carried|load\b")
IN_FORMULAS = re.compile(r"xyz|body|axes|inertial")
CONE = """
wanted = ["moment", "state_rate"]
axes   = { turned = ["z psi", "x theta"] }
point  = { kind = "moving", acceleration = { range = [-2, 2] } }
[parameters]
m.unit = "kg"
m.range = [0.2, 0.4]
[coordinates]
psi   = { unit = "rad", range = [-3.1, 3.1] }
theta = { unit = "rad", range = [0.1, 1.5] }
phi   = { unit = "rad", range = [-3.1, 3.1] }
[body]
shape  = "cone"
about  = "apex"
mass   = "m"
radius = 0.03
height = 0.06
axis   = "z"
turned = ["z phi"]
"""


def said(known: Mechanism) -> Iterator[tuple[str, str]]:
    """Yield sentences of a page, and the names in its formulas, each with what is wrong in it."""
    asked = dict.fromkeys(map(without_ending, known.scene.wanted))
    for base in (name for name in asked if name in EQUATIONS):
        for note in notes(known, base):
            yield note, "".join(UNSAID.findall(note))
        for line in (line for passage in passages(known, base) for line in passage.lines):
            text = re.sub(r"<[^>]+>", " ", line.mathml)
            yield text, "".join(IN_FORMULAS.findall(text))
    for sentence in known.scene.told:
        yield sentence, "".join(UNSAID.findall(sentence))


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(SHORT, 3))
def test_a_page_of_the_catalogue_names_nothing_that_its_file_does_not(name: str) -> None:
    known = mechanism(scene_of(name))
    assert known.scene.told
    assert [text for text, wrong in said(known) if wrong] == []


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(unusual.SCENES, 4))
def test_a_page_of_unusual_axes_names_nothing_that_its_file_does_not(name: str) -> None:
    found = said(mechanism(parse_scene(unusual.text_of(name), "unusual")))
    assert [text for text, wrong in found if wrong] == []


@pytest.mark.long
def test_the_whole_page_and_the_balances_of_a_cone_speak_of_the_body_and_its_axes() -> None:
    made = library(parse_scene(CONE, "cone"))
    page, (moment, *_) = scene_page(made, ()), functions(made)
    assert "The body, a cone of mass m, is symmetrical about its z axis." in page
    assert "in them the body is turned about z by phi." in page
    assert "the mass centre lies at (0, 0, 9/200) along the body" in page
    assert not re.search(r"Frame|Body body|taken to be at rest|Load", page)
    assert moment["balances"][0] == "moment on the body about the moving point along x"


def functions(made: Library) -> list[dict[str, list[str]]]:
    """Return the functions of a scene's JSON without its set-up."""
    found: list[dict[str, list[str]]] = json.loads(manifest(made, ()))["functions"]
    return [f for f in found if "balances" in f]


def test_frames_and_bodies_of_a_machine_are_noticed() -> None:
    known = library_of("edge_runner_flat").mechanism
    assert UNSAID.search("Frame axle is carried by inertial.")
    assert [n for n in notes(known, "N") if UNSAID.search(n.replace("roller", "body"))]
