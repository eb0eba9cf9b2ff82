"""Loops told to SymPy accelerate as ours do, and what is told otherwise is seen."""

from dataclasses import replace
from pathlib import Path

import pytest

from bench import loops
from bench.kane import equations
from bench.links import asking, same
from derive.library.library import library
from derive.mechanics.mechanism import Mechanism, mechanism

BY_FORMULA = Path("tests/mechanics/scenes/sleigh.toml")
BY_POINTS = Path("tests/mechanics/scenes/four_bar_closed.toml")
BY_VELOCITIES = Path("bench/machines/disc_on_floor.toml")
FEW_U = 64 * 2.0**-53


def told(path: Path, old: str = "", new: str = "") -> Mechanism:
    text = path.read_text(encoding="utf-8")
    assert old in text
    scene = asking(text.replace(old, new) if old else text, path.stem)
    assert scene is not None
    return mechanism(scene)


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        (BY_FORMULA, "y_dot*cos(psi)", "2*y_dot*cos(psi)"),
        pytest.param(BY_POINTS, 'to = ["0", "0", "-l"]', 'to = ["0", "0", "-l/2"]',
                     marks=pytest.mark.long),
        pytest.param(BY_VELOCITIES, 'at = ["0", "0", "-r"]', 'at = ["0", "0", "-r/2"]',
                     marks=pytest.mark.long),
    ],
    ids=["formula", "points", "velocities"],
)  # fmt: skip
def test_what_holds_a_machine_is_told_to_sympy(path: Path, old: str, new: str) -> None:
    own = told(path)
    assert same(own, equations(own))
    assert not same(own, equations(told(path, old, new)))


@pytest.mark.long
def test_a_loop_errs_by_little_beside_equations_of_another_author() -> None:
    own = told(BY_FORMULA)
    made, found = library(own.scene), equations(own)
    assert loops.error(made, found) < FEW_U
    assert loops.error(made, replace(found, rests=-found.rests)) > FEW_U


def test_every_machine_of_the_table_is_a_scene() -> None:
    assert all(path.exists() for _, path in loops.LOOPS)


def test_pivots_are_the_largest_that_are_left() -> None:
    assert loops.pivots(loops.np.array([[1.0, 3.0, 0.0], [1.0, 3.0, 2.0]])) == [1, 2]
