"""A report that is committed is of the scene's present programs."""

import json
from pathlib import Path

import pytest

from derive.emit.reported import reported
from derive.scene import catalogue
from tests.made import library_of, scene_of, thinned

GENERATED = Path(__file__).parents[2] / "generated"
MOST = 3e9
"""Operations in long floats of a report: 10 ns each in C, on two cores a quarter of a minute."""
NAMES = sorted(path.parent.name for path in GENERATED.glob("*/*_report.json"))


@pytest.mark.parametrize("name", thinned(NAMES, 12))
def test_a_committed_report_is_of_the_scenes_present_programs(name: str) -> None:
    said = json.loads((GENERATED / name / f"{name}_report.json").read_text(encoding="utf-8"))
    found = reported(library_of(name), GENERATED)
    assert found == said["best"] != "", f"`derive report {name}` makes it anew"
    assert (GENERATED / name / f"{name}_report.html").is_file()


def test_a_committed_page_is_made_by_the_command_without_a_time() -> None:
    horizons = {name: scene_of(name).horizon for name in NAMES}
    assert any(horizons.values())
    for name, horizon in horizons.items():
        text = (GENERATED / name / f"{name}_report.json").read_text(encoding="utf-8")
        motion = json.loads(text)["motion"] or {"time_is": "of the scene", "time": 0.0}
        assert motion["time_is"] == "of the scene"
        assert horizon is None or motion["time"] == float(horizon)
        page = (GENERATED / name / f"{name}_report.html").read_text(encoding="utf-8")
        assert f"Made by <code>derive report {name}</code>" in page


def test_the_true_motions_of_a_report_take_their_part_of_a_minute() -> None:
    found = []
    for name in NAMES:
        text = (GENERATED / name / f"{name}_report.json").read_text(encoding="utf-8")
        motion = json.loads(text)["motion"]
        found += [motion["operations_in_long_floats"]] if motion else []
    assert len(found) > len(NAMES) / 2
    assert 0 < min(found) <= max(found) < MOST


@pytest.mark.long
@pytest.mark.parametrize("name", catalogue())
def test_every_scene_of_the_catalogue_has_a_report_of_its_present_programs(name: str) -> None:
    assert reported(library_of(name), GENERATED) != "", f"`derive report {name}` makes it"


def test_a_report_of_other_programs_is_not_shown(tmp_path: Path) -> None:
    folder = tmp_path / "heavy_top"
    folder.mkdir()
    for text in ("", "[]", '{"digest": "0", "best": "for nothing"}'):
        (folder / "heavy_top_report.json").write_text(text, encoding="utf-8")
        assert reported(library_of("heavy_top"), tmp_path) == ""
    assert reported(library_of("heavy_top"), tmp_path / "nowhere") == ""
