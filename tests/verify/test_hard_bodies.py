"""Hard bodies are found for every scene by its parameters, in whatever form it was written."""

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from derive.library.library import Library, library
from derive.mechanics.mechanism import mechanism
from derive.program.largest import largest
from derive.program.precision import F32, F64, PRECISIONS, Precision
from derive.scene import Scene, catalogue, load, parse_scene
from derive.verify.draw import Dice, Sampled, drawn
from derive.verify.hard_bodies import BODIES, solvable
from derive.verify.kept import stated_figures
from derive.verify.sample import Sample, Samples, samples
from derive.verify.scale import with_values
from derive.verify.search import Sampling
from derive.verify.stated import at_rows, at_samples, figures
from tests.made import library_of, scene_of, thinned

LONG = Path(__file__).parents[1] / "data" / "long_form"
GENERATED = Path(__file__).parents[2] / "generated"
KINDS = {hard.kind for hard in BODIES}
FORMS = sorted(path.stem for path in LONG.glob("*.toml"))
ALIKE = 2.0
"""Two forms draw their own samples: the largest errors of a few hundred differ by so much."""
STILL = 1.0
"""In u: errors below a rounding, of few or no operations, are not compared."""


def hard(scene: Scene, precision: Precision, corners: int = 1) -> tuple[Sample, ...]:
    found = samples(mechanism(scene), precision, 0, corners).each
    return tuple(s for s in found if s.kind in KINDS)


def kinds(scene: Scene) -> set[str]:
    return {s.kind for s in hard(scene, F64)}


@pytest.mark.parametrize("name", FORMS)
def test_a_body_takes_the_same_hard_kinds_in_either_form(name: str) -> None:
    short = kinds(scene_of(name))
    assert short
    assert kinds(load(LONG / f"{name}.toml")) == short


SAME = {
    "free_body_principal": ("acceleration",),
    "free_body": ("acceleration", "angular_momentum", "kinetic_energy"),
    "rotor_on_turning_axes": ("moment", "angular_momentum", "kinetic_energy"),
    "unsymmetrical_rotor_in_carrier_axes": ("moment", "kinetic_energy"),
    "rigid_body": ("state_rate", "kinetic_energy"),
}
AT_ONCE = ("free_body_principal", "rotor_on_turning_axes")


def worst(made: Library, function: str) -> float:
    """Return the largest error of a function at hard bodies, in u."""
    of = Sampled(made, F64)
    program = next(f for f in made.functions if f.name == function)
    found = at_samples(of, program, hard(made.scene, F64, 24))
    return largest([x for each in found for x in each.largest()])


@pytest.mark.parametrize(
    "name", [n if n in AT_ONCE else pytest.param(n, marks=pytest.mark.long) for n in SAME]
)
def test_errors_at_hard_bodies_are_the_same_in_either_form(name: str) -> None:
    short, long = library_of(name), library(load(LONG / f"{name}.toml"))
    for function in SAME[name]:
        one, other = worst(short, function), worst(long, function)
        assert max(one, other) <= ALIKE * max(STILL, min(one, other)), (function, one, other)


@pytest.mark.parametrize("name", thinned(FORMS, 3))
@pytest.mark.parametrize("precision", PRECISIONS, ids=lambda p: p.name)
def test_no_sample_has_masses_lengths_or_moments_that_set_up_refuses(
    name: str, precision: Precision
) -> None:
    made = mechanism(load(LONG / f"{name}.toml"))
    each = samples(made, precision, 24, 2).each
    assert all(solvable(made.scene, s.values) for s in each)


MACHINE = """
title = "Turntable and what stands on it"
wanted = ["acceleration: W_dot, w_dot"]
[parameters]
A = {{ unit = "kg m^2", range = [0.1, 0.2] }}
p = {{ unit = "kg m^2", range = [-5e-3, 5e-3] }}
q = {{ unit = "kg m^2", range = [-5e-3, 5e-3] }}
r = {{ unit = "kg m^2", range = [-5e-3, 5e-3] }}
m = {{ unit = "kg", range = [1, 2] }}
a = {{ unit = "m", range = [0.1, 0.2] }}
b = {{ unit = "m", range = [0.2, 0.3] }}
c = {{ unit = "m", range = [0.3, 0.4] }}
[speeds]
W = {{ unit = "rad/s", range = [-1, 1] }}
w = {{ unit = "rad/s", range = [-1, 1] }}
[frames]
table = {{ angular_velocity = ["0", "0", "W"] }}
top = {{ parent = "table", angular_velocity = ["0", "0", "w"], origin = ["a", "0", "0"] }}
[bodies]
table = {{ frame = "table", kind = "principal", moments = [1, 1.5, 2] }}
top = {{ frame = "top", mass = "m", {body} }}
[loads]
hold = {{ on = "table", force = "?F", couple = ["?M_x", "?M_y", "0"] }}
pin = {{ on = "top", against = "table", force = "?G", couple = ["?N_x", "?N_y", "0"] }}
"""
STRAIGHT = {"sphere", "near sphere", "thin rod", "thin disc"}
MADE: Mapping[str, tuple[str, set[str]]] = {
    "a box by its shape": ('shape = "box", lengths = ["a", "b", "c"]', STRAIGHT),
    "a box by its formulas": (
        ('kind = "principal", moments = ["m*(b^2 + c^2)/12", "m*(a^2 + c^2)/12",'
         ' "m*(a^2 + b^2)/12"]'), STRAIGHT),
    "a cylinder along x": ('shape = "cylinder", axis = "x", radius = "a", length = "b"', STRAIGHT),
    "radii of gyration": (
        'kind = "axisymmetric", axis = "y", axial = "m*a^2", transverse = "m*b^2"', STRAIGHT),
    "a disc": ('shape = "disc", axis = "z", radius = "a"', {"thin disc"}),
    "a rod": ('shape = "rod", axis = "x", length = "c"', {"thin rod"}),
    "numbers": ('kind = "principal", moments = [1, 1.5, 2]', set()),
    "full": (
        ('kind = "general", products = ["p", "q + p", "r"],'
         ' second_moments = ["m*a^2", "m*b^2", "A + m*c^2"]'), KINDS),
}  # fmt: skip


