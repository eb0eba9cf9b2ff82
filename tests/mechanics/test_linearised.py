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
