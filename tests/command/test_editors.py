"""What editors and shells are told: a schema that knows scenes, a scene to begin with, words."""

import json
import re
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from derive.cli import COMMANDS, main
from derive.command.new import STARTERS
from derive.library.library import library
from derive.scene import CATALOGUE, SceneError, catalogue, entry, load, parse_scene
from derive.scene.schema import OF_ANY, OF_KIND, schema, schema_text

ROOT = Path(__file__).parents[2]
FILES = sorted({*ROOT.glob("tests/**/*.toml"), *ROOT.glob("bench/**/*.toml"),
                *CATALOGUE.glob("*.toml"), *STARTERS.glob("*.toml")})  # fmt: skip
REFUSED = tomllib.loads((ROOT / "tests/scene/refusals.toml").read_text(encoding="utf-8"))
STRUCTURAL = 39  # of the edits that are refused: those of tables, entries, words and kinds
LARGEST = 80_000  # characters that an editor reads at once


@pytest.fixture(scope="module")
def by() -> Any:
    """Return what validates by the schema, in which there must be no mistake."""
    validator = pytest.importorskip("jsonschema").Draft7Validator
    validator.check_schema(schema())
    return validator(schema())


def accepted() -> Iterator[Path]:
    for file in FILES:
        try:
            parse_scene(file.read_text(encoding="utf-8"), file.stem)
        except SceneError:
            continue
        yield file


@pytest.mark.long
def test_the_schema_accepts_every_scene_that_the_reader_accepts(by: Any) -> None:
    files = list(accepted())
    assert len(files) > 85
    texts = (file.read_text(encoding="utf-8") for file in files)
    assert [e.message for text in texts for e in by.iter_errors(tomllib.loads(text))] == []


def edits() -> Iterator[dict[str, object]]:
    """Yield files that the reader refuses, as far as they are TOML."""
    for name, rows in REFUSED.items():
        base = (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
        for row in rows:
            try:
                yield tomllib.loads(base.replace(row["old"], row["new"], 1))
            except tomllib.TOMLDecodeError:
                continue


def test_the_schema_refuses_what_is_wrong_with_tables_entries_and_words(by: Any) -> None:
    assert len([edit for edit in edits() if not by.is_valid(edit)]) >= STRUCTURAL


def test_the_schema_knows_every_kind_of_entry_and_is_small() -> None:
    assert {*OF_KIND, "any"} == {*entry.READERS}
    assert OF_ANY.keys() == {"wanted", "rate", "acceleration", "force", "couple", "lengths",
                             "formula", "gravity_gradient", "unit", "unknown", "vanishes",
                             "name", "zero", "axes", "dependent"}  # fmt: skip
    assert len(schema_text()) < LARGEST


def test_the_catalogue_names_its_schema_which_is_what_the_command_prints(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["schema"]) == 0
    printed = capsys.readouterr().out
    assert (CATALOGUE / "scene.schema.json").read_text(encoding="utf-8") == printed
    assert json.loads(printed)["required"] == ["wanted"]
    for file in CATALOGUE.glob("*.toml"):
        assert file.read_text(encoding="utf-8").startswith("#:schema scene.schema.json\n")


def test_the_line_for_editors_is_no_part_of_a_scene() -> None:
    text = (CATALOGUE / "heavy_top.toml").read_text(encoding="utf-8")
    assert parse_scene(text.partition("\n")[2], "heavy_top") == load("heavy_top")


@pytest.mark.parametrize("what", ["body", "machine"])
def test_a_new_scene_is_complete_as_it_stands_and_replaces_nothing(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", what, "mine"]) == 0
    text = Path("mine.toml").read_text(encoding="utf-8")
    assert "derive generate mine.toml" in text
    assert Path("scene.schema.json").read_text(encoding="utf-8") == schema_text()
    made = library(parse_scene(text, "mine"))
    assert (made.scene.warnings, made.mechanism.doubts()) == ((), ())
    Path("mine.toml").write_text("# mine\n", encoding="utf-8")
    assert main(["new", what, "mine"]) == 2
    assert "mine.toml is there already" in capsys.readouterr().err
    assert Path("mine.toml").read_text(encoding="utf-8") == "# mine\n"


@pytest.mark.parametrize("name", ["../up", "double", "a b", "aux", ""])
def test_a_name_that_no_scene_may_have_starts_none(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "body", name]) == 2
    assert "the file has the name" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


COMMANDS_SAID = [pytest.param(what, command, marks=[pytest.mark.long] * (command == "generate"))
                 for what in ("body", "machine") for command in ("generate", "solve")]  # fmt: skip


@pytest.mark.parametrize(("what", "command"), COMMANDS_SAID)
def test_the_commands_that_a_new_scene_speaks_of_work(
    what: str, command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", what, "mine"]) == 0
    said = re.findall(r"#\s+derive ([^\n]*)", Path("mine.toml").read_text(encoding="utf-8"))
    assert [line.split()[:2] for line in said] == [
        ["generate", "mine.toml"],
        ["solve", "mine.toml"],
    ]
    (own,) = (line.split() for line in said if line.startswith(command))
    assert main(own) == 0
    assert command == "solve" or (tmp_path / "generated/mine/mine_f64.c").is_file()


def completions(script: str, words: list[str], folder: Path) -> list[str]:
    """Return what a real bash offers for the last of some words."""
    line = f"COMP_WORDS=({' '.join(w or repr('') for w in words)}); COMP_CWORD={len(words) - 1}"
    asks = f'{script}\n{line}; _shtab_derive; printf "%s\\n" "${{COMPREPLY[@]}}"'
    done = subprocess.run(["bash", "-c", asks], cwd=folder, capture_output=True, check=True)
    return done.stdout.decode().split()


def test_bash_completes_commands_options_scenes_and_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    (tmp_path / "mine.toml").touch()
    (tmp_path / "mine.txt").touch()
    assert completions(script, ["derive", "gen"], tmp_path) == ["generate"]
    assert completions(script, ["derive", "solve", "heavy_t"], tmp_path) == ["heavy_top"]
    assert completions(script, ["derive", "generate", "mi"], tmp_path) == ["mine.toml"]
    assert completions(script, ["derive", "equations", "--la"], tmp_path) == ["--latex"]
    assert {*catalogue()} <= {*completions(script, ["derive", "check", ""], tmp_path)}


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command_has_an_example(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([command, "--help"])
    assert (
        f"examples:\n  {'eval' if command == 'completion' else 'derive'}" in capsys.readouterr().out
    )
