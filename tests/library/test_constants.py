"""What set-up makes is called as nothing else in its scene is: one name, one number."""

import re
from collections.abc import Iterator

import numpy as np
import pytest

from derive.library.library import Library, library
from derive.program.arithmetic import extended
from derive.program.run import results_by_name
from derive.scene import catalogue, parse_scene
from derive.scene.formula import FLOATS, FormulaError, evaluate
from derive.scene.grammar import parse
from tests.made import library_of, thinned


@pytest.mark.parametrize("name", thinned(catalogue(), 10))
def test_a_constant_with_the_name_of_a_parameter_is_that_parameter(name: str) -> None:
    library = library_of(name)
    made, words = library.setup, library.vocabulary
    names = [c for q in made.outputs for c in q.components]
    given = (*words.parameters, *(q for p in library.printed() for q in p.inputs))
    of_scene = {c for q in given if q.role != "constants" for c in q.components}
    made_of = dict(zip(names, made.results, strict=True))
    assert len(made_of) == len(names)
    assert {n: r for n, r in made_of.items() if n in of_scene and r != n} == {}


@pytest.mark.long
def test_a_formula_of_a_constant_tells_a_parameter_from_an_entry_of_the_inverse() -> None:
    """This scene calls entries of its inertia tensor as we call those of the inverse."""
    says = library_of("reaction_wheel_satellite").constants
    assert says["J_xz"] == "J_xz"
    assert sorted(x[6:8] for x in says.values() if "inverse" in x) == [
        "xx", "xy", "xz", "yy", "yz", "zz",
    ]  # fmt: skip


@pytest.mark.parametrize("name", ["disc_two_bearings", "chandler_rigid_earth", "eulers_disk"])
def test_a_formula_of_a_constant_is_made_of_parameters_and_of_no_name_of_ours(name: str) -> None:
    library = library_of(name)
    given = {q.name for q in library.setup.inputs} | {"pi", "sqrt", "sin", "cos", "tan"}
    told = library.constants.items()
    words = {name: {*re.findall(r"[A-Za-z_]\w*", formula)} for name, formula in told}
    assert {n: own - given for n, own in words.items() if own - given} == {}


def told_and_made(library: Library) -> Iterator[tuple[str, float, float]]:
    """Yield what a constant's formula gives and what set-up makes, in the middle of the ranges."""
    ends = {q.name: q.ends for q in library.setup.inputs}
    values = {n: float(low + (high - low) * 9 / 16) for n, (low, high) in ends.items()}
    pairs = {n: (np.float64(x), np.float64(0)) for n, x in values.items()}
    made = results_by_name(library.setup, extended(np.float64), pairs)
    for name, text in library.constants.items():
        try:
            told = evaluate(parse(text), values, FLOATS)
        except (FormulaError, KeyError):
            continue  # words: long, or an entry of an inverse
        yield name, told, float(made[name][0])


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_a_formula_of_a_constant_gives_what_set_up_makes(name: str) -> None:
    of = library_of(name)
    assert [n for n, told, made in told_and_made(of) if abs(told - made) > 1e-9 * abs(made)] == []


TURNED_BACK = """
wanted = ["moment", "moment_jacobian"]
[parameters]
A = { unit = "kg m^2", range = [2, 2.5] }
B = { unit = "kg m^2", range = [1.2, 1.4] }
C = { unit = "kg m^2", range = [1.5, 1.7] }
[coordinates.a]
unit = "rad"
range = [-3, 3]
motion = "prescribed"
rate = { range = [50, 150] }
acceleration = { range = [-20, 20] }
[speeds]
W = { unit = "rad/s", range = [-1, 1], rate = { range = [-1, 1] } }
p = { unit = "rad/s", range = [-1, 1], rate = 0 }
[axes]
angular_velocity = ["p", "0", "W"]
[body]
kind = "principal"
moments = ["B", "A", "C"]
turned = ["y a"]
"""


def test_a_sum_with_a_minus_before_it_stands_in_brackets() -> None:
    every = [*told_and_made(library(parse_scene(TURNED_BACK, "turned_back")))]
    assert len(every) > 2
    assert [n for n, told, made in every if abs(told - made) > 1e-12] == []


PAIRS = """
wanted = ["accelerations"]
parameters.A = { unit = "kg m^2", range = [1, 2] }
parameters.C = { unit = "kg m^2", range = [0.1, 0.2] }
coordinates = { p = { unit = "rad", range = [-1, 1] }, s = { unit = "rad", range = [-1, 1] } }
frames = { arm = { turned = ["z p"] }, wheel = { parent = "arm", turned = ["z s"] } }
[bodies]
arm = { frame = "arm", kind = "axisymmetric", axis = "z", axial = "A", transverse = "A" }
wheel = { frame = "wheel", kind = "axisymmetric", axis = "z", axial = "C", transverse = "C" }
[loads]
hinge = { on = "arm", force = "?h", couple = ["?a", "?b", "0"] }
pin = { on = "wheel", against = "arm", force = "?q", couple = ["?c", "?d", "0"] }
"""


@pytest.mark.long
def test_an_entry_of_an_inverse_is_called_by_the_places_of_the_unknowns_that_it_gives() -> None:
    says = library_of("rigid_body").constants
    assert says["J_xz"] == "entry xz of the inverse of the matrix that multiplies the unknowns"
    assert not any(n.startswith("J_x") for n in library(parse_scene(PAIRS, "pair")).constants)
