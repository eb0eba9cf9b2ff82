"""A body in short form has the answers of the same body that somebody wrote with frames and loads.

The short form is read by one road into what code and checks both see, so a wrong reading of it
would go unnoticed by either; these files were written by hand, and their particles are equations.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from mpmath import mp, mpf

from derive.check.particles import digits
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import load, parse_scene
from derive.scene.short_form import long_form
from derive.verify.cloud import answers
from derive.verify.cloud.series import DIGITS
from derive.verify.equations import equations_of
from derive.verify.reference import reference
from derive.verify.sample import samples
from tests.made import library_of, short_of, thinned

LONG = Path(__file__).parents[1] / "data" / "long_form"
AGREE = mpf(10) ** -14  # samples are floats, and a quaternion of them has length 1 to a rounding
OMEGA = {f"omega_{a}": f"W_{a}" for a in "xyz"}
MOMENT = {f"moment_{a}": f"M_{a}" for a in "xyz"}
TURNS = {f"omega_dot_{a}": f"W_{a}_dot" for a in "xyz"}
WHEELS = {f"s_{n}_dot": f"s_{n}_dot" for n in (1, 2, 3)}
MOMENTA = {n: n for n in ("kinetic_energy", *(f"angular_momentum_{a}" for a in "xyz"))}
PLACE = {f"position_{a}": a for a in "xyz"} | {f"velocity_{a}": f"{a}_dot" for a in "xyz"}
HULL = {f"attitude_{p}": f"attitude_B_{p}" for p in "wxyz"}
FORCE = {f"force_{a}": f"F_{a}" for a in "xyz"}
TOP = {"omega_x": "w_x", "omega_y": "w_y", "omega_z": "n"}
CASES: Mapping[tuple[str, str], tuple[Mapping[str, str], Mapping[str, str]]] = {
    ("free_body", "acceleration"): (OMEGA | MOMENT, TURNS),
    ("free_body", "angular_momentum"): (OMEGA | MOMENT, MOMENTA),
    ("free_body_principal", "acceleration"): (OMEGA | MOMENT, TURNS),
    ("gyrostat", "state_rate"): (OMEGA | MOMENT, TURNS | WHEELS),
    ("heavy_top", "state_rate"): (
        TOP,
        {"omega_dot_x": "w_x_dot", "omega_dot_y": "w_y_dot", "omega_dot_z": "n_dot"},
    ),
    ("rigid_body", "state_rate"): (
        OMEGA | MOMENT | PLACE | HULL | FORCE,
        TURNS | {f"velocity_rate_{a}": f"{a}_ddot" for a in "xyz"},
    ),
    ("rotor_on_turning_axes", "moment"): ({}, MOMENT),
    ("rotor_on_turning_axes", "kinetic_energy"): ({}, MOMENTA),
    ("unsymmetrical_rotor_in_carrier_axes", "moment"): ({}, MOMENT),
    ("unsymmetrical_rotor_in_carrier_axes", "kinetic_energy"): ({}, MOMENTA),
}


def gap(short: Library, scene: str, function: str) -> Any:
    """Return how far the answers are apart, relative to the largest."""
    given, found = CASES[scene, function]
    equations = equations_of(short.mechanism, short.problems[function])
    written, gaps = load(LONG / f"{scene}.toml"), []
    for sample in samples(short.mechanism, F64, 2, 0).each[:2]:
        true = reference(equations, sample.values, ())
        with mp.workdps(DIGITS):
            values: dict[str, Any] = {n: mpf(x) for n, x in sample.values.items()}
            values |= {new: values[old] for old, new in given.items() if old in values}
            cloud = answers(written, {"m": mpf(1), **values})
            every = {**cloud.momenta, **cloud.unknowns}
            size = max(abs(digits(true[n].value)) for n in true)
            both = [(true[own].value, every[n]) for own, n in found.items() if own in true]
            gaps += [abs(digits(x) - y) / size for x, y in both]
    return max(gaps)


@pytest.mark.long
@pytest.mark.parametrize("case", thinned(CASES, 4), ids="-".join)
def test_a_body_in_short_form_is_the_body_in_long_form(case: tuple[str, str]) -> None:
    scene, function = case
    assert gap(library_of(scene), scene, function) < AGREE


@pytest.mark.long
def test_a_body_that_is_read_otherwise_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = long_form.carrier
    monkeypatch.setattr(long_form, "carrier", lambda s: (*right(s)[1::-1], *right(s)[2:]))
    text = short_of("free_body").head["text"]
    made = library(parse_scene(text, "free_body"))
    assert gap(made, "free_body", "acceleration") > AGREE
