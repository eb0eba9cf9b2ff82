"""The lecture is right, and none of its reasons, signs and terms could be other than they are."""

import pytest

from derive.lecture.chapters import CHAPTERS, LECTURE
from derive.lecture.relations import ContradictionError
from derive.lecture.step import Step, verify
from tests.lecture.mutants import Mutant, with_fewer_reasons, with_wrong_sides
from tests.made import thinned

DEDUCED = [step for step in LECTURE.steps if step.kind == "deduce"]


def stands(mutant: Mutant) -> bool:
    """Return whether the checker accepts a wrong step."""
    try:
        return not any(LECTURE.gap(mutant.step))
    except ContradictionError:
        return False


def test_every_step_follows_from_its_reasons() -> None:
    assert [row.fault for row in verify(LECTURE) if not row.holds] == []


@pytest.mark.parametrize("step", thinned(DEDUCED, 8), ids=lambda step: step.name)
def test_a_step_without_one_of_its_reasons_fails(step: Step) -> None:
    assert [m.how for m in with_fewer_reasons(step) if stands(m)] == []


@pytest.mark.long
@pytest.mark.parametrize("step", DEDUCED, ids=lambda step: step.name)
def test_a_step_with_a_wrong_sign_or_without_a_term_fails(step: Step) -> None:
    mutants = list(with_wrong_sides(step))
    assert mutants
    assert [m.how for m in mutants if stands(m)] == []


def test_every_chapter_says_what_it_is_about_and_every_step_has_a_sentence() -> None:
    assert all(len(chapter.says.split()) > 20 for chapter in CHAPTERS)
    assert all(step.says[0].isalpha() and step.says[-1] == "." for step in LECTURE.steps)


def test_every_assumption_and_definition_is_used() -> None:
    used = {reason for step in LECTURE.steps for reason in step.using}
    unused = [s.name for s in LECTURE.steps if s.kind != "deduce" and s.name not in used]
    assert unused == []
