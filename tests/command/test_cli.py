"""The command line does what it says, and bad input gets one sentence, exit code 2 and no file."""

import re
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest

from derive.check import as_made
from derive.check.emitted import files, sampling_of
from derive.cli import main
from derive.emit.c.comment import of_what
from derive.emit.files import OutputError, folders_left_over, write
from derive.verify.prove import ProofError
from derive.verify.reference import NoValueError
from tests.made import library_of

SCENE = "free_body_principal"
FEW = ("--samples", "256")
FEWER = " ".join(FEW)


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    with redirect_stdout(StringIO()) as told:
        assert main(["generate", *FEW, SCENE, "--out", str(folder)]) == 0
    folder.with_suffix(".told").write_text(told.getvalue())
    return folder


@pytest.mark.long
def test_what_a_function_costs_is_told_and_what_its_errors_are_a_part_of(made):
    told, program = made.with_suffix(".told").read_text(), library_of(SCENE)["acceleration"]
    assert re.search(rf"^ *acceleration +{program.flops()} 0( +[\d.]+){{4}} *$", told, re.M)
    assert f"here a part {of_what(program)} (acceleration" in " ".join(told.split())


def test_every_file_states_the_command_that_makes_it_again(made):
    texts, command = contents(made), f"derive generate {SCENE} {FEWER}".encode()
    assert {name for name, text in texts.items() if command not in text} == {"lecture.html"}


def test_files_of_few_samples_are_found_to_be_as_made(made):
    by = sampling_of(made, SCENE)
    found = files(library_of(SCENE), made, by)
    assert found.differ == ()
    assert as_made(library_of(SCENE), found, SCENE).says == f"{made / SCENE}: as made by {FEWER}"


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_a_scene_becomes_its_files_and_no_others(made):
    ends = ("_f32.c", "_f32.h", "_f64.c", "_f64.h", "_casadi.py", ".json", ".html")
    assert contents(made).keys() == {"lecture.html", *(f"{SCENE}/{SCENE}{end}" for end in ends)}


def test_what_was_generated_passes_the_check(made):
    assert main(["generate", *FEW, SCENE, "--out", str(made), "--check"]) == 0


@pytest.mark.parametrize("ending", ["_f32.c", "_f64.h", ".json", "_casadi.py", ".html"])
def test_an_edit_of_any_file_fails_the_check_with_the_mending_command(made, ending, capsys):
    file = made / SCENE / f"{SCENE}{ending}"
    before = file.read_bytes()
    file.write_bytes(before.replace(b"0", b"1", 1))
    found = contents(made)
    try:
        assert main(["generate", *FEW, SCENE, "--out", str(made), "--check"]) == 1
        shown = capsys.readouterr()
        assert f"{SCENE}{ending}" in shown.out
        assert f"derive generate {SCENE} --samples 256 --out" in " ".join(shown.err.split())
        assert contents(made) == found
    finally:
        file.write_bytes(before)


def test_a_missing_and_a_left_over_file_fail_the_check(made, capsys):
    file = made / SCENE / f"{SCENE}_f64.h"
    aside = file.rename(file.with_name("left_over.h"))
    try:
        assert main(["generate", *FEW, SCENE, "--out", str(made), "--check"]) == 1
        shown = capsys.readouterr()
        assert "missing" in shown.out
        assert "no scene makes this file" in shown.out
        assert "2 files differ" in shown.err
        assert f"derive generate {SCENE} --samples 256 --out {made}\n" in shown.err
        assert f"rm {aside}\n" in shown.err
    finally:
        aside.rename(file)


def test_a_file_that_is_only_left_over_is_mended_by_deleting_it(made, capsys):
    extra = made / SCENE / "left over.h"
    extra.write_text("")
    try:
        assert main(["generate", *FEW, SCENE, "--out", str(made), "--check"]) == 1
        shown = capsys.readouterr().err
        assert "1 file differs" in shown
        assert f"rm '{extra}'\n" in shown
        assert "derive generate" not in shown
    finally:
        extra.unlink()


