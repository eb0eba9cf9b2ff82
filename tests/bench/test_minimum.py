"""Functions of ours cost no more instructions than the best that was written by hand."""

import shutil
from pathlib import Path

import pytest

from bench.build import build
from bench.contest import COLUMNS, _cost, authors
from bench.problem import PROBLEMS, Problem

MORE = 1.05
"""Of the instructions of the form written by hand: what compilers differ by in equal work."""
LOOP = 7  # instructions of the loop around a call, in both
GENERATED = Path(__file__).parents[2] / "generated"


@pytest.mark.long
@pytest.mark.skipif(shutil.which("valgrind") is None, reason="valgrind counts instructions")
@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: p.name)
def test_ours_takes_the_instructions_of_the_form_written_by_hand(
    problem: Problem, tmp_path: Path
) -> None:
    ours, hand = (
        _cost(problem, {c.name: build(one, c, tmp_path / one.author / c.name) for c in COLUMNS})
        for one in (author.answer(problem) for author in authors(GENERATED)[:2])
    )
    for column in COLUMNS:
        assert ours[column.name] - LOOP <= MORE * (hand[column.name] - LOOP), column.name
