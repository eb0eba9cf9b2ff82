"""Drawings: bodies with their shapes, names apart and within the picture, the same everywhere."""

import re
import xml.etree.ElementTree as ET
from functools import cache
from itertools import combinations

import pytest

from derive.command.new import STARTERS
from derive.emit.drawing.drawing import HEIGHT, WIDTH, drawing, hull
from derive.emit.drawing.label import Wanted, placed_labels
from derive.emit.drawing.parts import solids
from derive.emit.drawing.pose import stance
from derive.emit.drawing.sight import hidden, painted, sight
from derive.scene import catalogue, load, parse_scene
from derive.scene.wanted import attitudes_only
from tests.made import thinned

Box = tuple[float, float, float, float]
EM = {True: 8.0, False: 11.0}  # px: indices and letters, as the style says
MACHINE = """
wanted = ["M"]
[parameters]
m = { unit = "kg", value = 1 }
r = { unit = "m", value = 0.2 }
h = { unit = "m", value = 0.6 }
w = { unit = "rad/s", range = [1, 2] }
[frames.arm]
angular_velocity = ["0", "0", "w"]
[bodies.one]
frame = "arm"
mass = "m"
SHAPE
[loads]
hub = { on = "one", force = "?F", couple = "?M" }
"""
SHAPES = {
    "cylinder": 'axis = "z"\nradius = "r"\nlength = "h"',
    "disc": 'axis = "x"\nradius = "r"',
    "hoop": 'axis = "x"\nradius = "r"',
    "cone": 'axis = "z"\nradius = "r"\nheight = "h"',
    "rod": 'axis = "x"\nlength = "h"',
    "sphere": 'radius = "r"',
    "hollow_sphere": 'radius = "r"',
    "tube": 'axis = "x"\ninner = "r/2"\nouter = "r"\nlength = "h"',
    "box": 'lengths = ["r", "h", "2*r"]',
    "plate": 'axis = "z"\nlengths = ["r", "h"]',
    "blades": 'axis = "z"\nnumber = 3\nlength = "h"',
    "point": "",
}


@cache
def drawn(name: str) -> ET.Element:
    """Return the drawing of a scene of the catalogue; anything but well-formed XML is an error."""
    return ET.fromstring(drawing(load(name)))  # noqa: S314 (made here)


def machine(shape: str) -> str:
    """Return a scene whose one body has a shape."""
    return MACHINE.replace("SHAPE", f'shape = "{shape}"\n{SHAPES[shape]}')


def boxes(picture: ET.Element) -> list[tuple[str, Box]]:
    """Return the names of a drawing and where they stand, three fifths of an em a letter."""
    found = []
    for text in picture.iter("text"):
        x, y = float(text.attrib["x"]), float(text.attrib["y"])
        parts = [(text.text or "", False)]
        for span in text.iter("tspan"):
            parts += [(span.text or "", "n" in span.attrib["class"]), (span.tail or "", False)]
        wide = sum(0.6 * EM[small] * len(letters) for letters, small in parts)
        found.append(("".join(p for p, _ in parts), (x, y - 8.0, x + wide, y + 2.5)))
    return found


def wider(box: Box) -> Box:
    """Return a name's place with what keeps it apart from others: the gap between two words."""
    return box[0] - 3.5, box[1] - 3.5, box[2] + 3.5, box[3] + 3.5


def collide(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


@pytest.mark.parametrize("name", thinned(catalogue(), 3))
def test_names_stand_apart_and_within_the_picture(name: str) -> None:
    each = boxes(drawn(name))
    assert each
    assert [(a, b) for (a, p), (b, q) in combinations(each, 2) if collide(p, q)] == []
    outside = [a for a, (x, y, u, v) in each if min(x, y) < 0 or u > WIDTH or v > HEIGHT]
    assert outside == []


def test_names_that_want_one_place_are_parted_and_kept_within() -> None:
    wanted = [Wanted("axis", "omega_x", (5.0, 5.0), (-1.0, -1.0))] * 6
    found = placed_labels(wanted, [], (120.0, 90.0))
    assert not any(collide(a.box, b.box) for a, b in combinations(found, 2))
    assert all(min(label.box) >= 0 for label in found)
    assert not any(collide(wider(a.box), b.box) for a, b in combinations(found, 2))
    assert collide((0, 0, 2, 2), (1, 1, 3, 3))
    assert len(found) == 6
    assert 0 < len(placed_labels(wanted, [], (60.0, 25.0))) < 6  # no room for all


@pytest.mark.parametrize("shape", SHAPES)
def test_a_body_is_drawn_with_its_shape_as_large_as_it_is(shape: str) -> None:
    found = stance(parse_scene(machine(shape), shape))
    own = solids(found, sight(found).towards)
    assert {s.kind for s in own} <= {"solid", "rod", "hoop", "mass"}
    points = [p for s in own for p in s.corners]
    spans = [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)]
    r, h = 0.2, 0.6
    true = {
        "cylinder": (2 * r, 2 * r, h), "disc": (0, 2 * r, 2 * r), "hoop": (0, 2 * r, 2 * r),
        "cone": (2 * r, 2 * r, h), "rod": (h, 0, 0), "sphere": (2 * r,) * 3,
        "hollow_sphere": (2 * r,) * 3, "tube": (h, 2 * r, 2 * r), "box": (r, h, 2 * r),
        "plate": (r, h, 0), "blades": (1.5 * h, 3**0.5 * h, 0), "point": (0, 0, 0),
    }[shape]  # fmt: skip
    slack = 0.16 * max(*true, r)  # a disc, a plate and a blade are drawn with a little thickness
    assert spans == pytest.approx(true, abs=slack if 0 in true else 1e-9 + 2e-3 * r)
    assert len(own) == (3 if shape == "blades" else 1)
    text = drawing(found.machine)
    assert f"one, a {shape.replace('_', ' ')}" in ET.fromstring(text).attrib["aria-label"]  # noqa: S314


