"""What set-up makes is called as nothing else in its scene is: one name, one number."""

import re

import pytest

from derive.scene import catalogue
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


def test_a_formula_of_a_constant_tells_a_parameter_from_an_entry_of_the_inverse() -> None:
    """This scene calls entries of its inertia tensor as we call those of the inverse."""
    says = library_of("reaction_wheel_satellite").constants
    assert says["J_xz"] == "J_xz"
    assert sorted(x[:2] for x in says.values() if "inverse" in x) == [
        "xx", "xy", "xz", "yy", "yz", "zz",
    ]  # fmt: skip


@pytest.mark.parametrize("name", ["disc_two_bearings", "chandler_rigid_earth", "eulers_disk"])
def test_a_formula_of_a_constant_is_made_of_parameters_and_of_no_name_of_ours(name: str) -> None:
    library = library_of(name)
    given = {q.name for q in library.setup.inputs} | {"pi", "sqrt", "sin", "cos", "tan"}
    told = library.constants.items()
    words = {name: {*re.findall(r"[A-Za-z_]\w*", formula)} for name, formula in told}
    assert {n: own - given for n, own in words.items() if own - given} == {}
