"""A result that has no value, or no float, is refused by a sentence that names it."""

import pytest

from derive.library.library import library
from derive.scene import SceneError, parse_scene

DISC = """
wanted = ["a"]
[parameters]
m = { unit = "kg", range = [0.4, 0.6] }
r = { unit = "m", range = [0.04, 0.06] }
l = { unit = "m", range = [0.05, 0.07] }
[coordinates]
theta = { unit = "rad", range = [-0.3, 0.3] }
[frames.stem]
turned = ["x theta"]
[bodies.disc]
frame = "stem"
shape = "disc"
mass = "m"
radius = "r"
axis = "z"
centre = ["0", "0", "l"]
[loads]
weight = { gravity = ["0", "0", "-9.81"] }
tip = { on = "disc", force = "?tip", couple = ["0", "?cy", "?cz"] }
[results]
a = "FORMULA"
"""
ROUNDED = "is that of 0, but for rounding; write 0 instead"
LARGEST = "must be made of numbers within f32, up to 3.4e+38, but holds"


@pytest.mark.parametrize(
    ("formula", "says"),
    [
        ("tan(pi/2)*theta", "result 'a': the divisor of a tangent 'cos(pi/2)' must not vanish"),
        ("1/sin(pi)", "result 'a': the divisor 'sin(pi)' must not vanish, but does"),
        ("1/(2*sin(pi))", "result 'a': the divisor '2*sin(pi)' must not vanish, but does"),
        ("1/cos(pi/2)*theta", "result 'a': the divisor 'cos(pi/2)' must not vanish, but does"),
        ("sqrt(sin(pi))*theta", f"result 'a': the square root of 'sin(pi)' {ROUNDED}"),
        ("sqrt(2-2*cos(pi/3)-1)", f"result 'a': the square root of '2-2*cos(pi/3)-1' {ROUNDED}"),
        ("sqrt(sin(theta)^2+cos(theta)^2-1)", ROUNDED),
        ("1e300*1e300*theta", f"'a' {LARGEST} 1.0e+600"),
        ("1e300*1e300", f"'a' {LARGEST} 1.0e+600"),
        ("sqrt(1e300*1e300)*theta", f"'a' {LARGEST} 1.0e+300"),
        ("sin(1e300*1e300)", "numbers within f64, up to 1.8e+308, but holds 1.0e+600"),
    ],
)
def test_a_result_without_a_value_is_refused_by_its_name(formula: str, says: str) -> None:
    with pytest.raises(SceneError) as refusal:
        library(parse_scene(DISC.replace("FORMULA", formula), "disc"))
    assert says in str(refusal.value)


@pytest.mark.parametrize(
    "formula", ["sqrt(theta^2)", "sqrt(1 - cos(theta)^2)", "1/sin(theta + 1)", "sqrt(4)*theta"]
)
def test_roots_and_divisors_that_have_a_value_stay_accepted(formula: str) -> None:
    assert parse_scene(DISC.replace("FORMULA", formula), "disc").results[0].name == "a"


def test_a_comment_leaves_a_formula_as_it_is() -> None:
    made = library(parse_scene(DISC.replace("FORMULA", "m*l*theta"), "disc"))
    assert made["a"].says == "m*l*theta."
    meant = DISC.replace('"FORMULA"', '{ formula = "m*l*theta", meaning = "lean" }')
    assert library(parse_scene(meant, "disc"))["a"].says == "Lean."
