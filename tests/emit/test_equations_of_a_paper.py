"""Equations to take away read as in a paper: letters, values, tidy sums, nothing said twice."""

import re
from pathlib import Path
from random import Random

import pytest
import sympy
from sympy.simplify.fu import TR10i

from derive.emit.equations import equations
from derive.emit.equations.account import account
from derive.emit.equations.assumed import ALONE, alone
from derive.emit.page.tidied import _adds_angles, neatened
from derive.lecture.chapters import LECTURE
from derive.library.library import library
from derive.scene import parse_scene
from tests.emit.test_equations import differences, module, residuals
from tests.made import library_of

PENDULUM = """
wanted = ["energy", "accelerations", "rail"]
[parameters]
m = { unit = "kg", range = [1, 2] }
l = { unit = "m", range = [1, 2] }
g = { unit = "m/s^2", value = 9.81, meaning = "gravity" }
[coordinates]
swing = { unit = "rad", range = [-1, 1] }
yaw = { unit = "rad", range = [-1, 1], motion="prescribed", rate={range=[-1,1]}, acceleration = 0 }
[frames]
post.turned = ["z yaw"]
arm = { parent = "post", turned = ["y swing"] }
[bodies]
rod = { frame="arm", shape="rod", axis="z", mass="m", length="l", centre = ["0", "0", "l/2"] }
[loads]
weight = { gravity = ["0", "0", "-g"] }
hinge = { on = "rod", force = ["?rail", "?across", "?up"], couple = ["?a", "0", "?c"] }
"""


@pytest.mark.long
def test_a_letter_of_the_laws_that_the_scene_uses_otherwise_is_said_to_be_another() -> None:
    meanings = {row.shown[0]: row.meaning for row in account(library_of("cart_pendulum")).of_laws}
    other = "in the laws alone, for above m is: mass of the pendulum"
    assert meanings["m"] == f"mass of the body; {other}"
    assert meanings["T"] == "kinetic energy"


@pytest.mark.long
def test_letters_are_those_of_a_paper_and_values_stand_in_the_list(tmp_path: Path) -> None:
    lib = library(parse_scene(PENDULUM, "pendulum"))
    told, tex = equations(lib, "text"), equations(lib, "latex")
    assert not re.findall("981/|Source:", told)
    assert r"\dot{q}_{\mathrm{swing}}" in tex
    assert r"\dot{\psi}" in tex
    for part in ("g [m/s^2] gravity = 9.81", "-m g . r_G of each weight", "energy = T + V"):
        assert part in told
    made = module(equations(lib, "sympy"), tmp_path)
    assert made["CONSTANTS"] == {made["g"]: sympy.Rational(981, 100)}
    assert differences(lib, made) == residuals(lib, made) == []


@pytest.mark.long
def test_sums_are_tidied_and_what_stood_before_is_not_repeated() -> None:
    told = equations(library_of("cart_pendulum"), "text")
    assert told.count("F = m a_G") == 1
    for part in ("16, mass_centre_motion, as above.", "As in state_rate: ", "(M + m)⋅sin(θ)"):
        assert part in told


def test_a_sum_of_numbers_alone_is_tidied_too() -> None:
    turned, l = sympy.cos(sympy.Rational(3, 10)), sympy.Symbol("l")  # noqa: E741 (a length)
    for value in (turned + 1, l * (turned + 1) + l**2, (turned**2 + 1) * l + turned):
        assert sympy.simplify(neatened(value) - value) == 0


def test_assumptions_stand_alone() -> None:
    every = [step for step in LECTURE.steps if step.kind == "assume"]
    assert ALONE.keys() <= {step.name for step in LECTURE.steps}
    leaning = "First|Second|Third|There is no|This is|Other axes|Suppose, the|Let them|The first"
    assert [step.name for step in every if re.match(leaning, alone(step))] == []


@pytest.mark.long
def test_laws_are_quoted_in_sentences_that_need_none_before_them() -> None:
    scenes = map(library_of, ("acrobot", "satellite", "rolling_disc", "heavy_top"))
    parts = [part for known in scenes for one in account(known).sections for part in one.parts]
    quoted = {step.name: alone(step) for part in parts for step in part.steps}
    begun = re.compile(r"(So|And|The same|Apply|Solve|For)\b")
    assert len(quoted) > 5
    assert [says for says in quoted.values() if begun.match(says)] == []


@pytest.mark.long
def test_short_equations_stand_on_one_line_of_latex() -> None:
    tex = equations(library_of("rolling_disc"), "latex")
    rows = [row for part in re.findall(r"\\begin\{align\*\}\n(.*?)\n\\end", tex, re.DOTALL)
            for row in part.split(" \\\\\n")]  # fmt: skip
    assert [row for row in rows if row.startswith(r"&\quad =") and len(row) < 40] == []


@pytest.mark.long
def test_an_energy_is_in_joule() -> None:
    (result,) = (r for r in library_of("rolling_disc").scene.results if r.name == "energy_of_all")
    assert result.unit == "J"


ANGLES = sympy.symbols("a b c", real=True)
FACTORS = [*map(sympy.sin, ANGLES), *map(sympy.cos, ANGLES), sympy.sin(sum(ANGLES)), *ANGLES[:2]]


def test_no_sum_of_angles_is_missed_by_who_looks_only_where_two_terms_may_be_one() -> None:
    dice, found = Random(3), 0
    for _ in range(400):
        terms = [
            dice.choice((-1, 1, 2)) * sympy.Mul(*dice.choices(FACTORS, k=dice.randint(1, 3)))
            for _ in range(dice.randint(2, 5))
        ]
        whole = sympy.Add(*terms)
        looked = any(map(_adds_angles, whole.atoms(sympy.Add)))
        assert looked or TR10i(whole) == whole
        found += not looked
    assert 100 < found < 400
    a, b, _ = ANGLES
    assert _adds_angles(sympy.sin(a) * sympy.cos(b) - sympy.cos(a) * sympy.sin(b))
