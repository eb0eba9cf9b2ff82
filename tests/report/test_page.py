"""A report's page: marks along both sides of every plot, and footnotes of what stands there."""

import re
from fractions import Fraction
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.emit.templates import TEMPLATES
from derive.report.page import outside
from derive.report.plots import Curve, Plot, between, marks, svg
from derive.scene.declaration import Given
from tests.made import scene_of
from tests.report.test_sentence import made_up

NUMBER = r">(10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+|[\d.]+(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?)<"

PLAIN = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


@pytest.mark.long
@pytest.mark.parametrize(
    ("x", "y"),
    [((12, 30), (3.1, 3.9)), ((12,), (4.3e-7,)), ((3, 20), (0.5, 2)), ((5, 40), (1e-9, 1e-3))],
)
def test_both_sides_of_a_plot_have_marks_even_within_one_decade(x, y) -> None:
    plot = svg(Plot([Curve("moment", x, y, 0)], "operations", "error", "words"))
    found = re.findall(NUMBER, plot.text)
    assert len(found) >= 4, found


@given(st.floats(1e-17, 1e9), st.floats(1e-3, 1.9))
def test_marks_of_one_side_are_of_one_kind(low: float, decades: float) -> None:
    places = between(low, low * 10**decades)
    told = marks(places)
    assert len({"10" in text and not text.isascii() for text in told}) == 1, told
    values = [float(text.replace("·10", "e").translate(PLAIN)) for text in told]
    assert values == pytest.approx(places, rel=1e-5)


def test_a_side_with_marks_between_powers_of_ten_has_no_powers() -> None:
    plot = svg(Plot([Curve("moment", (8, 30), (1e-9, 1e-3), 0)], "operations", "error", "words"))
    assert {"10", "20"} <= {*re.findall(NUMBER, plot.text)}
    assert "10¹" not in plot.text


@given(st.floats(1e-17, 1e9), st.floats(1e-3, 1.9))
def test_marks_lie_in_the_range_in_order(low: float, decades: float) -> None:
    high = low * 10**decades
    places = between(low, high)
    assert 2 <= len(places) <= 12
    assert places == sorted(set(places))
    assert low * (1 - 1e-8) <= places[0]
    assert places[-1] <= high * (1 + 1e-8)


def motion_section(*stars: str, told: list[str] | None = None) -> str:
    steps = [SimpleNamespace(name="step_rk4", wanted=not star, operations=9, lengths={"f64": "1"},
                             spent={"f64": "1"}, least={"f64": "1"}, times={}, instructions={})
             for star in stars]  # fmt: skip
    motion = SimpleNamespace(time=1.0, given=True, fast=1.0, start=[], hard=0, tried=0)
    report = SimpleNamespace(instructions=())
    return TEMPLATES.get_template("scene_report_motion.html.jinja").render(
        motion=motion, aside=[], figure=str, plots=[], floors={"f32": "1", "f64": "1"},
        says={"f64": "double"}, target="1e-6", steps=steps, report=report, refused={},
        outside=told or [], scene=scene_of("heavy_top"),
    )  # fmt: skip


def test_the_footnote_on_a_star_stands_where_a_star_does() -> None:
    assert "* the scene does not want it" in motion_section("", "*")
    assert "the scene does not want it" not in motion_section("", "")


def test_a_length_outside_the_range_of_time_step_is_said_to_be() -> None:
    motion = made_up(step_a=[1.0, 1e-9, 1e-9, 1e-9])  # of 1 s: 500 ms is taken
    assert outside(motion, Given(Fraction(0), Fraction(1, 100), None)) == ["500 ms"]
    assert outside(motion, Given(Fraction(0), Fraction(1), None)) == []
    assert outside(None, Given(Fraction(0), Fraction(1), None)) == []
    assert "500 ms lies outside the range of" in motion_section("", told=["500 ms"])
    assert "lies outside the range of" not in motion_section("")
