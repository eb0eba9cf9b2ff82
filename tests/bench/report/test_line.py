"""Which curves a plot shows follows from their figures: few, the cheapest, none by luck."""

import re
from pathlib import Path

import pytest

from bench.motion.case import cases
from bench.report.acts import acts
from bench.report.case_run import Found
from bench.report.curve import instructions
from bench.report.line import DECADES, MOST, OTHERS, Line, chosen, parted, worths
from bench.report.look import INK, NIGHT, OURS, PEERS, shades
from bench.report.seen import seen
from bench.report.typical import typical
from tests.bench.report.made_up import CASE, curve

STYLE = Path(__file__).parents[3] / "templates" / "style.css.jinja"
LEAST = 4.5  # contrast of text, WCAG 2.1 AA


def straight(method: str, each: float, ours: bool = True) -> Line:  # noqa: FBT001, FBT002
    """Return a curve of order four whose first point has an error of 1 and costs ``each``."""
    powers = range(9)
    return Line(method, ours, tuple(each * 2.0**n for n in powers), tuple(16.0**-n for n in powers))


def test_an_error_costs_what_the_straight_line_between_two_points_says() -> None:
    one = straight("step_rk4", 1.0)
    assert one.cost_of(16.0**-2) == pytest.approx(4.0)
    assert one.cost_of(16.0**-2.5) == pytest.approx(2.0**2.5)
    assert one.cost_of(2.0) == 1.0
    assert one.cost_of(1e-12) is None


def test_a_curve_that_crosses_an_error_and_comes_back_does_not_keep_to_it() -> None:
    lucky = Line("step_lie", ours=True, costs=(1.0, 2.0, 4.0), errors=(1e-2, 1e-9, 1e-4))
    assert lucky.cost_of(1e-6) is None
    assert lucky.cost_of(1e-3) == pytest.approx(2.0 ** (1 / 7))


def test_a_plot_shows_the_cheapest_few_of_us_and_fewer_peers() -> None:
    ours = [straight(f"step_{letter}", 10.0 + n) for n, letter in enumerate("abcdefghij")]
    peers = [straight(f"peer {n}", 30.0 - n, ours=False) for n in range(5)]
    lines = [*ours, *peers]
    shown = chosen(lines)
    assert len(shown) == MOST
    assert [lines[n].method for n in shown] == [
        *(one.method for one in ours[: MOST - OTHERS]),
        *("peer 2", "peer 3", "peer 4"),
    ]
    assert chosen(lines[::-1]) == [len(lines) - 1 - n for n in shown[::-1]]


def test_of_a_step_and_its_variants_one_is_shown() -> None:
    lines = [straight("step_rk4", 2.0), straight("step_rk4_compensated", 1.0)]
    assert chosen(lines) == [1]


def test_what_keeps_to_no_error_is_worth_nothing() -> None:
    nothing = Line("step_lie", ours=True, costs=(), errors=())
    cheap, dear = straight("step_rk4", 1.0), straight("step_dmv", 9.0)
    assert worths([nothing, cheap, dear]) == [0.0, 1.0, 0.5]
    assert len(DECADES) == 16


def test_no_plot_has_more_curves_than_can_be_told_apart_and_none_is_lost() -> None:
    names = [*OURS, *(f"step_new{n}" for n in range(20))]
    points = [p for n, name in enumerate(names) for p in curve(name, 4, 100.0 + n)]
    plots = parted(points, instructions)
    assert max(map(len, plots)) <= MOST
    assert {own[0].method for plot in plots for own in plot} == set(names)


def test_a_typical_cost_is_the_median_and_ends_where_half_of_the_cases_are_not_served() -> None:
    each = {n: curve("step_rk4", 4, cost) for n, cost in (("a", 1.0), ("b", 3.0), ("c", 9.0))}
    (one,) = typical(each, "f64", instructions)
    assert one.cost_of(2.0**-8) == pytest.approx(3.0 * 100 * 4, rel=0.01)  # with steps of 1/4 s
    lost = {**each, "d": [], "e": [], "f": []}
    assert typical(lost, "f64", instructions) == []


def test_the_words_of_a_plot_are_of_its_curves() -> None:
    lines = [straight("step_dmv", 5.0), straight("step_rk4", 15.0)]
    words = seen("a case, double: error", lines, "instructions", 1e-15)
    assert words.startswith("a case, double: error against instructions. An error of 1e-9 costs ")
    assert "; times that: step_rk4 3." in words
    assert "1e-15" in words
    assert "; times that: step_rk4 4." in seen(
        "", [lines[0], straight("step_rk4", 20.0)], "Ir", None
    )


def test_the_advice_tells_a_step_that_can_be_taken() -> None:
    found = Found(cases()[CASE], tuple(curve("step_rk4", 4, 350.0)), ())
    rows = {row.error: row for row in acts([found]) if row.precision == "f64"}
    assert rows["1e-6"].names == ("step_rk4",)
    assert re.sub(r"[\u00a0\u2060]", "", rows["1e-6"].how[0]) == "steps of 0.03125/|ω|"  # 2^-20
    assert rows["1e-12"].names == ()


def luminance(colour: str) -> float:
    """Return the relative luminance of a colour (WCAG 2.1)."""
    parts = [int(colour[n : n + 2], 16) / 255 for n in (1, 3, 5)]
    linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
    return sum(x * k for x, k in zip(linear, (0.2126, 0.7152, 0.0722), strict=True))


def contrast(one: str, other: str) -> float:
    """Return the contrast of two colours, 1 to 21."""
    low, high = sorted(map(luminance, (one, other)))
    return (high + 0.05) / (low + 0.05)


def test_every_curve_and_its_name_are_clear_on_light_and_on_dark_paper() -> None:
    papers = re.findall(r"--paper: (#\w+)", STYLE.read_text(encoding="utf-8"))
    grounds = [p if len(p) == 7 else "#" + "".join(2 * c for c in p[1:]) for p in papers]
    assert {look.colour for look in (OURS | PEERS).values()} <= set(NIGHT)
    for ground, inks in zip(grounds, zip(*shades().values(), strict=True), strict=True):
        assert [ink for ink in inks if contrast(ink, ground) < LEAST] == []
    assert contrast(INK, grounds[1]) < LEAST
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
