"""What a step changes by if a parameter does: through set-up, the rates and the stages."""

import re
from functools import cache
from typing import Any

import pytest

from derive.library.library import Library, library
from derive.program.run import run
from derive.scene import CATALOGUE, parse_scene
from tests.motion.systems import PRINCIPAL, SIXTY_DIGITS, Values, at, start
from tests.motion.test_step_jacobian import EXACTLY, SMALL, entries

pytestmark = pytest.mark.long

WANTED = re.compile(r"wanted *= *\[[^\]]*\]", re.DOTALL)
ASKED = 'wanted = ["step_rk4", "step_rk4_sensitivity"]'
SCENES = ("principal", "rigid_body", "gyrostat", "heavy_top")


@cache
def sensitive(name: str) -> Library:
    """Return the programs of a scene of which a step and its sensitivity are wanted."""
    text = PRINCIPAL
    if name != "principal":
        text = (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
    return library(parse_scene(WANTED.sub(ASKED, text), name))


def prepared(made: Library, values: Values) -> Values:
    """Return values with the constants that set-up makes of the parameters among them."""
    given = [values[c] for q in made.setup.inputs for c in q.components]
    names = [c for q in made.setup.outputs for c in q.components]
    return dict(values) | dict(zip(names, run(made.setup, SIXTY_DIGITS, given), strict=True))


def slope(made: Library, values: Values, parameter: str) -> list[Any]:
    """Return the derivative of a step by a parameter: differences through set-up."""
    before2, before, after, after2 = (
        at(
            made["step_rk4"],
            prepared(made, dict(values) | {parameter: values[parameter] * (1 + part * SMALL)}),
        )
        for part in (-2, -1, 1, 2)
    )
    over = 12 * SMALL * values[parameter]
    terms = zip(before2, before, after, after2, strict=True)
    return [(8 * (c - b) - (d - a)) / over for a, b, c, d in terms]


@pytest.mark.parametrize("name", SCENES)
def test_the_sensitivity_is_the_slope_by_each_parameter(name: str) -> None:
    made, values = sensitive(name), dict(start(name))
    program = made["step_rk4_sensitivity"]
    found = entries(program, prepared(made, values))
    pattern = (program.sparsity or {})["jacobian"]
    assert pattern.columns == tuple(c for q in made.vocabulary.parameters for c in q.components)
    for column in pattern.columns:
        for row, expected in zip(pattern.rows, slope(made, values, column), strict=True):
            assert abs(found.get((row, column), 0) - expected) < EXACTLY, (row, column)


def test_what_parameters_alone_make_is_made_in_set_up() -> None:
    made = sensitive("principal")
    assert made["step_rk4_sensitivity"].count["div"] <= 2  # the norm and the length
    assert made["step_rk4_sensitivity"].flops() <= 905
    assert made.setup.count["div"] >= 3
