"""Hard cases of a heavy top: the emitted functions keep what the printed formulas lose."""

from pathlib import Path

import pytest

from bench.report.hard import Hard
from bench.report.hard_top import tops

LOST = 1e3
"""A naive form counts as failing if its error is so many times the bound that ours keeps."""


@pytest.fixture(scope="module")
def rows(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Hard]:
    folder: Path = tmp_path_factory.mktemp("top")
    return {row.name: row for row in tops(folder)}


@pytest.mark.long
@pytest.mark.parametrize("precision", ["f32", "f64"])
@pytest.mark.parametrize("name", ["slow precession of a fast top", "1 - cos at a tilt of 1e-4 rad"])
def test_ours_keeps_its_bound_where_the_printed_form_fails(
    rows: dict[str, Hard], name: str, precision: str
) -> None:
    row = rows[name]
    if precision not in row.ours_found:
        pytest.skip("no compiler")
    assert row.holds(precision), (row.ours_found, row.bound)
    assert max(row.naive_found[precision]) > LOST * row.bound[precision]
