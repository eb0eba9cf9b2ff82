"""The pages: well formed, without scripts, every link at home."""

import re
import xml.etree.ElementTree as ET
from functools import cache

import pytest

from derive.emit.page.code import listing
from derive.emit.page.equation import passages, written_names
from derive.emit.page.lecture import ENDS, IN_COMPONENTS, lecture_page
from derive.emit.page.links import neighbours
from derive.emit.page.prose import prose
from derive.emit.page.scene import scene_page
from derive.emit.reported import Beside
from derive.lecture.chapters import LECTURE
from derive.library.library import Library, library
from derive.program.program import Measurement
from derive.scene import catalogue, load, parse_scene
from tests.made import library_of, thinned

XHTML = "{http://www.w3.org/1999/xhtml}"
TAKEN = """
wanted = ["angular_momentum", "kinetic_energy"]
[parameters]
l = { unit = "kg m^2", range = [1, 2], meaning = "moment" }
T = { unit = "kg m^2", range = [1, 2], meaning = "another" }
[body]
kind = "principal"
moments = ["l", "l", "T"]
"""


def figures(of: Library) -> tuple[Measurement, ...]:
    """Return figures for every output, as if they had been measured."""
    return tuple(
        Measurement(p.name, precision, q.name, 0.5, 3.25, 3.25, 7, "found", 48, 0, 0)
        for p in of.printed()
        for precision in ("f32", "f64")
        for q in p.outputs
    )


@cache
def page(name: str) -> str:
    """Return the text of a scene's page, or of the lecture's."""
    return (
        lecture_page()
        if name == "lecture"
        else scene_page(library_of(name), figures(library_of(name)))
    )


def parsed(text: str) -> ET.Element:
    """Return the root of a page; anything but well-formed XML is an error."""
    return ET.fromstring(text)  # noqa: S314 (made here)


def places(text: str) -> list[str]:
    """Return every id on a page."""
    return [e.attrib["id"] for e in parsed(text).iter() if "id" in e.attrib]


NAMES = ("lecture", *catalogue())


@pytest.mark.parametrize("name", thinned(NAMES, 8))
def test_a_page_is_complete_well_formed_and_without_scripts(name: str) -> None:
    root = parsed(page(name))
    tags = {element.tag.split("}")[1] for element in root.iter()}
    assert tags & {"script", "link", "img", "iframe", "object", "form"} == set()
    assert {"math", "table", "style"} <= tags
    assert not [e for e in root.iter() for key in e.attrib if key.startswith("on")]
    assert "http" not in re.sub(r'xmlns="[^"]*"', "", page(name))


@pytest.mark.parametrize("name", thinned(NAMES, 8))
def test_every_link_leads_to_a_place_that_is_there(name: str) -> None:
    own, lecture = places(page(name)), places(page("lecture"))
    assert len(own) == len(set(own))
    scene = load(name).name if name != "lecture" else ""
    files = {f"{scene}_{p}.{e}" for p in ("f32", "f64") for e in "ch"}
    files |= {f"{scene}_casadi.py", f"{scene}.json", "../lecture.html"}
    files |= {"../index.html", "../report.html", "index.html", "report.html"}
    files |= {f"../{other}/{other}.html" for other in catalogue()}
    for link in parsed(page(name)).iter(f"{XHTML}a"):
        file, _, place = link.attrib["href"].partition("#")
        assert file in ("", *files)
        if place:
            assert place in (lecture if file else own)


@pytest.mark.long
def test_every_page_of_the_catalogue_leads_to_all_others() -> None:
    first, *_, last = catalogue()
    step = {name: re.findall('rel="next" href="../([a-z0-9_]+)/', page(name)) for name in (first,)}
    assert step == {first: [catalogue()[1]]}
    assert re.findall('rel="(?:prev|next)" href', page(first)) == ['rel="next" href']
    assert neighbours(load(last)) == {"prev": catalogue()[-2]}
    for text in (page(first), page("lecture")):
        links = {e.attrib["href"].split("/")[-1] for e in parsed(text).iter(f"{XHTML}a")}
        assert {"index.html"} <= links
        assert "report.html" not in links, "which only `make report` writes"
    lead = Beside(reports=("report.html",))
    for text in (scene_page(library_of(first), (), lead), lecture_page(lead.reports)):
        assert 'report.html">Speed against error</a>' in text


