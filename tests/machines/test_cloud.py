"""Every machine of the catalogue agrees with a cloud of particles of which only positions are known."""

import pytest

from derive.c_text import F64
from derive.check.particles import clouds
from derive.cloud import answers
from derive.library import Library, library
from derive.sample import samples
from derive.scene import Machine, catalogue, load, parse_scene
from derive.solve import opened, roots

MACHINES = [name for name in catalogue() if isinstance(load(name), Machine)]
FEW = 3


def verdicts(made: Library) -> list[str]:
    each = samples(made.known, F64, FEW, 0).each
    return [f"{v.function} {v.outcome}: {v.says}" for v in clouds(made, each) if v.outcome == "FAILS"]


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_agrees_with_its_cloud(name: str) -> None:
    assert verdicts(library(load(name))) == []


STEADY = ("top_steady_precession", "eulers_disk")


@pytest.mark.parametrize("name", STEADY)
def test_at_a_root_and_nowhere_near_it_the_cloud_is_in_balance(name: str) -> None:
    found = opened(name)
    middle = {c: float(((q.low or 0) + (q.high or 0)) / 2) for q in found.quantities()
              for c in q.components}  # fmt: skip
    machine = load(name)
    assert isinstance(machine, Machine)
    every = roots(found, {n: v for n, v in middle.items() if n != "W"})
    assert every
    for root in every:
        near, off = dict(root), {"W": root["W"] * 1.01}
        if name == "eulers_disk":
            assert answers(machine, middle | near).contradiction < 1e-12
        assert answers(machine, middle | near).contradiction < 1e-12
        assert answers(machine, middle | off).contradiction > 1e-6


# What textbooks and programmers leave out, as edits of a scene that then differs from its cloud.
EDGE = (MACHINES, "edge_runner_flat")


def edited(name: str, old: str, new: str) -> tuple[Library, Library]:
    """Return the library of a scene, and that of the scene with a usual mistake in it."""
    scene = load(name)
    assert old in scene.text
    return library(scene), library(parse_scene(scene.text.replace(old, new), name))


SHORTCUTS = (
    ("edge_runner_flat", 'spin   = "-W*L/r"', "", "N", "the gyroscopic term is dropped"),
    ("propeller_3_blade", "number = 3", "number = 2", "M", "two blades are no disc"),
    ("skewed_disc", 'shape  = "disc"\naxis   = "z"\nmass   = "m"\nradius = "r"',
     'kind = "axisymmetric"\naxis = "z"\nmass = "m"\naxial = "m*r^2/2"\ntransverse = 0',
     "M", "C for C - A"),
    ("disc_two_bearings", 'spin   = "w"', 'spin = "-w"', "couple", "the sense of the spin"),
)  # fmt: skip


@pytest.mark.parametrize(("name", "old", "new", "function", "story"), SHORTCUTS,
                         ids=[row[4] for row in SHORTCUTS])  # fmt: skip
def test_a_usual_shortcut_gives_another_answer_than_the_cloud(
    name: str, old: str, new: str, function: str, story: str
) -> None:
    right = library(load(name))
    if story == "two blades are no disc":
        new += '\nturned = ["x 0.7"]'
        old, new = 'number = 3\naxis   = "x"', 'number = 2\naxis   = "x"'
        text = load(name).text.replace(old, new).replace('spin   = "p"', "")
        text = text.replace("[bodies.propeller]\nframe  = \"aircraft\"",
                            "[coordinates]\nphi = { unit = \"rad\", range = [0.5, 1], rate = \"p\" }"
                            "\n\n[frames.hub]\nparent = \"aircraft\"\nturned = [\"x phi\"]\n\n"
                            "[bodies.propeller]\nframe = \"hub\"")  # fmt: skip
        wrong = library(parse_scene(text, name))
    else:
        _, wrong = edited(name, old, new)
    fact = wrong.truths[function]
    machine = load(name)
    assert isinstance(machine, Machine)
    mixed = _with_scene(wrong, right)
    each = samples(right.known if story != "two blades are no disc" else wrong.known, F64, 1, 0).each
    found = [v for v in clouds(mixed, each) if v.function == fact.name]
    assert [v.outcome for v in found] == ["FAILS"], story


def _with_scene(wrong: Library, right: Library) -> Library:
    """Return the programs and truths of one scene as if they were those of the other."""
    from dataclasses import replace

    known = replace(wrong.known, scene=right.known.scene)  # type: ignore[type-var]
    return replace(wrong, known=known)
