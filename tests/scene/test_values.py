"""A formula has a value wherever the ranges reach, or is refused with a place without one."""

import math
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import iv

from derive import load
from derive.scene import CATALOGUE, SceneError, parse_scene, safe
from derive.scene.formula import FLOATS, evaluate
from derive.scene.functions import INTERVALS
from derive.scene.grammar import parse

PENDULUM = """
wanted = ["q_ddot", "N"]
[parameters]
m = {{ unit = "kg", range = [1, 2] }}
[inputs]
w = {{ unit = "N m", range = [1, 2] }}
[coordinates]
q = {{ unit = "rad", range = [0, 1] }}
[frames.arm]
turned = ["y q"]
[bodies.bob]
frame = "arm"
shape = "point"
mass = "m"
centre = ["0", "0", "-1"]
[loads.pin]
on = "bob"
force = "?pin"
couple = ["?cx", "w*({factor})", "?cz"]
[results]
N = "{result}"
"""


def sentence(factor: str = "1", result: str = "pin_x") -> str:
    """Return the sentence that refuses a machine, "" if it is accepted."""
    try:
        parse_scene(PENDULUM.format(factor=factor, result=result), "odd")
    except SceneError as error:
        return str(error).removeprefix("scene 'odd': ")
    return ""


@pytest.mark.parametrize(
    ("factor", "says"),
    [
        ("sqrt(q - 0.0005)", "the square root of 'q - 0.0005' needs what is not negative"),
        ("1/(q - 0.3)", "the divisor 'q - 0.3' must not vanish, but does at q = 0.3"),
        ("(q - 0.3)^-2", "the divisor 'q - 0.3' must not vanish, but does at q = 0.3"),
        ("1/(q^2 - 0.6*q + 0.09)", "must not vanish, but does at q = 0."),
        ("1/(sin(7*q) + 1)", "must not vanish, but does at q = 0.67319"),
        ("sqrt((q - 0.3141)^2 - 1e-7)", "needs what is not negative"),
        (
            "tan(2*q)",
            "the divisor of a tangent 'cos(2*q)' must not vanish, but does at q = 0.785398",
        ),
        *(
            (f, "the divisor 'q' must not vanish, but does at q = 0")
            for f in ("q^2/q/q", "sin(q)/q")
        ),
        ("1/sqrt(q)", "the divisor 'sqrt(q)' must not vanish, but does at q = 0"),
    ],
)
def test_a_formula_without_a_value_is_refused_with_the_place(factor: str, says: str) -> None:
    assert says in sentence(factor)
    assert sentence(factor).startswith("load 'pin': ")


@pytest.mark.parametrize(
    "factor",
    ["sqrt(q)", "tan(q)", "1/(q + 0.001)", "1/(q^2 - 0.6*q + 0.0901)", "1/(sin(7*q) + 1.001)"],
)
def test_a_formula_with_a_value_everywhere_is_accepted(factor: str) -> None:
    assert sentence(factor) == ""


@pytest.mark.parametrize(
    "mass",
    [
        "m*1e300*1e300/1e300/1e300",
        "m*1e-300*1e-300*1e300*1e300",
        "m + m*1e300*1e300/1e300/1e300",
        "sqrt(m^2*1e300*1e300)/1e300",
        "m^16*1e300*1e300/(m^15*1e300*1e300)",
    ],
)
def test_a_formula_is_not_refused_for_what_is_beyond_floats_on_the_way(mass: str) -> None:
    assert sentence(mass.replace("m", "(q + 1)")) == ""
    text = PENDULUM.format(factor="1", result="pin_x")
    parse_scene(text.replace('mass = "m"', f'mass = "{mass}"'), "odd")


@pytest.mark.parametrize("result", ["m/(m - m)", "pin_x/(pin_x - pin_x)", "1/(w*q - q*w)"])
def test_a_divisor_that_is_nothing_is_refused(result: str) -> None:
    assert "result 'N': the divisor" in sentence(result=result)


def test_a_divisor_that_is_an_unknown_is_no_reason_to_refuse() -> None:
    assert sentence(result="pin_x/pin_z") == ""


def test_points_alone_would_miss_what_intervals_find(monkeypatch: pytest.MonkeyPatch) -> None:
    hidden = "1/((q - 0.123456)^2 + 1e-30)"
    assert "must not vanish" in sentence(hidden.replace("1e-30", "0"))
    monkeypatch.setattr(safe, "_searched", lambda *_: None)
    assert sentence(hidden.replace("1e-30", "0")) == ""


FORMULAS = [
    *("a + b*a", "a - b/3", "a*b - b*a", "a^3 - b^2", "sin(a) - cos(b)", "sin(a*b)", "cos(a)^2"),
    *("tan(a)", "sqrt(a^2)", "1/(a^2 + 1) - b", "(a - b)^-2", "sin(9*a)/2 + cos(b - 4)"),
]


PART = st.floats(0, 1)


@settings(max_examples=40)
@given(st.sampled_from(FORMULAS), st.tuples(*[st.floats(-4, 4)] * 4), PART, PART)
def test_an_interval_holds_every_value_in_it(
    text: str, ends: tuple[float, float, float, float], s: float, t: float
) -> None:
    formula = parse(text)
    a, b = sorted(ends[:2]), sorted(ends[2:])
    box = evaluate(formula, {"a": iv.mpf(a), "b": iv.mpf(b)}, INTERVALS)
    low, high = float(box.a), float(box.b)
    x = min(max(a[0] + s * (a[1] - a[0]), a[0]), a[1])
    y = min(max(b[0] + t * (b[1] - b[0]), b[0]), b[1])
    try:
        found = float(evaluate(formula, {"a": x, "b": y}, FLOATS))
    except (ArithmeticError, ValueError):
        return
    if math.isfinite(found):
        slack = Fraction(abs(found)) / 2**48  # the float value is rounded too, where it cancels
        terms = Fraction(2**-44) * (1 + Fraction(max(map(abs, ends))) ** 3)
        assert Fraction(found) >= Fraction(low) - slack - terms if math.isfinite(low) else True
        assert Fraction(found) <= Fraction(high) + slack + terms if math.isfinite(high) else True


def test_a_scene_without_a_value_at_a_singular_attitude_is_refused_by_its_angle(
    tmp_path: Path,
) -> None:
    text = (CATALOGUE / "heavy_top.toml").read_text(encoding="utf-8")
    (tmp_path / "top.toml").write_text(text.replace("[0.2, 2.9]", "[-0.5, 1]"), encoding="utf-8")
    with pytest.raises(SceneError, match=r"other two merge, theta = 0$"):
        load(tmp_path / "top.toml").generate(tmp_path, samples=64)
