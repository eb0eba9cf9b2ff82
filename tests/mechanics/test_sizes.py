"""What balances say does not rest on the size of a quantity, nor on the unit it is counted in."""

import pytest

from derive.library.library import Library, library
from derive.scene import SceneError, parse_scene

BODY = """
wanted = ["acceleration", "kinetic_energy"]
[parameters]
A = {{ unit = "kg m^2", range = [1e{A}, 2e{A}] }}
B = {{ unit = "kg m^2", range = [1e{B}, 2e{B}] }}
[body]
kind = "principal"
moments = ["A", "B", "B"]
[known]
angular_velocity = {{ range = [-1e{w}, 1e{w}] }}
moment = {{ range = [-1e{M}, 1e{M}] }}
"""
DISC = """
wanted = ["accelerations", "tip"]
[parameters]
m = {{ unit = "kg", range = [1e{m}, 2e{m}] }}
r = {{ unit = "m", range = [1e{r}, 2e{r}] }}
l = {{ unit = "m", range = [1e{l}, 2e{l}] }}
g = {{ unit = "m/s^2", range = [9.7, 9.9] }}
[coordinates]
theta = {{ unit = "rad", range = [-0.3, 0.3] }}
[frames.stem]
turned = ["x theta"]
[bodies.disc]
frame = "stem"
shape = "disc"
mass = "m"
radius = "r"
axis = "z"
centre = ["0", "0", "l"]
[loads.weight]
gravity = ["0", "0", "-g"]
[loads.tip]
on = "disc"
force = "?tip"
couple = ["0", "?cy", "?cz"]
{more}
"""
SPRING = '[loads.pull]\non = "disc"\nspring = {k}\nto = ["0", "0", "1"]\n'


def made(text: str, **sizes: object) -> Library:
    """Return the library of a text with sizes in it, 10^0 where none is given."""
    plain: dict[str, object] = dict.fromkeys("ABwMmrl", 0)
    return library(parse_scene(text.format(**{**plain, "more": "", **sizes}), "sized"))


def inputs(of: Library) -> list[object]:
    """Return what the functions of a library are given, and how many operations they do."""
    return [(f.name, [q.name for q in f.inputs], len(f.ops)) for f in of.functions]


@pytest.mark.long
@pytest.mark.parametrize(
    "sizes",
    [
        {"A": -30, "B": -30}, {"A": -37, "B": -37}, {"A": -30}, {"B": -37}, {"A": 37}, {"B": 37},
        {"A": 37, "B": 37}, {"A": 37, "B": -37}, {"w": 37}, {"w": -37}, {"M": 37},
        {"A": -37, "B": -37, "M": 37},
    ],
    ids=str,
)  # fmt: skip
def test_a_body_of_any_size_has_the_functions_of_one_of_size_1(sizes: dict[str, int]) -> None:
    assert inputs(made(BODY, **sizes)) == inputs(made(BODY))


@pytest.mark.long
@pytest.mark.parametrize(
    "sizes",
    [{"m": 30}, {"m": -30}, {"l": -20, "r": -20}, {"l": -30}, {"l": 20}, {"r": -30}, {"r": 20}],
    ids=str,
)
def test_a_machine_of_any_size_has_the_functions_of_one_of_size_1(sizes: dict[str, int]) -> None:
    assert inputs(made(DISC, **sizes)) == inputs(made(DISC))


@pytest.mark.long
def test_a_spring_of_any_stiffness_leaves_the_functions_as_they_are() -> None:
    plain = made(DISC, more=SPRING.format(k=2))
    for k in ("2e-30", "2e30", "2e300"):
        assert inputs(made(DISC, more=SPRING.format(k=k))) == inputs(plain)


@pytest.mark.parametrize("name", ["A", "B"])
def test_a_range_beyond_the_floats_is_refused_before_the_balances_are(name: str) -> None:
    with pytest.raises(SceneError) as refusal:
        made(BODY, **{name: 300})
    rule = "must fit a float, up to 3.4e38, not 2e+300"
    assert str(refusal.value) == f"scene 'sized': the range of '{name}' {rule}"
