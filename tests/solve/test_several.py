"""Scenes that are checked side by side are told in the order that they were given in."""

from pathlib import Path
from shutil import copytree

import pytest

from derive.solve.loaded import load
from derive.solve.several import checked

GENERATED = Path(__file__).parents[2] / "generated"
NAMES = ("skewed_disc", "rod_wire_vertical_shaft")


@pytest.mark.long
@pytest.mark.whole
def test_scenes_checked_together_are_told_in_order_and_one_that_is_wrong_fails(
    tmp_path: Path,
) -> None:
    scenes, heard = [load(name) for name in NAMES], list[str]()
    into = copytree(GENERATED, tmp_path / "generated")
    header = into / NAMES[1] / f"{NAMES[1]}_f32.h"
    header.write_text(header.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    together = list(checked(scenes, into, 256, heard.append))
    alone = [verdict for scene in scenes for verdict in checked([scene], into, 256)]
    assert together == alone
    assert [v.scene for v in together] == sorted((v.scene for v in together), key=NAMES.index)
    assert {v.scene for v in together if v.outcome == "FAILS"} == {NAMES[1]}
    assert heard == ["1 of 2 scenes", "2 of 2 scenes"]
