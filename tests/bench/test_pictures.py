"""The README's picture is what the project's files give, and can be read on any page."""

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from bench.pictures.front import CASE, COST, ERROR, SCENE, THEIRS, front
from bench.pictures.palette import PALETTES, Palette
from tests.made import library_of

ROOT = Path(__file__).parents[2]
PAGES = {"light": "#ffffff", "dark": "#0d1117"}
CONTRAST = 4.5  # WCAG 2.2, 1.4.3: the least for text


@pytest.mark.parametrize("name", PALETTES)
def test_the_picture_is_what_scene_code_and_report_give(name: str) -> None:
    drawn = front(library_of(SCENE), ROOT / "generated", PALETTES[name])
    committed = (ROOT / "docs" / "pictures" / f"front_{name}.svg").read_text(encoding="utf-8")
    assert drawn == committed, "run `python -m bench.pictures`"


def test_its_equations_are_eulers() -> None:
    root = ET.fromstring(front(library_of(SCENE), ROOT / "generated", PALETTES["light"]))  # noqa: S314 (ours)
    shown = ["".join(t.itertext()).replace("\u200a", "") for t in root.iter() if _is_math(t)]
    assert shown == [
        "Mx = Ixxω̇x + (Izz − Iyy) ωyωz",
        "My = Iyyω̇y + (Ixx − Izz) ωxωz",
        "Mz = Izzω̇z + (Iyy − Ixx) ωxωy",
    ]


def _is_math(element: ET.Element) -> bool:
    return element.get("class") == "math"


def test_its_curves_are_those_of_the_report(tmp_path: Path) -> None:
    report = json.loads((ROOT / "generated" / "report.json").read_text(encoding="utf-8"))
    (case,) = [case for case in report["cases"] if case["name"] == CASE]
    for p in case["points"]:
        p["instructions"] = 1e4 * p["passes"]
        p["omega"], p["attitude"] = 1e-3 / p["passes"], 1e-9
    (tmp_path / "report.json").write_text(json.dumps(report), encoding="utf-8")
    (tmp_path / SCENE).symlink_to(ROOT / "generated" / SCENE)
    drawn = front(library_of(SCENE), tmp_path, PALETTES["light"])
    lines = re.findall(r'points="([^"]*)"', drawn)
    assert len(lines) == len({*PALETTES["light"].curves, *THEIRS} - {"flow_exact"})
    passes = [p["passes"] for p in case["points"] if p["precision"] == "f64"]
    wanted = {f"{COST.at(1e4 * n)},{ERROR.at(1e-3 / n)}" for n in passes}
    assert {point for line in lines for point in line.split()} <= wanted
    assert f"M{COST.at(1e4)} {ERROR.at(1e-3) - 7}l1.7" in drawn  # the star, of one pass


@pytest.mark.parametrize("name", PALETTES)
def test_its_words_stand_out_from_their_ground(name: str) -> None:
    own = PALETTES[name]
    words = (own.ink, own.soft, *own.curves.values())
    assert min(_contrast(word, ground) for word in words for ground in _grounds(own)) >= CONTRAST
    assert _contrast(own.frame, own.panel) < CONTRAST  # a line that divides, and no word


def _grounds(own: Palette) -> list[str]:
    return [own.panel, PAGES["dark" if own is PALETTES["dark"] else "light"]]


def _contrast(one: str, other: str) -> float:
    """Return the ratio of luminances of two colours, by WCAG 2.2."""
    dark, light = sorted(map(_luminance, (one, other)))
    return (light + 0.05) / (dark + 0.05)


def _luminance(colour: str) -> float:
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
