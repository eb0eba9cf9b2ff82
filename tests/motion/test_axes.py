"""Which axis is the intermediate one is decided by numbers as it is by parameters."""

from typing import Any

import pytest
from flint import arb, ctx

from derive.library.library import Library, library
from derive.scene import parse_scene
from derive.verify.measure import results

BODY = """
title  = "Body whose moments may be numbers"
wanted = ["step_split"]
[parameters]
A = {{ unit = "kg m^2", range = [1, 3] }}
B = {{ unit = "kg m^2", range = [1, 3] }}
C = {{ unit = "kg m^2", range = [1, 3] }}
[axes]
fixed_in = "body"
attitude = "quaternion"
[body]
kind    = "principal"
moments = [{}, {}, {}]
[known]
angular_velocity = {{ range = [-10, 10] }}
moment           = [0, 0, 0]
[motion]
time_step = {{ range = [0, 0.02] }}
"""
MOMENTS = {"A": 1.25, "B": 2.0, "C": 1.5}
STATE = dict(
    zip(("omega_x", "omega_y", "omega_z", "time_step"), (1.0, -2.0, 0.5, 0.01), strict=True)
)
ATTITUDE = {f"attitude_{p}": x for p, x in zip("wxyz", (0.5, -0.5, 0.5, 0.5), strict=True)}


def body(*moments: str) -> Library:
    return library(parse_scene(BODY.format(*moments), "body"))


def moved(made: Library, moments: dict[str, float]) -> list[Any]:
    """Return the state after a step."""
    (step,) = made.motions
    with ctx.workprec(200):
        values = {n: arb(x) for n, x in (moments | STATE | ATTITUDE).items()}
        return list(results(made, step, values).values())


@pytest.mark.parametrize("numbers", ["A", "AB", "BC", "ABC"])
def test_moments_that_are_numbers_move_a_body_like_parameters(numbers: str) -> None:
    made = body(*(str(MOMENTS[m]) if m in numbers else f'"{m}"' for m in "ABC"))
    every = body('"A"', '"B"', '"C"')
    for other in (MOMENTS["C"], 1.125, 2.5) if "C" not in numbers else (MOMENTS["C"],):
        at = MOMENTS | {"C": other}
        pairs = zip(moved(made, at), moved(every, at), strict=True)
        assert all(abs(a - b) < 1e-50 for a, b in pairs)
