"""A craft with three thrusters, in C for CasADi, and what is drawn for it."""

import re
from functools import cache

from derive.emit.files import scene_files
from derive.library.external import derivatives_of_step
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import parse_scene
from derive.verify.draw import with_motion
from derive.verify.sample import Sample, samples
from tests.made import CATALOGUE

UNIT = '["step_rk4_unit", "step_rk4_unit_jacobian"]'
FULL = """
I_xy = { unit = "kg m^2", range = [-0.2, 0.2], meaning = "product of inertia" }
I_xz = { unit = "kg m^2", range = [-0.2, 0.2], meaning = "product of inertia" }
I_yz = { unit = "kg m^2", range = [-0.2, 0.2], meaning = "product of inertia" }

[axes]"""
LINES = 3000
OPERATIONS = 4000


def text_of(kind: str, wanted: str = UNIT) -> str:
    """Return the satellite of the catalogue, or one with a full tensor, with other wishes."""
    text = (CATALOGUE / "satellite.toml").read_text(encoding="utf-8")
    text = re.sub(r"wanted = \[.*?\]", f"wanted = {wanted}", text, count=1, flags=re.DOTALL)
    if kind == "general":
        text = text.replace("\n[axes]", FULL, 1).replace('"principal"\n', '"general"\n')
        text = text.replace("[known]", 'products = ["I_xy", "I_xz", "I_yz"]\n\n[known]', 1)
    return text


@cache
def made(kind: str) -> Library:
    return library(parse_scene(text_of(kind), "craft"))


@cache
def texts(kind: str) -> dict[str, str]:
    given = made(kind)
    every = scene_files(given, (), of=derivatives_of_step(given))
    return {path.partition("/")[2]: text for path, text in every.items()}


@cache
def drawn(kind: str) -> tuple[Sample, ...]:
    given = made(kind)
    return with_motion(given, samples(given.mechanism, F64, 3, 0).each, F64)
