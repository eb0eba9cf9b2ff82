"""The matrices of small motion stand as a reader expects: row by coordinate, masses positive."""

from collections.abc import Mapping
from functools import cache
from math import cos, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

from derive.solve.instrument import Instrument, opened
from tests.made import thinned

SCENES = Path(__file__).parent / "scenes"
MIDDLE: Mapping[str, float] = {}


@cache
def instrument(source: str) -> Instrument:
    return opened(source)


def matrix(source: str, name: str, given: Mapping[str, float] = MIDDLE) -> np.ndarray:
    """Return a matrix of small motion; what is not given is in the middle of its range."""
    found = instrument(source)
    function = next(f for f in found.library.functions if any(q.name == name for q in f.outputs))
    ranges = {c: (q.low or 0, q.high or 0) for q in found.quantities() for c in q.components}
    middle = {c: float(low + high) / 2 for c, (low, high) in ranges.items()}
    answer = found.answer(function.name, middle | dict(given))
    values = [x for c, x in answer.items() if c.startswith(f"{name}_")]
    size = round(len(values) ** 0.5)
    return np.array(values).reshape(size, size).T


OF_SMALL_MOTION = ("rotor_whirl", "monorail", "hartnell", "gravity_gradient")


@pytest.mark.parametrize("name", thinned(OF_SMALL_MOTION, 2))
def test_the_masses_of_small_motion_are_positive_and_on_the_diagonal(name: str) -> None:
    mass = matrix(str(SCENES / f"{name}.toml"), "mass_matrix")
    assert np.all(np.diag(mass) > 0)
    assert np.all(np.diag(mass) >= 0.999 * np.abs(mass).max(axis=1))


CART = """
wanted = ["linearised"]
[parameters]
M = { unit = "kg", range = [1, 2] }
m = { unit = "kg", range = [0.1, 0.5] }
l = { unit = "m", range = [0.2, 0.5] }
[coordinates]
x = { unit = "m", range = [-1, 1] }
a = { unit = "rad", range = [-3, 3] }
b = { unit = "rad", range = [-3, 3] }
[frames.cart]
origin = ["x", "0", "0"]
[frames.one]
parent = "cart"
turned = ["y a"]
[frames.two]
parent = "one"
origin = ["0", "0", "-l"]
turned = ["y b"]
[bodies.cart]
frame = "cart"
shape = "point"
mass = "M"
[bodies.one]
frame = "one"
shape = "rod"
axis = "z"
mass = "m"
length = "l"
centre = ["0", "0", "-l/2"]
[bodies.two]
frame = "two"
shape = "rod"
axis = "z"
mass = "m"
length = "l"
centre = ["0", "0", "-l/2"]
[loads.weight]
gravity = ["0", "0", "-9.81"]
[loads.rail]
on = "cart"
force = ["0", "?rail_y", "?rail_z"]
[loads.h1]
on = "one"
against = "cart"
force = "?N"
couple = ["?c1", "0", "?c3"]
[loads.h2]
on = "two"
against = "one"
force = "?P"
couple = ["?d1", "0", "?d3"]
"""


def test_rows_of_coupled_coordinates_are_in_the_order_of_the_coordinates(tmp_path: Path) -> None:
    """Masses and stiffnesses of a machine that keeps its energy are symmetric."""
    (tmp_path / "cart.toml").write_text(CART, encoding="utf-8")
    for name in ("mass_matrix", "stiffness_matrix"):
        found = matrix(str(tmp_path / "cart.toml"), name)
        assert np.allclose(found, found.T, atol=1e-12)
    assert np.all(np.linalg.eigvalsh(matrix(str(tmp_path / "cart.toml"), "mass_matrix")) > 0)


@pytest.mark.parametrize("name", thinned(["rotor_whirl", "monorail", "gravity_gradient"], 3))
def test_gyroscopic_terms_of_uncoupled_masses_do_no_work(name: str) -> None:
    """Two coordinates that only gyroscopic terms couple feel them with opposite signs."""
    damping = matrix(str(SCENES / f"{name}.toml"), "damping_matrix")
    assert np.any(damping != 0)
    assert np.allclose(damping, -damping.T, atol=1e-12 * np.abs(damping).max())


@pytest.mark.long
def test_a_governor_in_balance_swings_as_its_energies_say() -> None:
    """Links whose pull changes direction stiffen it: T = m v^2 + M u^2/2, u = 2 l sin(theta) w."""
    m, sleeve, link, g, theta = 0.75, 7.5, 0.25, 9.8, 0.6
    speed = sqrt((m + sleeve) * g / (m * link * cos(theta)))
    given = {"m": m, "M": sleeve, "l": link, "g": g, "theta0": theta, "W": speed}
    mass, stiffness = (
        float(matrix(str(SCENES / "governor.toml"), name, given)[0, 0])
        for name in ("mass_matrix", "stiffness_matrix")
    )
    inertia = 2 * m * link**2 + 4 * sleeve * (link * sin(theta)) ** 2
    weight = 2 * (m + sleeve) * g * link * cos(theta)
    curvature = weight - 2 * m * (link * speed) ** 2 * cos(2 * theta)
    assert stiffness / mass == pytest.approx(curvature / inertia, rel=1e-12)