def tensor(body: str, values: Mapping[str, float]) -> np.ndarray:
    """Return the tensor of a body of ``MADE``, by the numbers alone."""
    A, p, q, r, m, a, b, c = (values[name] for name in "Apqrmabc")
    straight = {
        "a box by its shape": (b * b + c * c, a * a + c * c, a * a + b * b),
        "a box by its formulas": (b * b + c * c, a * a + c * c, a * a + b * b),
        "a cylinder along x": (6 * a * a, 3 * a * a + b * b, 3 * a * a + b * b),
        "radii of gyration": (b * b, a * a, b * b),
        "a disc": (1, 1, 2),
        "a rod": (0, 1, 1),
    }
    if body in straight:
        return np.diag(straight[body])
    x, y, z = m * a * a, m * b * b, A + m * c * c
    return np.array([[y + z, -p, -q - p], [-p, z + x, -r], [-q - p, -r, x + y]])


def is_of_kind(kind: str, tensor: np.ndarray) -> bool:
    """Tell whether a body is what its kind says, by its principal second moments."""
    moments = np.linalg.eigvalsh(tensor)
    low, middle, high = np.sort(moments.sum() / 2 - moments)
    match kind.removeprefix("turned, "):
        case "sphere" | "near sphere":
            return bool(high - low <= 2e-8 * high)
        case "thin rod":
            return bool(middle <= 2e-6 * high)
        case "thin disc":
            return bool(low <= 1e-9 * high) and bool(middle > high / 2)
        case "ill-conditioned":
            return 1e-10 < moments.min() / moments.max() < 1e-8
    raise AssertionError(kind)


@pytest.mark.long
@pytest.mark.parametrize("body", MADE)
def test_what_parameters_can_make_of_a_machines_body_is_made(body: str) -> None:
    told, expected = MADE[body]
    scene = parse_scene(MACHINE.format(body=told), "table")
    one = hard(scene, F64, 2)
    assert {s.kind for s in one} == expected
    assert all(is_of_kind(s.kind, tensor(body, s.values)) for s in one)
    assert all(solvable(scene, s.values) for s in hard(scene, F32, 2))


ROTOR = "unsymmetrical_rotor_in_carrier_axes"
FEW = Sampling(samples=64, rounds=8, batch=1024, balls=1, motion_balls=1)
FRESH = 1.5
"""Bodies of a kind differ: the worst motion of some others errs by so much more than was found."""


@pytest.mark.long
@pytest.mark.whole
def test_the_worst_motion_of_a_hard_body_is_searched_for() -> None:
    made = library_of(ROTOR)
    searched, not_searched = (
        {m.output: m for m in figures(made, by) if m.precision == "f64"}
        for by in (FEW, replace(FEW, rounds=0))
    )
    for output in ("moment", "angular_momentum"):
        assert searched[output].worst > 100 * not_searched[output].worst, output
        assert searched[output].kind == "thin rod"
        assert searched[output].within < 100


@pytest.mark.long
@pytest.mark.whole
def test_the_accurate_form_errs_by_two_roundings_at_most_at_hard_bodies_too() -> None:
    head, tables = load(ROTOR).text.split("\n[", 1)
    made = library(parse_scene(f'{head}\nform = "accurate"\n[{tables}', "rotor"))
    assert all(m.worst <= 2.0 for m in figures(made, replace(FEW, batch=4096)))


@pytest.mark.long
@pytest.mark.parametrize("name", catalogue())
def test_other_hard_bodies_err_by_no_more_than_is_stated(name: str) -> None:
    made = library_of(name)
    text = (GENERATED / name / f"{name}.json").read_text(encoding="utf-8")
    every = stated_figures(json.loads(text))
    said = {(m.function, m.output): m for m in every if m.precision == "f64"}
    of, each = Sampled(made, F64), hard(made.scene, F64, 24)
    each = with_values(of, Samples(each, ())).each
    for program in made.functions if each else ():
        for found in at_samples(of, program, each):
            limit = said[program.name, found.output].worst
            assert largest(found.largest()) <= FRESH * max(STILL, limit), (program.name, limit)


def test_what_is_found_in_a_scene_without_parameters_is_within_its_ranges() -> None:
    made = library_of("attitude")
    of = Sampled(made, F64)
    drawn_ = samples(mechanism(made.scene), F64, 1, 0).each
    rows = drawn(of, Dice("within"), 3)
    found = at_rows(of, [rows], 0, [replace(drawn_[0], kind="sphere")])
    assert {s.kind for s in found} == {"found"}
