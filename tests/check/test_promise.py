"""What is stated of few samples holds at many others: the search is as wide for few."""

from dataclasses import replace

import pytest

from derive.check.fresh import fresh
from derive.verify.search import LEAST, Sampling, sampled_at
from derive.verify.stated import figures
from tests.made import library_of

FEW, OTHERS = 256, 4096


def broken(name: str, by: Sampling) -> list[str]:
    """Return what fresh samples find larger than is stated."""
    library = library_of(name)
    rows = fresh(library, figures(library, by), OTHERS, lambda _: None)
    return [row.says for row in rows if row.outcome == "FAILS"]


@pytest.mark.long
@pytest.mark.parametrize(
    "name",
    ["heavy_top", *(pytest.param(n, marks=pytest.mark.long) for n in ("acrobot", "gyrostat"))],
)
def test_a_figure_of_few_samples_is_a_promise(name: str) -> None:
    assert broken(name, sampled_at(FEW)) == []


@pytest.mark.long
def test_a_search_as_small_as_the_samples_breaks_it() -> None:
    assert sampled_at(FEW).batch == LEAST
    assert broken("heavy_top", replace(sampled_at(FEW), batch=8)) != []
