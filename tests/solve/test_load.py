"""A scene is loaded by name, file or dict, by one reader; every refusal is of one class."""

import pickle
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive
from derive.emit.files import write
from derive.library.digest import digest_of_programs
from derive.scene import CATALOGUE, catalogue, document_text, parse_scene
from derive.solve.generation import page_anew
from tests.made import text_of

BALL = {"wanted": ["moment"], "body": {"kind": "spherical", "moment": 0.4}}
PAGE = Path(__file__).parents[2] / "docs" / "python.md"


def test_a_dict_is_the_scene_of_its_file() -> None:
    for name in catalogue()[::4]:
        document = tomllib.loads(text_of(name))
        told = parse_scene(document_text(document, name), name)
        read = parse_scene(text_of(name), name)
        for field in ("parameters", "bodies", "frames", "loads", "wanted", "coordinates", "title"):
            assert getattr(told, field) == getattr(read, field)


REFUSED: dict[str, tuple[Any, str]] = {
    "a scene that is a dict needs a name": (BALL, ""),
    "the file has the name '../x'": (BALL, "../x"),
    "body.moment must be text, a number, true or false, a list or a table, not NoneType": (
        {"wanted": ["moment"], "body": {"kind": "spherical", "moment": None}},
        "ball",
    ),
    "moment must be finite": (
        {"wanted": ["moment"], "body": {"kind": "spherical", "moment": np.inf}},
        "ball",
    ),
    "a key in the file must be text, not 1": ({1: 2}, "ball"),
    "the file is empty": ({}, "ball"),
    "must not hold */": (BALL | {"title": "a */ b"}, "ball"),
    "a scene is a name, a path or a dict, not int": (3, ""),
    "did you mean 'heavy_top'": ("heavy_to", ""),
    "a file names its scene": ("heavy_top", "other"),
}


def test_what_is_no_scene_is_refused_in_one_sentence() -> None:
    for sentence, (source, name) in REFUSED.items():
        with pytest.raises(derive.DeriveError) as refused:
            derive.load(source, name)
        assert sentence in str(refused.value)
    loop: dict[str, Any] = {"wanted": ["moment"]}
    loop["body"] = loop
    with pytest.raises(derive.DeriveError, match="nested deeper than"):
        derive.load(loop, "loop")


def test_numpy_numbers_are_numbers_of_a_scene() -> None:
    own = {"kind": "spherical", "moment": np.float64(0.4)}
    ball = derive.load(BALL | {"body": own}, "ball")
    assert ball is derive.load(BALL, "ball")
    given = {"omega": [1, 2, 3], "omega_dot": np.array([5, 0, 0])}
    assert ball.solve(given)["moment_x"] == 2.0


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"omga": 1}, "scene 'ball' has no 'omga' to set"),
        ({"omega": 1}, "omega must have the shape (3,)"),
        ({"omega_x": [1, 2]}, "omega_x must have the shape (), not (2,)"),
        ({"omega": [1, 2, 3], "omega_x": 1}, "'omega_x' is set twice"),
        ({"omega": [1, np.nan, 3]}, "omega_y must be finite, not nan"),
        ({"omega_x": "3deg"}, "omega_x=3deg: the value is in rad/s, not in deg"),
        ({"omega_x": None}, "omega_x must be a real number, not None"),
    ],
)
def test_values_that_make_no_sense_are_refused(values: dict[str, Any], sentence: str) -> None:
    with pytest.raises(derive.DeriveError) as refused:
        derive.load(BALL, "ball").solve(values)
    assert sentence in str(refused.value)


def test_a_scene_goes_to_another_process_by_its_text() -> None:
    ball = derive.load(BALL, "ball")
    assert pickle.loads(pickle.dumps(ball)) is ball  # noqa: S301


@pytest.mark.long
def test_a_scene_of_a_dict_is_generated_and_its_file_makes_the_same(tmp_path: Path) -> None:
    ball = derive.load(BALL, "ball")
    made = ball.generate(tmp_path / "one", samples=64)
    assert "ball/ball_f64.c" in made.files
    file = tmp_path / "ball.toml"
    file.write_text(ball.scene.text, encoding="utf-8")
    again = derive.compare([derive.load(file)], tmp_path / "one", samples=64)
    # the lecture, to which pages lead, comes with the first
    assert (again.files, again.differences) == (len(made.files) - 1, ())
    with pytest.raises(derive.DeriveError, match="samples must be a whole number above zero"):
        ball.generate(tmp_path, samples=0)
    with pytest.raises(derive.DeriveError, match="output folder"):
        ball.generate(file)


