"""The page of the lecture is complete in itself and links to what is there."""

import re
from functools import cache

from derive.emit.page.lecture import lecture_page
from derive.lecture.chapters import LECTURE


@cache
def page() -> str:
    return lecture_page()


def test_every_step_is_on_the_page_once() -> None:
    places = re.findall(r'id="([\w-]+)"', page())
    assert len(places) == len(set(places))
    assert [p for p in places if p in {s.name for s in LECTURE.steps}] == [
        s.name for s in LECTURE.steps
    ]


def test_every_link_leads_somewhere() -> None:
    places = set(re.findall(r'id="([\w-]+)"', page()))
    assert set(re.findall(r'href="#([\w-]+)"', page())) <= places


def test_nothing_is_loaded_and_nothing_runs() -> None:
    assert "<script" not in page()
    assert not re.findall(r'(?:src|href)="(?!#|index.html|report.html)', page())
    assert "url(" not in page()


def test_every_reason_is_linked() -> None:
    for step in LECTURE.steps:
        block = page().split(f'id="{step.name}"')[1].split('<div class="step')[0]
        assert all(f'href="#{reason}"' in block for reason in step.using), step.name


def test_an_assumption_says_what_needs_it_first() -> None:
    block = page().split('id="strong_third_law"')[1].split('id="internal_moments_vanish"')[0]
    assert 'first needed by <a href="#internal_moments_vanish">' in block