def test_the_folder_of_a_scene_that_is_no_more_is_left_over(tmp_path):
    for name in ("gone/gone.json", "gone/gone_f64.c", "notes/mine.txt", "kept/kept.json"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    found = list(folders_left_over(tmp_path, {"kept/kept.json": "", "index.html": ""}))
    assert [d.name for d in found] == ["gone/gone.json", "gone/gone_f64.c"]
    assert all(d.left_over for d in found)


@pytest.mark.long
def test_an_edit_of_the_scene_fails_the_check(made, tmp_path, capsys):
    catalogue = Path(__file__).parents[2] / "derive" / "scene" / "catalogue"
    text = (catalogue / f"{SCENE}.toml").read_text()
    other = tmp_path / f"{SCENE}.toml"
    other.write_text(text.replace("title", "# a remark\ntitle", 1))
    assert main(["generate", *FEW, str(other), "--out", str(made), "--check"]) == 1
    assert "sha256" in capsys.readouterr().out


def test_files_of_a_scene_outside_the_catalogue_name_its_file(tmp_path):
    body = '[body]\nkind = "spherical"\nmoment = "1"\n'
    source = scene(tmp_path, "ball", '"acceleration"', body)
    assert main(["generate", *FEW, source, "--out", str(tmp_path / "out")]) == 0
    made = contents(tmp_path / "out")
    assert made.pop("lecture.html")
    assert len(made) == 7
    assert all(b"derive generate ball.toml" in text for text in made.values())


def test_a_bad_scene_gets_one_sentence_and_no_file(tmp_path, capsys):
    scene = tmp_path / "broken.toml"
    scene.write_text('title = "x"\nwanted = ["moment"]\n[body]\nkind = "cube"\n')
    assert main(["generate", *FEW, str(scene), "--out", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err.count("\n") <= 3
    assert not (tmp_path / "out").exists()


def test_an_unknown_scene_and_an_unknown_assumption_are_refused(capsys):
    assert main(["generate", *FEW, "free_bodi"]) == 2
    assert "free_body" in capsys.readouterr().err
    assert main(["lecture", "--without", "newtom"]) == 2
    assert "newton" in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_named_and_nothing_is_left(tmp_path, capsys):
    in_the_way = tmp_path / "a_file"
    in_the_way.write_text("")
    assert main(["generate", *FEW, SCENE, "--out", str(in_the_way)]) == 2
    assert "a_file" in " ".join(capsys.readouterr().err.split()).replace(" ", "")
    assert contents(tmp_path) == {"a_file": b""}


def test_files_are_replaced_as_a_whole_or_not_at_all(tmp_path):
    (tmp_path / "kept").write_text("old")
    (tmp_path / "blocked").mkdir()
    with pytest.raises(OutputError, match="blocked"):
        write(tmp_path, {"kept": "new", "blocked": "x"})
    assert contents(tmp_path) == {"kept": b"old"}


def test_nothing_temporary_is_left_by_whatever_ends_the_writing(tmp_path, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("derive.emit.files.os.replace", stop)
    with pytest.raises(KeyboardInterrupt):
        write(tmp_path, {"one": "new", "two": "new"})
    monkeypatch.setattr("derive.emit.files.os.chmod", stop)
    with pytest.raises(KeyboardInterrupt):
        write(tmp_path, {"one": "new"})
    assert contents(tmp_path) == {}


def test_the_catalogue_is_listed(capsys):
    assert main(["scenes"]) == 0
    assert SCENE in capsys.readouterr().out


def test_help_names_every_command(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    shown = capsys.readouterr().out
    words = ("lecture", "generate", "check", "report", "solve", "scenes")
    assert all(word in shown for word in words)


def scene(tmp_path, name: str, wanted: str, body: str) -> str:
    file = tmp_path / f"{name}.toml"
    file.write_text(f'title = "{name}"\nwanted = [{wanted}]\n{body}')
    return str(file)


def test_two_scenes_of_one_name_are_refused(tmp_path, capsys):
    body = '[body]\nkind = "spherical"\nmoment = "1"\n'
    source = scene(tmp_path, SCENE, '"acceleration"', body)
    assert main(["generate", *FEW, SCENE, source, "--out", str(tmp_path / "out")]) == 2
    assert f"are both '{SCENE}'" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_body_beyond_the_float_range_is_refused(tmp_path, capsys):
    body = '[body]\nkind = "spherical"\nmoment = "1e300"\n'
    source = scene(tmp_path, "huge", '"acceleration", "kinetic_energy"', body)
    assert main(["generate", *FEW, source, "--out", str(tmp_path / "out")]) == 2
    assert "within f32" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_range_beyond_the_float_range_is_refused(tmp_path, capsys):
    body = '[parameters]\nB = { unit = "kg m^2", range = [1e40, 1e41] }\n'
    body += '[body]\nkind = "spherical"\nmoment = "B"\n'
    source = scene(tmp_path, "huge", '"acceleration"', body)
    assert main(["generate", *FEW, source, "--out", str(tmp_path / "out")]) == 2
    assert "the range of 'B' must fit a float, up to 3.4e38" in capsys.readouterr().err


@pytest.mark.long
def test_a_broken_triangle_inequality_warns_and_does_not_stop(tmp_path, capsys):
    body = '[body]\nkind = "principal"\nmoments = ["1", "1", "3"]\n'
    source = scene(tmp_path, "flat", '"acceleration"', body)
    assert main(["generate", *FEW, source, "--out", str(tmp_path / "out")]) == 0
    assert "scene 'flat': body inertia breaks the triangle inequality" in capsys.readouterr().err
    assert (tmp_path / "out" / "flat" / "flat_f64.c").is_file()


def test_a_jacobian_of_what_does_not_vary_is_refused(tmp_path, capsys):
    still = '[coordinates.b]\nunit = "rad"\nrange = [0, 1]\nmeaning = "tilt"\n'
    still += 'motion = "prescribed"\nrate = 0\nacceleration = 0\n'
    still += '[speeds]\np = { unit = "rad/s", range = [1, 2], meaning = "spin", rate = 0 }\n'
    still += '[axes]\nturned = ["y b"]\n'
    still += '[body]\nshape = "disc"\nmass = 2\nradius = 0.5\naxis = "z"\nspin = "p"\n'
    source = scene(tmp_path, "still", '"moment_jacobian"', still)
    assert main(["generate", *FEW, source, "--out", str(tmp_path / "out")]) == 2
    assert "'moment_jacobian' must have entries" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("raised", "code"),
    [(ProofError("'moment' differs"), 1), (NoValueError("no solution"), 2)],
)
def test_what_fails_its_proof_is_told_from_bad_input(raised, code, monkeypatch, capsys):
    def fails(_):
        raise raised

    monkeypatch.setattr("derive.solve.generation.prove", fails)
    assert main(["generate", *FEW, SCENE, "--check"]) == code
    assert str(raised) in capsys.readouterr().err


def test_a_bug_of_ours_is_not_called_bad_input(monkeypatch):
    def fails(*_):
        raise ZeroDivisionError

    monkeypatch.setattr("derive.solve.generation.figures_of", fails)
    with pytest.raises(ZeroDivisionError):
        main(["generate", *FEW, SCENE, "--check"])


def test_formulas_without_a_value_are_refused(tmp_path, capsys):
    body = '[parameters]\na = { unit = "kg m^2", range = [1, 2], meaning = "moment" }\n'
    body += '[body]\nkind = "spherical"\nmoment = "sqrt(a^2 - 9*a^2)"\n'
    source = scene(tmp_path, "hollow", '"kinetic_energy"', body)
    assert main(["generate", *FEW, source, "--out", str(tmp_path / "out")]) == 2
    assert "scene 'hollow'" in capsys.readouterr().err


def test_a_number_of_samples_is_a_whole_number_above_zero(capsys):
    for command in ("generate", "check"):
        for wrong in ("0", "-5", "many", "1e6", "9" * 20, "1000000001", "\u0663" * 11):
            assert main([command, SCENE, "--samples", wrong]) == 2
            rule = "must be a whole number above zero, up to 1000000000"
            assert f"{rule}, not '{wrong}'" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["generate", "check", "report"])
def test_of_several_scenes_all_are_posed_before_one_is_measured(
    command: str, tmp_path: Path, monkeypatch, capsys
):
    for module in ("derive.solve.generation", "derive.check"):
        monkeypatch.setattr(f"{module}.prove", lambda _: pytest.fail("a scene is begun"))
    bad = tmp_path / "bad.toml"
    bad.write_text('wanted = ["moment"]\nbody = { kind = "rod", axis = "z", moment = -1 }\n')
    assert main([command, SCENE, str(bad)]) == 2
    assert "scene 'bad'" in capsys.readouterr().err


def test_a_refusal_is_one_line_where_no_one_reads_it_on_a_screen(tmp_path, capsys):
    scene = tmp_path / "odd.toml"
    scene.write_text(f"wanted = ['{'x' * 300}']\nbody = {{ kind = 'spherical', moment = 1 }}\n")
    assert main(["generate", str(scene)]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
