"""The page is one file: no script, nothing from elsewhere, everything that was found on it."""

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from bench.report.curve import instructions
from bench.report.hard import Hard
from bench.report.line import Line, line, methods, state
from bench.report.page import page
from bench.report.plots import View, figure, spread, svg
from tests.bench.report.made_up import found, report

pytest.importorskip("matplotlib")
GENERATED = Path(__file__).parents[3] / "generated"
LARGEST = 1_500_000  # bytes
FEWEST = 200  # plots of a whole run
LINK = re.compile(r"""(?:href|src|xlink:href|url)\s*[=(]\s*["']?([^"')\s>]+)""")


@pytest.fixture(scope="module")
def html() -> str:
    return page(report())


@pytest.mark.long
def test_the_page_opens_with_a_plot_then_says_what_to_use_then_all_else(html: str) -> None:
    places = [html.index(mark) for mark in ("<h1>", "<svg viewBox", 'id="choose"', "<table")]
    assert places == sorted(places)
    assert html.count("<h2>", 0, html.index('id="choose"')) == 0


def test_the_page_that_is_kept_is_light_enough_to_send() -> None:
    kept = GENERATED / "report.html"
    assert kept.stat().st_size < LARGEST
    assert kept.read_text(encoding="utf-8").count('<svg viewBox="') > FEWEST


@pytest.mark.long
def test_the_page_has_no_script(html: str) -> None:
    assert "<script" not in html.lower()
    assert not re.search(r"\son\w+\s*=", html)


def test_the_page_takes_nothing_from_elsewhere(html: str) -> None:
    links = set(LINK.findall(html))
    assert links
    assert [x for x in links if re.match(r"[a-z]+:|//", x)] == []


def test_what_was_not_run_stands_on_the_page(html: str) -> None:
    assert "MuJoCo RK4 (No module named &#39;mujoco&#39;)" in html


def test_a_target_that_is_missed_is_called_so(html: str) -> None:
    assert html.count("not reached") == 1
    assert html.count("not measured") >= 1


@pytest.mark.long
def test_a_naive_form_is_judged_in_each_precision_by_the_bound_of_ours() -> None:
    bound = dict.fromkeys(("f64", "f32"), 1e-6)
    figures = {"f64": (1e-3,), "f32": (1e-9,)}
    row = Hard("a case", "", "naive", figures, "ours", {"f64": (1e-9,)}, bound, "why")
    shown = " ".join(page(replace(report(), hard=(row,))).split())
    assert '1e-3 <span class="no">fails</span>' in shown
    assert '1e-9 <span class="yes">kept</span>' in shown
    assert "<td>not run</td></tr>" in shown


def test_every_heading_of_the_contents_exists(html: str) -> None:
    for place in re.findall(r'href="#([\w-]+)"', html):
        assert f'id="{place}"' in html


def view() -> View:
    """Return a plot of the made-up curves."""
    points = [p for p in found().points if p.precision == "f64"]
    lines = [line(own, instructions, state) for own in methods(points, instructions)]
    star = Line("flow_exact", ours=True, costs=(2e3,), errors=(1e-14,))
    return View("made up", [*lines, star], "instructions", "error", 1e-13, marked=True)


def test_the_same_points_give_the_same_svg() -> None:
    once, again = (svg(view()) for _ in range(2))
    assert once == again
    assert "<metadata" not in once.text
    assert "#" not in once.text.replace('href="#', "")


def test_every_picture_says_in_words_what_is_seen_and_no_two_say_the_same(html: str) -> None:
    pictures = re.findall(r"<svg (?!class=.shapes)[^>]*>", html)
    said = [re.search(r'role="img" aria-label="([^"]*)"', picture) for picture in pictures]
    words = [one[1] for one in said if one]
    assert len(words) == len(pictures) == len(set(words)) > 20
    assert any(w.startswith("asym_ii_generic, double: error at the end against") for w in words)
    assert all(re.search(r" costs |no error below", w) for w in words)


def test_what_plots_share_stands_on_the_page_once(html: str) -> None:
    places = re.findall(r'\sid="([^"]+)"', html)
    assert len(places) == len(set(places))
    assert set(re.findall(r'<use [^>]*href="#([^"]+)"', html)) <= set(places)
    classes = {name for text in re.findall(r'class="(p\d+)"', html) for name in text.split()}
    assert classes
    assert classes <= set(re.findall(r"\.(p\d+)\{", html))


def test_names_of_curves_do_not_lie_over_each_other() -> None:
    places = spread([0.01] * 8 + [0.5] + [0.99] * 7, 0.052)
    apart = [b - a for a, b in pairwise(places)]
    assert min(apart) > 0.0519
    assert places[0] >= 0
    assert places[-1] <= 1


def test_every_curve_is_named_once() -> None:
    names = [text.get_text() for ax in figure(view()).axes for text in ax.texts]
    assert sorted(name for name in names if name) == [
        "flow_exact",
        "step_dmv",
        "step_rk4",
        "κu, attainable",
    ]
