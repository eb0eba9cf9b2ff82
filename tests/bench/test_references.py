"""The table of known optima: every way is a row, and its digits are those that it found."""

import re
from dataclasses import replace
from math import log10
from pathlib import Path

import pytest

from bench import references

PAGE = Path(__file__).parents[2] / "docs" / "references.md"
WAYS = ("derive.steer", "its direct part", "plain", "plain, expanded")
ROUNDED = 0.1  # of digits, which the table gives so


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


@pytest.mark.long
def test_every_way_leads_to_the_optimum_from_the_same_starts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(references, "STEPS", 40)
    monkeypatch.setattr(references, "STARTS", 2)
    (case,) = (one for one in references.cases() if one.name == "sym180")
    ours, grid, *plain = found = [*references.rows(case)]
    assert tuple(row.way for row in found) == WAYS
    assert ours.cost == pytest.approx(case.known, rel=2e-10)
    assert all(row.cost == pytest.approx(grid.cost, rel=1e-7) for row in plain)
    assert all(len(row.found) == 2 for row in found)
    other = replace(ours, case=replace(case, known=case.known * 1.001))
    assert [float([*row.cells()][4]) > 9 for row in (ours, other)] == [True, False]


def test_the_page_has_all_references_with_the_digits_that_their_costs_have() -> None:
    rows = [cells(line) for line in PAGE.read_text("utf-8").splitlines() if line.startswith("| ")]
    own = {(row[0], row[1]): row for row in rows if len(row) == len(references.HEAD)}
    cases = references.cases()
    assert own.keys() >= {(case.name, way) for case in cases for way in WAYS}
    for case in cases:
        for way in WAYS:
            _, _, known, found, digits, *_, led = own[case.name, way]
            assert known == f"{case.known:.12g}"
            apart = abs(float(found) / case.known - 1)
            assert apart < 2e-10 or float(digits) == pytest.approx(-log10(apart), abs=ROUNDED)
            assert (way == WAYS[0]) == (float(digits) > 9)
            assert sum(int(count) for count in re.findall(r": (\d+)", led)) == 16
