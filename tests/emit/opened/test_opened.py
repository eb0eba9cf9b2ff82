"""Every generated page, opened in a browser: whole, at home, readable by day and by night.

Pictures of each kind of page are kept in ``build/pages/``, for people to look at.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive
from tests.emit.opened.opened import amiss, asked, greys, loaded, pictured

pytestmark = pytest.mark.browser
ROOT = Path(__file__).parents[3]
GENERATED = ROOT / "generated"
PAGES = sorted(GENERATED.rglob("*.html"))
KEPT = [page for page in PAGES if not page.stem.endswith("_report")]  # not those of a user's run
KINDS = ("index", "lecture", "report", "heavy_top/heavy_top", "satellite/satellite")
REPORTED = "rolling_cone"  # a scene whose report takes little time, with a plot of its functions
HOME = ("index.html", "lecture.html", "report.html")
PAPER = {"light": (200, 255), "dark": (0, 60)}  # how bright most of a page is, of 255
TONES = 16  # of grey, at least, where something is written


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_nothing_is_amiss_with_a_page_on_a_desk_or_a_telephone(page: Path, shown: Any) -> None:
    assert amiss(page, shown) == []


@pytest.mark.parametrize("page", KEPT, ids=lambda page: page.stem)
def test_every_page_leads_to_index_lecture_and_report(page: Path, shown: Any) -> None:
    assert {GENERATED / name for name in HOME} - {page} - led(page, shown) == set()


def test_the_index_leads_to_every_scene(shown: Any) -> None:
    scenes = {page for page in PAGES if page.stem == page.parent.name}
    assert len(scenes) > 1
    assert scenes - led(GENERATED / "index.html", shown) == set()


def test_a_scenes_own_report_is_as_whole_as_the_pages_beside_it(shown: Any, tmp_path: Path) -> None:
    for one in (*GENERATED.iterdir(), *(GENERATED / REPORTED).iterdir()):
        link = tmp_path / one.relative_to(GENERATED)
        link.parent.mkdir(exist_ok=True)
        if one.name != REPORTED:
            link.symlink_to(one)
    derive.load(REPORTED).report(folder=tmp_path)
    page = tmp_path / REPORTED / f"{REPORTED}_report.html"
    assert amiss(page, shown) == []
    assert {GENERATED / name for name in HOME} - led(page, shown) == set()
    pictured(page, shown, ROOT / "build" / "pages")


def led(page: Path, shown: Any) -> set[Path]:
    """Return the files that links of a page lead to."""
    loaded(page, shown)
    return {(page.parent / link.partition("#")[0]).resolve() for link in asked("links", shown)}


@pytest.mark.parametrize("kind", KINDS)
def test_a_picture_of_each_kind_of_page_is_kept(kind: str, shown: Any) -> None:
    for picture in pictured(GENERATED / f"{kind}.html", shown, ROOT / "build" / "pages"):
        grey = greys(picture)
        assert len(np.unique(grey)) > TONES
        low, high = PAPER[picture.stem.rpartition("_")[2]]
        assert low <= np.median(grey) <= high, picture.name


LONG = """\
wanted = ["state_rate"]
[parameters]
m_of_the_bead_that_slides_on_the_rail = { unit = "kg", range = [1, 2] }
[coordinates]
x = { unit = "m", range = [0, 1], rate = { range = [-1, 1] } }
[inputs]
torque_of_the_motor_at_the_far_end = { unit = "N", range = [-1, 1], meaning = "PUSH" }
torq = { unit = "N", range = [-1, 1], meaning = "PUSH" }
[frames]
bead = { origin = ["x", "0", "0"] }
[bodies]
bead = { frame = "bead", shape = "point", mass = "m_of_the_bead_that_slides_on_the_rail" }
[loads]
push = { on = "bead", force = ["torque_of_the_motor_at_the_far_end + torq", "?y", "?z"] }
held = { on = "bead", couple = "?c" }
""".replace("PUSH", "push that the motor at the far end exerts by its belt, positive along x")


def test_long_names_are_neither_cut_nor_torn_nor_too_wide_for_the_page(
    shown: Any, tmp_path: Path
) -> None:
    (tmp_path / "lengthy.toml").write_text(LONG)
    derive.generate([derive.load(tmp_path / "lengthy.toml")], tmp_path, 256)
    page = tmp_path / "lengthy" / "lengthy.html"
    assert [says for says in amiss(page, shown) if "leads" not in says] == []
    loaded(page, shown)
    assert not asked("torn", shown)