def test_a_scene_of_ones_own_leads_to_no_page_of_the_catalogue() -> None:
    text = scene_page(library(parse_scene(TAKEN, "taken")), ())
    assert "index.html" not in text
    assert "../lecture.html" in text


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_every_stored_result_leads_to_the_equation_that_it_satisfies(name: str) -> None:
    for program in library_of(name).functions:
        known, base = library_of(name).mechanism, program.name.removesuffix("_jacobian")
        lines = [line for passage in passages(known, base) for line in passage.lines]
        links = {line.unknown: line.place for line in lines}
        text = str(listing(program, name, links))
        assert text.count("<a href=") == len(program.results)
        assert {p.name for g in passages(known, base) for p in g.steps} == set(
            known.whole(base).steps
        )


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_a_scene_page_says_all_that_a_reader_needs(name: str) -> None:
    text, scene = page(name), load(name)
    assert scene.title in text.replace("&#39;", "'")
    for program in library_of(name).printed():
        assert f'id="{program.name}"' in text
        assert f"{program.flops()} operations" in text
        for q in program.inputs:
            assert q.role == "constants" or q.meaning in text.replace("&#39;", "'")
    assert "3.2" in text
    assert all(
        f"lecture.html#{a}" in text for p in library_of(name).printed() for a in p.assumptions
    )


@pytest.mark.long
def test_no_heading_of_a_page_stands_over_nothing() -> None:
    empty = re.compile(r"<h([23])[^>]*>([^<]*)</h[23]>\s*(?=<h[1-3]|</section)")
    pages = {name: page(name) for name in ("heavy_top", "sleeping_top", "rigid_body_steps")}
    assert {name: empty.findall(text) for name, text in pages.items() if empty.findall(text)} == {}


def test_a_function_that_was_not_measured_says_so() -> None:
    assert "has not been measured" in scene_page(library_of("heavy_top"), ())
    assert "has not been measured" not in page("heavy_top")


def test_letters_that_the_user_took_are_left_to_the_user() -> None:
    of = library(parse_scene(TAKEN, "taken"))
    text = scene_page(of, ())
    parsed(text)
    assert "<mi>L</mi>" in text
    assert "<mi>E</mi>" in text


def test_the_lecture_page_shows_every_step_its_reasons_and_its_mark() -> None:
    text = page("lecture")
    own = places(text)
    for step in LECTURE.steps:
        assert step.name in own
    assert text.count('class="step deduce"') == sum(s.kind == "deduce" for s in LECTURE.steps)
    assert {*ENDS, *IN_COMPONENTS} <= set(own)
    reasons = sum(len(step.using) for step in LECTURE.steps)
    assert text.count("<a href=") > reasons


def test_prose_writes_symbols_as_symbols_and_lets_nothing_through() -> None:
    assert "<mi>ω</mi>" in prose("about omega x rho")
    assert " × " in prose("about omega x rho")
    assert prose("sums of x y dm along the x axis") == "sums of x y dm along the x axis"
    assert "<script" not in prose("<script>alert(1)</script>")


def test_a_title_cannot_break_the_page() -> None:
    text = TAKEN.replace("wanted", 'title = "a < b & <script>"\nwanted', 1)
    shown = scene_page(library(parse_scene(text, "taken")), ())
    assert parsed(shown).find(f".//{XHTML}h1").text == "a < b & <script>"  # type: ignore[union-attr]


def test_the_rate_of_a_quaternion_is_written_with_a_dot() -> None:
    known = library_of("satellite").mechanism
    symbols, names = known.words.sheet.symbols, written_names(known)
    assert [names[symbols[f"attitude_rate_{p}"]] for p in "wxyz"] == [f"q_dot_{p}" for p in "wxyz"]
