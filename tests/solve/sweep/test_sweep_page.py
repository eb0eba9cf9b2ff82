"""Every block of docs/sweep.md runs, and gives what stands below it; so do its commands."""

import doctest
from pathlib import Path

import numpy as np
import pytest

from bench.sweep import PAGE, examples
from derive.cli import main
from derive.solve.sweep.drawing import histogram
from derive.solve.sweep.summary import _scatter
from tests.solve.sweep.swept_tops import swept_top


def test_the_examples_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = doctest.testfile(str(PAGE), module_relative=False)
    assert found.attempted > 5
    assert found.failed == 0


def command(number: int) -> list[str]:
    """Return what is behind ``derive`` in a command of the page, with fewer samples; its scene."""
    scenes, words = examples()[number]
    for name, text in scenes.items():
        Path(name).write_text(text, encoding="utf-8")
    return [{"1e6": "1e3", "2e4": "2e3"}.get(word, word) for word in words]


@pytest.mark.parametrize(("told", "page"), [(".", "here.html"), ("runs.html", "runs.html.html")])
def test_the_page_lies_beside_its_folder_whatever_that_is_called(
    told: str, page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    found = swept_top(Path(told), samples=20)
    assert (found.page.name, found.page.is_file()) == (page, True)
    assert swept_top(Path(told), samples=20).ended == found.ended


@pytest.mark.parametrize("values", [
    (-20.0, -20.0 + 4e-15), (3.0, 3.0), (0.0, 0.0), (-1.7e308, 1.7e308), (5e-324, 1e-323),
])  # fmt: skip
def test_a_column_that_hardly_scatters_or_beyond_measure_has_a_histogram(
    values: tuple[float, float],
) -> None:
    found = _scatter("a@end", np.array([*values, *values]))
    assert sum(found.heights) == 4
    assert np.isfinite(found.edges).all()
    assert "<svg" in histogram(found, "1")


@pytest.mark.long
@pytest.mark.parametrize("number", range(3))
def test_the_commands_of_the_page_run_and_write_what_it_says(
    number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert len(examples()) == 3
    own = command(number)
    assert main(own) == 0
    folder = Path(own[-1])
    assert f"  {folder}\n  {folder.with_suffix('.html')}" in capsys.readouterr().out
    assert "<svg" in folder.with_suffix(".html").read_text(encoding="utf-8")
