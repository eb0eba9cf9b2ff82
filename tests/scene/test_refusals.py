"""A scene that breaks a rule is refused by one sentence, and every rule is needed for that.

The table ``refusals.toml`` holds one edit of a scene of the catalogue a row, with its sentence.
"""

import tomllib
from pathlib import Path

import pytest

from derive.scene import CATALOGUE, SceneError, parse_scene
from derive.scene.short_form import rules as scene_rules

TABLE = tomllib.loads((Path(__file__).parent / "refusals.toml").read_text(encoding="utf-8"))
ROWS = [(name, row["old"], row["new"], row["says"]) for name in TABLE for row in TABLE[name]]
RULES = [
    "_relative_motion",
    "_symmetry",
    "_turns",
    "_attitude",
    "_known",
    "_point",
    "_position",
    "_wheels",
    "_forward",
    "_steps_admitted",
    "check_inertia",
    "check_unit",
    "carrier_doubts",
]


def edited(name: str, old: str, new: str) -> str:
    text = (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
    assert old in text
    return text.replace(old, new, 1)


def sentence(name: str, old: str, new: str) -> str:
    """Return the sentence that refuses an edited scene, "" if it is accepted."""
    try:
        parse_scene(edited(name, old, new), name)
    except SceneError as error:
        return str(error)
    return ""


@pytest.mark.parametrize(("name", "old", "new", "says"), ROWS)
def test_an_edit_that_breaks_a_rule_is_refused_by_one_sentence(
    name: str, old: str, new: str, says: str
) -> None:
    assert sentence(name, old, new) == f"scene '{name}': {says}"


@pytest.mark.parametrize("rule", RULES)
def test_a_rule_that_is_left_out_lets_an_edit_pass(
    rule: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene_rules, rule, lambda *_: ())
    assert any(passes(name, old, new) for name, old, new, _ in ROWS)


def passes(name: str, old: str, new: str) -> bool:
    """Tell whether an edit is not refused by a sentence, whatever else befalls it."""
    try:
        return sentence(name, old, new) == ""
    except ValueError:
        return True