@pytest.mark.long
def test_generate_adds_c_for_casadi_where_it_is_asked_for(tmp_path: Path) -> None:
    wanted = ["step_rk4", "step_rk4_jacobian"]
    made = derive.load(BALL | {"wanted": wanted}, "ball").generate(
        tmp_path, samples=64, parts="casadi-external"
    )
    assert "ball/ball_external.c" in made.files
    assert "def external(" in (tmp_path / "ball" / "ball_casadi.py").read_text(encoding="utf-8")
    with pytest.raises(derive.DeriveError, match="parts must be"):
        derive.load(BALL, "ball").generate(tmp_path, samples=64, parts="every")  # type: ignore[arg-type]


def test_importing_the_package_imports_nothing_heavy() -> None:
    heavy = "{'numpy', 'sympy', 'casadi', 'flint', 'networkx', 'jinja2', 'rich'}"
    code = f"import sys, derive; print(sorted({heavy} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_name_of_the_interface_is_there_and_told_by_dir() -> None:
    for name in derive.__all__:
        assert getattr(derive, name).__doc__
        assert name in dir(derive)
    assert {name for names in derive.PLACES.values() for name in names} == {*derive.__all__}
    with pytest.raises(AttributeError, match="no attribute 'laod'"):
        _ = derive.laod  # type: ignore[attr-defined]


def test_the_catalogue_has_its_files() -> None:
    assert derive.load(CATALOGUE / "heavy_top.toml").scene == derive.load("heavy_top").scene


def test_a_second_answer_builds_nothing_anew() -> None:
    runner = derive.load("edge_runner_flat")
    given = {"m": 1200, "r": 0.6, "L": 0.9, "W": 3.2, "g": 9.81}
    first = runner.solve(given)
    built = dict(runner._instrument.built)
    assert runner.solve(given | {"m": 2400})["N"] == 2 * first["N"]
    assert runner._instrument.built == built
    assert set(built) > {"setup"}


def test_a_limit_is_of_one_component() -> None:
    with pytest.raises(derive.DeriveError, match="of one component is found, of omega_x, omega_y"):
        derive.load(BALL | {"wanted": ["kinetic_energy"]}, "ball").limits({}, "omega")


@pytest.mark.long
def test_a_report_leaves_the_files_of_its_scene_as_they_are_made(tmp_path: Path) -> None:
    ball = derive.load(BALL, "ball")
    ball.generate(tmp_path, samples=64)
    before = (tmp_path / "ball" / "ball.html").read_text(encoding="utf-8")
    said = f'{{"digest": "{digest_of_programs(ball.library)}", "best": "all is well"}}'
    (tmp_path / "ball" / "ball_report.json").write_text(said, encoding="utf-8")
    page = page_anew(ball.library, tmp_path)["ball/ball.html"]
    assert "all is well" in page
    assert "all is well" not in before
    differ = derive.compare([ball], tmp_path, samples=64).differences
    assert [d.name for d in differ] == ["ball/ball.html"]
    write(tmp_path, {"ball/ball.html": page})
    assert derive.compare([ball], tmp_path, samples=64).differences == ()
    (tmp_path / "ball" / "ball.json").write_text("{}", encoding="utf-8")
    assert page_anew(ball.library, tmp_path) == {}


def test_a_key_that_is_nearly_the_one_that_is_missing_is_named() -> None:
    with pytest.raises(derive.DeriveError, match=r"needs 'wanted'.* \(is it meant by 'wantd'\?\)"):
        derive.load({"wantd": ["moment"], "body": {}}, "ball")


@pytest.mark.parametrize("values", [[1, 2], {1: 2.0}, "m=2", None])
def test_values_that_have_no_names_are_refused_in_one_sentence(values: Any) -> None:
    top = derive.load("heavy_top")
    for ask in (top.solve, top.frequencies):
        with pytest.raises(derive.DeriveError, match=r"by name, as|a name is a text, not"):
            ask(values)
    if values is not None:
        with pytest.raises(derive.DeriveError, match=r"by name, as|a name is a text, not"):
            top.function("kinetic_energy", values)
    with pytest.raises(derive.DeriveError, match="name is a text, not int"):
        derive.load(BALL, name=5)  # type: ignore[arg-type]


def test_a_function_of_nothing_gives_zeros() -> None:
    """Nothing turns two discs on one axle: their accelerations rest on no input."""
    scene = Path(__file__).parents[1] / "mechanics" / "scenes" / "on_one_axis.toml"
    found = derive.load(scene).function("accelerations")()
    assert (found.a_ddot, found.b_ddot) == (0.0, 0.0)