@pytest.mark.parametrize("name", thinned(catalogue(), 8))
def test_an_ellipsoid_stands_only_where_no_shape_is_known(name: str) -> None:
    scene = load(name)
    kinds = {e.attrib["class"] for e in drawn(name).iter("path")}
    shapeless = [b for b in scene.bodies if not b.parts and None not in b.inertia]
    drawn_so = bool(shapeless) and not attitudes_only(list(scene.wanted))
    assert ("inertia" in kinds) == drawn_so


def test_bodies_whose_inertia_differs_look_different() -> None:
    pictures = {name: drawing(load(name)) for name in ("t_handle_flip", "tumbling_body")}
    bodies = [re.findall('class="inertia" d="[^"]*"', text) for text in pictures.values()]
    assert bodies[0] != bodies[1]


def test_what_stands_before_is_painted_last_and_hides_what_is_behind() -> None:
    text = machine("box").replace(
        "[loads]",
        '[bodies.two]\nframe = "arm"\nshape = "disc"\naxis = "x"\nmass = "m"\nradius = "r"\n'
        'centre = ["-h", "0", "0"]\n[loads]',
    )
    found = stance(parse_scene(text, "two"))
    by = sight(found)
    own = solids(found, by.towards)
    assert [s.owner for s in painted(own, by)] == ["two", "one"]
    assert [s.owner for s in painted(own[::-1], by)] == ["two", "one"]
    assert hidden(own[0].centre, own, by, 1e-6)
    assert not hidden(tuple(5 * x for x in by.towards), own, by, 1e-6)  # type: ignore[arg-type]
    assert hidden(tuple(-5 * x for x in by.towards), own, by, 1e-6)  # type: ignore[arg-type]


def test_gravity_points_downwards_in_every_drawing() -> None:
    for name in ("sleeping_top", "rolling_cone", "disc_two_bearings"):
        ((x, y), (u, v)) = next(
            [tuple(map(float, p.split(","))) for p in re.split("[ML]", e.attrib["d"])[1:]]
            for e in drawn(name).iter("path") if e.attrib["class"] == "weight"
        )  # fmt: skip
        assert abs(u - x) < 0.2
        assert v > y + 5


def test_the_outline_of_points_is_convex() -> None:
    square = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
    assert sorted(hull((*square, (1.0, 1.0), (1.0, 0.0)))) == sorted(square)


SPRUNG = """
wanted = ["state_rate"]
[coordinates]
x = { unit = "m", range = [0.1, 0.5] }
[frames.bead]
origin = ["x", "0", "0"]
[bodies.bead]
frame = "bead"
shape = "sphere"
mass = 1
radius = 0.05
[loads]
coil = { on = "bead", spring = 2 }
rail = { on = "bead", force = ["0", "?y", "?z"], couple = "?c" }
"""


def test_force_and_couple_of_a_load_are_both_named_and_a_spring_is_one_line() -> None:
    text = drawing(parse_scene(SPRUNG, "sprung"))
    assert re.findall(r'<text class="(force|moment)"[^>]*>rail<', text) == ["force", "moment"]
    (spring,) = re.findall(r'<path class="spring[^"]*" d="([^"]*)"', text)
    assert spring.count("M") == 1


@pytest.mark.parametrize(("long", "coils"), [("0.1", 9), ("4", 3)])
def test_a_spring_that_is_short_beside_the_machine_has_few_coils(long: str, coils: int) -> None:
    bead = f'shape = "rod"\naxis = "y"\nlength = {long}'
    near = SPRUNG.replace("[0.1, 0.5]", "[0.1, 0.12]").replace('shape = "sphere"', bead)
    text = drawing(parse_scene(near.replace("radius = 0.05\n", ""), "sprung"))
    (spring,) = re.findall(r'<path class="spring[^"]*" d="([^"]*)"', text)
    assert len(re.split("[ML]", spring)) - 1 == coils + 4


@pytest.mark.parametrize("name", ["machine", "cart_pendulum", "disc_two_bearings"])
def test_no_name_lies_over_an_arrow(name: str) -> None:
    own = (STARTERS / "machine.toml").read_text() if name == "machine" else load(name).text
    text = drawing(parse_scene(own, "own"))
    arrows = [
        [tuple(map(float, p.split(","))) for p in re.split("[ML]", d)[1:]]
        for d in re.findall(r'<path class="(?:force|weight)" d="([^"]*)"', text)
    ]
    root = ET.fromstring(text)  # noqa: S314 (made here)
    for one in root.iter("text"):
        left, below = float(one.attrib["x"]), float(one.attrib["y"])
        inside = [
            p for (a, b), (c, d) in arrows for k in range(101)
            if left < (p := (a + (c - a) * k / 100, b + (d - b) * k / 100))[0] < left + 8
            and below - 7 < p[1] < below
        ]  # fmt: skip
        assert inside == [], one.text
