"""Scalars declared as components of a vector are that vector in every signature."""

from fractions import Fraction

import pytest

from derive.library.library import Library, library
from derive.program.arithmetic import EXACT
from derive.program.run import run
from derive.scene import SceneError, parse_scene

VECTORS = """
wanted = ["accelerations", "kinetic_energy", "state_rate", "swing: W_dot", "step_rk4"]
[parameters]
A = { unit = "kg m^2", range = [1, 2] }
B = { unit = "kg m^2", range = [1.5, 2] }
C = { unit = "kg m^2", range = [2, 2.5] }
m = { unit = "kg", range = [1, 2] }
k = { unit = "N/m", range = [1, 2] }
[coordinates]
r = { unit = "m", range = [-1, 1], components = ["a", "b", "c"], rate = { range = [-2, 2] } }
[speeds]
W = { unit = "rad/s", range = [-10, 10], components = ["x", "y", "z"] }
[inputs]
M = { unit = "N m", range = [-10, 10], components = ["x", "y", "z"] }
[frames.P]
origin = ["r_a", "r_b", "r_c"]
[frames.F]
angular_velocity = ["W_x", "W_y", "W_z"]
velocity = ["0", "0", "0"]
[bodies.body]
frame = "F"
kind = "principal"
mass = "m"
moments = ["A", "B", "C"]
[bodies.bob]
frame = "P"
shape = "point"
mass = "m"
[loads.motor]
on = "body"
couple = ["M_x", "M_y", "M_z"]
[loads.pull]
on = "bob"
force = ["-k*r_a", "-k*r_b", "-k*r_c"]
"""


LIST = (
    "speed 'W': components must be a list of different names such as ['x', 'y', 'z'], "
    "not a list of "
)


def alone(text: str) -> str:
    """Return the scene with every vector written as scalars."""
    for name, parts in (("r", "abc"), ("W", "xyz"), ("M", "xyz")):
        (line,) = (x for x in text.splitlines() if x.startswith(f"{name} = {{"))
        entry = line.partition(" = ")[2]
        for each in (f'components = ["{parts[0]}", "{parts[1]}", "{parts[2]}"], ',
                     f', components = ["{parts[0]}", "{parts[1]}", "{parts[2]}"]'):  # fmt: skip
            entry = entry.replace(each, "")
        text = text.replace(line, "\n".join(f"{name}_{p} = {entry}" for p in parts))
    return text.replace("swing: W_dot", "swing: W_x_dot, W_y_dot, W_z_dot")


@pytest.fixture(scope="module")
def both() -> tuple[Library, Library]:
    first, second = parse_scene(VECTORS, "vectors"), parse_scene(alone(VECTORS), "vectors")
    return library(first), library(second)


def test_functions_take_and_give_vectors(both: tuple[Library, Library]) -> None:
    swing = both[0]["swing"]
    assert [(q.name, q.shape) for q in swing.inputs[1:]] == [("W", (3,)), ("M", (3,))]
    assert [(q.name, q.components) for q in swing.outputs] == [
        ("W_dot", ("W_x_dot", "W_y_dot", "W_z_dot"))
    ]
    states = [q.name for q in both[0]["state_rate"].inputs]
    assert states == ["constants", "r", "r_dot", "W", "M"]
    assert [q.name for q in both[0]["accelerations"].outputs] == ["r_ddot", "W_dot"]


@pytest.mark.parametrize("name", ["accelerations", "kinetic_energy", "state_rate", "step_rk4"])
def test_the_numbers_and_the_operations_are_those_of_the_scalars(
    both: tuple[Library, Library], name: str
) -> None:
    vector, scalar = both
    assert vector[name].flops() <= scalar[name].flops()
    assert valued(vector, name) == valued(scalar, name)


def valued(made: Library, name: str) -> dict[str, Fraction]:
    """Return the exact outputs of a function where every component has a value of its own."""
    known = {c: Fraction(number_of(c)) for q in made.vocabulary.every() for c in q.components}
    known["time_step"] = Fraction(1, 8)
    for program in (made.setup, made[name]):
        values = [known[c] for q in program.inputs for c in q.components]
        names = [c for q in program.outputs for c in q.components]
        known |= dict(zip(names, run(program, EXACT, values), strict=True))
    return {c: known[c] for q in made[name].outputs for c in q.components}


def number_of(name: str) -> int:
    """Return a number that a name always has."""
    return sum(ord(letter) * 7**n for n, letter in enumerate(name)) % 97 + 1


def test_an_unused_component_is_said_and_a_used_vector_is_not() -> None:
    assert parse_scene(VECTORS, "vectors").warnings == ()
    less = VECTORS.replace('"-k*r_c"]', '"0"]').replace('"r_b", "r_c"]\n', '"r_b", "0"]\n')
    assert parse_scene(less, "vectors").warnings == ("no formula uses coordinate 'r_c'",)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('components = ["x", "y", "z"] }\n[inputs]', 'components = ["x"] }\n[inputs]',
         f"{LIST}1, ['x']"),
        ('components = ["x", "y", "z"] }\n[inputs]', 'components = ["x", "x"] }\n[inputs]',
         f"{LIST}2, ['x', 'x']"),
        ('m = { unit = "kg"', 'W_dot = { unit = "kg", range = [1, 2] }\nm = { unit = "kg"',
         "'W_dot' is declared twice: parameter 'W_dot' and the rate of the vector 'W'"),
        ('components = ["x", "y", "z"] }\n[inputs]', 'components = ["x", "y", "*/"] }\n[inputs]',
         "speed 'W': components must not hold */, which can end a comment or a string"),
    ],
)  # fmt: skip
def test_components_that_cannot_be_are_refused(old: str, new: str, says: str) -> None:
    assert old in VECTORS
    with pytest.raises(SceneError) as refusal:
        parse_scene(VECTORS.replace(old, new, 1), "vectors")
    assert str(refusal.value) == f"scene 'vectors': {says}"
