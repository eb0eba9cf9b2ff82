"""No function divides by what vanishes in the declared ranges while the equations are regular."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from derive.arithmetic import working
from derive.c_text import F64
from derive.library import Library, library
from derive.machine import answers
from derive.machine.mechanism import Mechanism, pole
from derive.machine.pivots import Pivots
from derive.machine.sweep import Weakest
from derive.measure import errors, references, replayed
from derive.reference import NoValueError
from derive.sample import Sample, samples
from derive.scene import parse_scene

TRIALS = Path(__file__).parents[1] / "data" / "trials"
CATS = {name: (TRIALS / f"{name}.toml").read_text() for name in ("straight_cat", "bent_cat")}
ALLOWED = 1e3  # u: a pole loses ten digits here, and what is not one a few
NEAR = (0.0, 1e-12, -1e-9, 1e-6)


def cat(name: str, wanted: str) -> Library:
    """Return the programs of a cat that wants one function."""
    lines = CATS[name].splitlines()
    return library(parse_scene("\n".join([f'wanted = ["{wanted}"]', *lines[2:]]), name))


def near_the_pole(made: Library) -> tuple[Sample, ...]:
    """Return samples at which the cat is straight, or nearly so."""
    (sample, *_) = samples(made.known, F64, 1, 0).each
    straight = sample.values.get("rest", 0.0)
    return tuple(
        Sample(k, "ordinary", sample.values | {"bend": straight + x}) for k, x in enumerate(NEAR)
    )


def worst(made: Library) -> float:
    """Return the largest error of a scene's functions near the pole, in u."""
    each = near_the_pole(made)
    found = replayed(replace(made, motions=()), each, F64, working(F64.dtype))
    every = [
        error
        for program, true in references(made, each)
        for one in errors(program, found[program.name], true, F64)
        for row in one.rows
        for error in row
    ]
    return max(e if np.isfinite(e) else np.inf for e in every)


CASES = (
    ("bent_cat", "waist"),
    pytest.param("bent_cat", "accelerations", marks=pytest.mark.long),
    pytest.param("straight_cat", "accelerations", marks=pytest.mark.long),
    pytest.param("straight_cat", "waist", marks=pytest.mark.long),
)


@pytest.mark.parametrize(("name", "wanted"), CASES)
def test_a_straight_cat_is_no_pole(name: str, wanted: str) -> None:
    assert worst(cat(name, wanted)) < ALLOWED


def test_without_the_search_the_pole_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(answers, "weakest", lambda *_: Weakest(1.0, {}))
    monkeypatch.setattr(Pivots, "vanish", lambda *_: False)
    with pytest.raises(NoValueError):  # the balances that are chosen then have no solution there
        worst(cat("bent_cat", "waist"))


UPRIGHT = """
wanted = ["accelerations"]
[parameters]
m = { unit = "kg", range = [1, 2] }
l = { unit = "m", range = [1, 2] }
[coordinates]
psi   = { unit = "rad", range = [-1, 1] }
theta = { unit = "rad", range = [-0.5, 0.5] }
[frames.arm]
turned = ["z psi", "x theta"]
[bodies.bob]
frame  = "arm"
shape  = "point"
mass   = "m"
centre = ["0", "0", "l"]
[loads]
pin = { on = "bob", force = "?pin" }
"""


def test_a_pole_that_the_machine_has_is_named_with_its_place() -> None:
    made = library(parse_scene(UPRIGHT, "upright"))
    assert isinstance(made.known, Mechanism)
    says = pole(made.known, "accelerations")
    assert says.startswith("the divisor of 'psi_ddot', 'theta_ddot' vanishes at ")
    assert ", theta = 0," in says
