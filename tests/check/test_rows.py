"""A row that holds has compared something; one that could not says why."""

from functools import cache
from pathlib import Path

import pytest

from derive.check import NO_PARAMETERS, REASONS, check_library, not_drawn
from derive.check.compiler import find_compiler
from derive.check.emitted import Files
from derive.check.verdict import Verdict
from derive.verify.hard_bodies import BODIES
from derive.verify.sample import CORNERS
from tests.check.mutants import printed
from tests.made import library_of, thinned

FEW = 4


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("rows")


@cache
def rows(scene: str, workshop: Path) -> tuple[Verdict, ...]:
    made = library_of(scene)
    texts = Files(printed(made), "made in memory")
    return tuple(check_library(made, texts, workshop, find_compiler(), FEW))


@pytest.mark.long
@pytest.mark.parametrize("scene", thinned(["attitude", "eulers_disk", "heavy_top"], 3))
def test_a_row_that_holds_has_compared_something(scene: str, workshop: Path) -> None:
    held = [v for v in rows(scene, workshop) if v.outcome == "holds"]
    assert [v for v in held if v.says.startswith("0 ")] == []


@pytest.mark.long
def test_a_row_with_nothing_to_compare_says_why(workshop: Path) -> None:
    skipped = {(v.function, v.check): v.says for v in rows("attitude", workshop)
               if v.outcome == "skipped"}  # fmt: skip
    assert skipped["all", "satisfies the lecture"].startswith("nothing is wanted that the lecture")
    assert skipped["setup", "refuses what is no body"] == "there is no set-up to refuse anything"
    assert {v.check for v in rows("propeller_3_blade", workshop)} >= {
        "outputs over inputs", "refuses what is no body", "satisfies the lecture"
    }  # fmt: skip


@pytest.mark.long
def test_a_figure_that_no_header_states_is_not_said_to_be_stated(workshop: Path) -> None:
    says = [v.says for v in rows("attitude", workshop) if v.check == "rounding"]
    assert says
    assert all(s.endswith("the header as made says nothing") for s in says)


def test_kinds_that_are_not_tried_can_be_told_apart_and_each_has_its_reason() -> None:
    kinds = [*CORNERS, *(hard.kind for hard in BODIES)]
    count, listed = not_drawn(kinds).split(" not tried: ")
    each = [part.removesuffix(")").split(" (") for part in listed.split("; ")]
    assert [kind for kind, _ in each] == kinds
    assert {kind: why for kind, why in each if why != NO_PARAMETERS} == REASONS
    assert count == f"{len(kinds)} kinds are"
    assert not_drawn(kinds[:1]).startswith("1 kind is not tried: ")
