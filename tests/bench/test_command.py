"""``make bench`` and ``make report`` refuse what they cannot do by one sentence."""

from pathlib import Path

import pytest

from bench import __main__ as bench
from bench.report import __main__ as report


def test_bench_names_a_file_that_it_cannot_write(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert bench.main(["--out", str(tmp_path / "missing" / "file.json")]) == 2
    assert "must be writable" in capsys.readouterr().err


def test_report_names_the_parts_that_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("scipy")
    assert report.main(["--only", "nothing_of_this_name"]) == 2
    assert "--only needs one of" in capsys.readouterr().err
