"""The lecture steps that a function names are those whose condition its scene has, and no others.

What a scene has is told by its declarations and by positions of particles alone: which points are
accelerated, which bodies keep a point where it is, how many turns a body makes.
"""

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from mpmath import mp

from derive.mechanics.mechanism import Mechanism, mechanism
from derive.program.precision import F64
from derive.scene import Scene, SceneError, catalogue, parse_scene
from derive.scene.machine import INERTIAL, Force
from derive.scene.wanted import ATTITUDES, moves, without_ending
from derive.verify.cloud import answers
from derive.verify.cloud.history import History
from derive.verify.cloud.series import DIGITS, each
from derive.verify.sample import samples
from tests.made import scene_of, thinned

ROOT = Path(__file__).parents[2]
EXAMPLES = re.findall(
    r"^```toml\n(.*?)^```$", (ROOT / "docs" / "scenes.md").read_text("utf-8"), re.M | re.S
)
FILES = [str(f.relative_to(ROOT)) for f in sorted((ROOT / "tests").glob("*/*/*.toml"))]
OTHERS = [*(str(n) for n, t in enumerate(EXAMPLES) if not t.startswith("# scene")), *FILES]
NOTHING = 1e-30  # of numbers of a machine's own size, which have 50 digits and more
FORMS = ("moving_point_form", "any_point_form", "acceleration_seen_from_axes")


@cache
def known_of(name: str) -> Mechanism:
    """Return a scene of the catalogue, an example of the page by its number, or a file."""
    if name in catalogue():
        return mechanism(scene_of(name))
    text = EXAMPLES[int(name)] if name.isdigit() else (ROOT / name).read_text("utf-8")
    return mechanism(parse_scene(text, "example"))


def functions(known: Mechanism) -> list[str]:
    """Return the functions of a scene that the lecture states."""
    wanted = [w for w in known.scene.wanted if not moves(w) and w not in ATTITUDES]
    return [*dict.fromkeys(map(without_ending, wanted))]


def history(known: Mechanism, scene: Scene) -> History:
    """Return a scene in motion at a sample; accelerations that are to be found are some number."""
    values = dict(samples(known, F64, 1, 0).each[0].values)
    free = [m.unknown for m in (*scene.coordinates, *scene.speeds) if m.free]
    with mp.workdps(DIGITS):
        found = answers(scene, values | dict.fromkeys(free, 0.7))
        return History(scene, {**dict.fromkeys(found.names, mp.mpf("0.7")), **found.given})


def accelerated(seen: History, scene: Scene) -> Iterator[Any]:
    """Yield the accelerations of all points that a balance may be about."""
    with mp.workdps(DIGITS):
        loads = [load for load in scene.loads if isinstance(load, Force)]
        places = [(load.frame, load.at) for load in loads]
        points = [*seen.origins.values(), *(seen.centre(b.name) for b in scene.bodies)]
        for at in (*points, *(seen.place(*place) for place in places)):
            yield max(abs(x) for x in each(lambda x: x.rate().velocity, at))


def turns(scene: Scene, name: str) -> int:
    """Return how often a frame, or a body, turns on the way from the inertial frame."""
    frames = _way(scene, name)
    return sum(len(f.turned) + (f.angular_velocity is not None) for f in frames)


def denied(known: Mechanism, function: str, steps: tuple[str, ...]) -> set[str]:
    """Return the steps of a function whose condition does not occur in its scene."""
    scene = known.posed(function).scene
    balances = known.whole(function).balances
    seen = history(known, scene)
    moved = any(a > NOTHING for a in accelerated(seen, scene))
    own = [turns(scene, b.frame) + len(b.turned) for b in scene.bodies]
    fixed = [
        all(f.velocity is None and f.acceleration is None and f.rolls is None for f in way)
        for way in (_way(scene, b.frame) for b in scene.bodies)
    ]
    has = {
        **dict.fromkeys(FORMS, moved),
        "angular_velocities_add": max(own) > 1,
        "mass_centre_motion": any(b.kind == "force" for b in balances) or "linearised" in function,
        "general_form": bool(balances) or not set(steps) & {"angular_momentum"},
        "koenig": not all(fixed) or moved,
        "kinetic_energy_about_point": any(fixed),
        "quaternion_rate_scalar": any(f.attitude for f in scene.frames),
        "transport_theorem": max(own) > 0,
    }
    return {step for step in steps if not has.get(step, True)}


def _way(scene: Scene, name: str) -> list[Any]:
    frame = scene.frame(name)
    return [] if name == INERTIAL else [frame, *_way(scene, frame.parent)]


def unneeded(name: str) -> dict[str, set[str]]:
    """Return the steps that functions of a scene name without need."""
    known = known_of(name)
    found = {f: denied(known, f, known.problem(f).steps) for f in functions(known)}
    return {f: steps for f, steps in found.items() if steps}


@pytest.mark.parametrize("name", thinned(catalogue(), 2))
def test_no_function_of_the_catalogue_names_a_step_that_its_scene_does_not_need(name: str) -> None:
    assert unneeded(name) == {}


@pytest.mark.long
@pytest.mark.parametrize("name", OTHERS)
def test_no_function_of_another_scene_names_a_step_that_it_does_not_need(name: str) -> None:
    try:
        assert unneeded(name) == {}
    except SceneError as refused:
        pytest.skip(str(refused))


NEEDED = (
    ("heavy_top", "kinetic_energy", "kinetic_energy_about_point"),
    ("rigid_body", "kinetic_energy", "koenig"),
    ("free_body", "kinetic_energy", "energy_of_turning"),
    ("rod_wire_vertical_shaft", "T", "any_point_form"),
    ("centrifuge_gondola", "M", "moving_point_form"),
    ("gyrocompass", "period_s", "general_form"),
    ("torque_free_axisymmetric", "L", "angular_momentum"),
)


@pytest.mark.parametrize(("name", "function", "step"), NEEDED)
def test_a_step_that_a_function_needs_is_named(name: str, function: str, step: str) -> None:
    assert step in known_of(name).problem(function).steps


@pytest.mark.parametrize("step", [*FORMS, "angular_velocities_add", "mass_centre_motion"])
def test_a_step_that_a_plain_body_does_not_need_is_noticed(step: str) -> None:
    assert denied(known_of("free_body"), "moment", ("general_form", step)) == {step}


STEM = """
wanted = ["drive"]
speeds.W = { unit = "rad/s", range = [0.1, 2], rate = { range = [-1, 1] } }
frames.arm.angular_velocity = ["0", "0", "W"]
bodies.bob = { frame = "arm", kind = "principal", moments = [1, 2, 2], mass = 3 }
loads.pin = { on = "bob", force = "?pin", couple = ["?drive_x", "?side", "?turn"] }
results.drive = "drive_x*2"
"""


def test_a_result_may_have_the_stem_of_an_unknown_that_it_is_made_of() -> None:
    assert mechanism(parse_scene(STEM, "stem")).problem("drive").outputs[0].name == "drive"
