"""The page of the lecture is complete in itself, links to what is there, and never varies."""

import os
import re
import subprocess
import sys
from functools import cache
from hashlib import sha256

import pytest

from derive.lecture import LECTURE
from derive.page import lecture_page

PRINT_DIGEST = (
    "from hashlib import sha256; from derive.page import lecture_page; "
    "print(sha256(lecture_page().encode()).hexdigest())"
)


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
    assert not re.findall(r'(?:src|href)="(?!#)', page())
    assert "url(" not in page()


def test_every_reason_is_linked() -> None:
    for step in LECTURE.steps:
        block = page().split(f'id="{step.name}"')[1].split('<div class="step')[0]
        assert all(f'href="#{reason}"' in block for reason in step.using), step.name


def test_an_assumption_says_what_needs_it_first() -> None:
    block = page().split('id="strong_third_law"')[1].split('id="internal_moments_vanish"')[0]
    assert 'first needed by <a href="#internal_moments_vanish">' in block


@pytest.mark.parametrize("seed", ["0", "1"])
def test_the_page_has_the_same_bytes_under_every_hash_seed(seed: str) -> None:
    run = subprocess.run(
        [sys.executable, "-c", PRINT_DIGEST],
        env={**os.environ, "PYTHONHASHSEED": seed},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() == sha256(page().encode()).hexdigest()
