"""Whatever a file holds, it is a scene or it is refused by one sentence that names the scene."""

import re
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.scene import CATALOGUE, SceneError, catalogue, load, parse_scene

TEXTS = [(CATALOGUE / f"{name}.toml").read_text(encoding="utf-8") for name in catalogue()]
VALUES = re.compile(r"(?<== )(?:\"[^\"\n]*\"|\[[^]\n]*\]|[-0-9.e]+)")
ODD = [
    *("0", "-1", "1e999999999999999999999", "nan", "-inf", "true", "1979-05-27", "[]", "{}", '""'),
    *("[0, 0]", "[0, 0, 0]", "[1, 2, 3]", "[[1], [2], [3]]", '["x"]', "[-1e300, 1e300]"),
    *('"m*g"', '"0"', '"a/0"', '"sqrt(-1)"', '"1/(W - W)"', '"psi"', '"z psi"', '"1e300^16"'),
    *('"quaternion"', '"body"', '"fixed"', '"moving"', '"sphere"', '"rod"', '"free"', '"kg m^2"'),
    *("{ range = [1, 2] }", "{ value = 1e-300, unit = '1' }", "0x" + "f" * 5000, "9" * 4400),
    *("[" * 2000 + "]" * 2000, "'\\u0000'", '"*/"', '"' + "(" * 500 + '"', '["x psi", "x psi"]'),
]

SPHERE = "[body]\nkind = 'spherical'\nmoment = 1"
LIST = "must be a list of at least one function"
KNOWN = (
    "angular_momentum, angular_momentum_rate, moment, acceleration, state_rate, kinetic_energy, "
    "and more in docs/scenes.md and docs/motion.md"
)


def refusal(text: str, name: str = "odd") -> str:
    """Return the sentence that refuses a text."""
    with pytest.raises(SceneError) as found:
        parse_scene(text, name)
    return str(found.value)


@given(st.text())
def test_any_text_is_a_scene_or_a_scene_error(text: str) -> None:
    assert refusal(text).startswith("scene 'odd': ")


@given(st.sampled_from(TEXTS), st.data())
def test_any_scene_with_odd_values_is_a_scene_or_a_scene_error(
    text: str, data: st.DataObject
) -> None:
    for _ in range(data.draw(st.integers(1, 3))):
        places = [match.span() for match in VALUES.finditer(text)]
        start, end = data.draw(st.sampled_from(places or [(0, 0)]))
        text = text[:start] + data.draw(st.sampled_from(ODD)) + text[end:]
    with suppress(SceneError):
        assert parse_scene(text, "odd").name == "odd"


KEYED = re.compile(r"^(\w+) *= *(.+)$", re.MULTILINE)
EACH = {m[1]: (text, m.span(2)) for text in TEXTS for m in KEYED.finditer(text)}
"""An entry of each name, and where its value stands."""


@pytest.mark.parametrize(
    "odd", ["nan", "-inf", "true", *(pytest.param(odd, marks=pytest.mark.long) for odd in ODD)]
)
def test_every_entry_takes_an_odd_value_or_refuses_it(odd: str) -> None:
    assert "horizon" in EACH
    for text, (start, end) in EACH.values():
        with suppress(SceneError):
            assert parse_scene(text[:start] + odd + text[end:], "odd").name == "odd"


@given(st.sampled_from(TEXTS), st.data())
def test_any_scene_with_lines_lost_or_moved_is_a_scene_or_a_scene_error(
    text: str, data: st.DataObject
) -> None:
    lines = text.splitlines()
    kept = data.draw(st.permutations(lines)) if data.draw(st.booleans()) else lines
    first, last = sorted(data.draw(st.tuples(*[st.integers(0, len(kept))] * 2)))
    with suppress(SceneError):
        assert parse_scene("\n".join(kept[:first] + kept[last:]), "odd").name == "odd"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "the file is empty"),
        (" \n\t\n", "the file is empty"),
        ("# nothing but a comment", "the file needs 'wanted', above its first [table]"),
        ("wanted = [", "the file is not TOML: Invalid value (at end of document)"),
        ("a = " + "[" * 5000, "the file is not TOML: brackets are nested too deeply"),
        ("#" * 200_001, "the file is longer than 200000 characters"),
        ("wanted = ['moment']", "the file needs 'body'"),
        ("wanted = []", "the file needs 'body'"),
        ("wanted = []\nbody = 3", "body must be a table, not 3"),
        ("wanted = ['moment']\n[body]", "body needs either a kind or a shape, and has neither"),
        (f"wanted = 'moment'\n{SPHERE}", f"wanted {LIST}, not 'moment'"),
        (f"wanted = []\n{SPHERE}", f"wanted {LIST}, not a list of 0, []"),
        (f"wanted = [3]\n{SPHERE}", f"wanted has 3, which is no function (known: {KNOWN})"),
    ],
)
def test_a_file_without_a_scene_says_what_it_lacks(text: str, says: str) -> None:
    assert refusal(text) == f"scene 'odd': {says}"


@pytest.mark.parametrize("name", ["2nd", "a-b", "int", "", "a" * 41, "é", "_x", "a__b"])
def test_a_scene_s_name_must_serve_in_c_and_python(name: str) -> None:
    assert "name" in refusal(TEXTS[0], name)


def loaded(path: Path | str) -> str:
    """Return the sentence with which ``load`` refuses."""
    with pytest.raises(SceneError) as found:
        load(path)
    return str(found.value)


def test_files_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    strange, long = tmp_path / "strange.toml", tmp_path / "long.toml"
    strange.write_bytes(b"title = '\xff'")
    long.write_bytes(b"#" * 300_000)
    (tmp_path / "folder.toml").mkdir()
    assert loaded(strange) == f"scene 'strange': {strange} is not UTF-8 (byte 9)"
    assert loaded(long) == f"scene 'long': {long} is longer than 200000 bytes"
    assert loaded(tmp_path) == f"scene '{tmp_path.stem}': {tmp_path} is not a file"
    folder, missing = tmp_path / "folder.toml", tmp_path / "missing.toml"
    assert loaded(folder) == f"scene 'folder': {folder} is not a file"
    assert loaded(missing) == f"scene 'missing': {missing} does not exist"
    assert loaded("/dev/zero") == "scene 'zero': /dev/zero is not a file"


def test_a_name_that_is_nearly_in_the_catalogue_is_suggested() -> None:
    assert loaded("heavy_tap") == (
        "scene 'heavy_tap': neither in the catalogue nor a file (did you mean 'heavy_top'?)"
    )
    assert "neither in the catalogue nor a file" in loaded("heavy_tap\0")
    assert len(loaded("x" * 5000)) < 400


def test_a_scene_is_the_same_by_name_by_path_and_with_a_byte_order_mark(tmp_path: Path) -> None:
    source = CATALOGUE / "heavy_top.toml"
    marked = tmp_path / "heavy_top.toml"
    marked.write_bytes(b"\xef\xbb\xbf" + source.read_bytes())
    assert load("heavy_top") == load(source) == load(str(source)) == load(marked)


def test_a_folder_in_the_way_does_not_hide_a_scene_of_the_catalogue(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "gyrostat").mkdir()
    monkeypatch.chdir(tmp_path)
    assert load("gyrostat").name == "gyrostat"


def test_a_known_vector_that_is_neither_a_range_nor_formulas_is_told_of_both() -> None:
    says = refusal(f"wanted = ['moment']\nknown.moment = 16\n{SPHERE}")
    assert says.endswith("known.moment must be { range = [low, high] } or three formulas, not 16")
