"""The page is one file: no script, nothing from elsewhere, everything that was found on it."""

import re
from dataclasses import replace
from itertools import pairwise

import pytest

from bench.report.hard import Hard
from bench.report.page import page
from bench.report.plots import figure, panels, spread, svg
from tests.bench.report.made_up import found, report

pytest.importorskip("matplotlib")
LINK = re.compile(r"""(?:href|src|xlink:href|url)\s*[=(]\s*["']?([^"')\s>]+)""")


@pytest.fixture(scope="module")
def html() -> str:
    return page(report())


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


def test_the_same_points_give_the_same_svg() -> None:
    rows, points = panels(["error at the end"]), found().points
    once, again = (svg(rows, points, 1e-13) for _ in range(2))
    assert once == again
    assert "<metadata" not in once


def test_names_of_curves_do_not_lie_over_each_other() -> None:
    places = spread([0.01] * 8 + [0.5] + [0.99] * 7, 0.052)
    apart = [b - a for a, b in pairwise(places)]
    assert min(apart) > 0.0519
    assert places[0] >= 0
    assert places[-1] <= 1


def test_every_curve_is_named_once() -> None:
    drawn = figure(panels(["error at the end"]), found().points, 1e-13)
    names = [t.get_text() for ax in drawn.axes for t in ax.texts]
    assert sorted(names) == ["heyoka", "step_dmv", "step_rk4", "κu, attainable"]
