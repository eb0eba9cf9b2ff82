"""Eva finds no run-time error in the C of scenes, and finds each that is put into it."""

import math
import re
from fractions import Fraction

import numpy as np
import pytest

from derive.check.eva import shown_by_eva, with_bounds_of_sines
from derive.cli import main
from derive.emit.c.source import c_files
from derive.program.program import component_names
from derive.program.run import run
from derive.verify.enclosure import sectors
from derive.verify.operators import IN_BALLS
from tests.made import library_of

NAME = "free_body_principal"
needs_eva = pytest.mark.target


@pytest.mark.parametrize("name", [NAME, "heavy_top", "rigid_body"])
def test_parts_have_every_input_and_what_set_up_makes_of_every_parameter(name: str) -> None:
    made = library_of(name)
    function, setup = made.functions[0], made.setup
    given = [q for q in (*setup.inputs, *function.inputs) if q.role != "constants"]
    box = {c: q.ends for q in given for c in q.components}
    cut = sectors(setup, function, [box])
    assert cut
    random = np.random.default_rng(1)
    for _ in range(100):
        at = {n: low + (high - low) * Fraction(random.random()) for n, (low, high) in box.items()}
        balls = [IN_BALLS["number"](at[c]) for q in setup.inputs for c in q.components]
        constants = dict(zip(component_names(setup), run(setup, IN_BALLS, balls), strict=True))
        assert any(
            all(low <= at[n] <= high for n, (low, high) in part.inputs.items())
            and all(part.constants[n].overlaps(x) for n, x in constants.items())
            for part in cut
        )


def test_what_can_vanish_is_not_cut_away() -> None:
    """A gyrocompass has no pole; a top at theta = 0 has one, which no part may hold."""
    made = library_of("heavy_top")
    function = next(p for p in made.functions if p.name == "state_rate")
    given = [q for q in (*made.setup.inputs, *function.inputs) if q.role != "constants"]
    box = {c: q.ends for q in given for c in q.components}
    assert sectors(made.setup, function, [box])
    assert sectors(made.setup, function, [box | {"theta": (Fraction(-1), Fraction(1))}]) is None


def test_bounds_of_sines_hold_and_are_near() -> None:
    text = c_files(library_of("heavy_top"), ())["heavy_top_f64.c"]
    bounded = with_bounds_of_sines(text)
    assert "fabs(angle)" in text
    assert "fabs(angle)" not in bounded
    number = r"Frama_C_double_interval\((\S+), (\S+)\)"
    pieces = rf"angle >= (\S+) && angle <= (\S+)\) {{\s+found.sine = {number};\s+"
    rows = re.findall(rf"{pieces}found.cosine = {number};", bounded)
    assert len(rows) == 224
    for low, high, *ends in rows:
        a, b = float(low), float(high)
        s0, s1, c0, c1 = (float.fromhex(end) for end in ends)
        for angle in (a, b, (a + b) / 2, a + 0.3 * (b - a)):
            assert s0 <= math.sin(angle) <= s1
            assert c0 <= math.cos(angle) <= c1
        assert s1 - s0 < 2 * (b - a)
        assert c1 - c0 < 2 * (b - a)


@needs_eva
@pytest.mark.parametrize("name", [NAME, "heavy_top", "gyrocompass"])
def test_eva_finds_nothing_in_a_scene(name: str) -> None:
    found = [*shown_by_eva(library_of(name))]
    assert found
    assert {v.outcome for v in found} == {"holds"}


@needs_eva
@pytest.mark.parametrize(("old", "new", "says"), [
    ("omega_dot[2] = t11;", "omega_dot[3] = t11;", "omega_dot"),
    ("= t2 * constants->one_over_I_xx;", "= t2 / omega[0];", "is_finite"),
    ("= omega[1] * omega[2];", "= omega[1] * 1e38F;", "non-finite"),
    ("const float t3 = t2", "float t99;\n    const float t3 = t99 + t2", "initialized"),
])  # fmt: skip
def test_eva_finds_what_is_put_into_the_c(old: str, new: str, says: str) -> None:
    made = library_of(NAME)
    file, texts = f"{NAME}_f32.c", c_files(made, ())
    assert old in texts[file]
    texts[file] = texts[file].replace(old, new, 1)
    found = [v for v in shown_by_eva(made, texts) if v.precision == "f32"]
    (row,) = [v for v in found if v.outcome != "holds"]
    assert row.function == "acceleration"
    assert says in row.says


def test_without_frama_c_the_command_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "")
    assert main(["check", NAME, "--eva"]) == 2
    assert "check: --eva needs frama-c" in capsys.readouterr().err
    assert main(["check", NAME, "--eva", "--target", "m4f"]) == 2
    assert main(["check", NAME, "--eva", "--samples", "64"]) == 2
