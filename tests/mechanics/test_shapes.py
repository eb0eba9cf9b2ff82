"""Inertia of a machine's own shapes against their mass, spread out; springs against Hooke's law.

Particles know lengths and a uniform density, and no formula for a moment of inertia; the motion of
one mass on a spring is written out by hand.
"""

from collections.abc import Iterator
from itertools import product
from math import cos, hypot, pi, sin
from pathlib import Path

import pytest

from derive.scene import parse_scene
from derive.scene.formula import FLOATS, evaluate
from derive.solve.instrument import opened
from tests.scene.test_shape import ANGLES, MASS, ROUNDING, Particle, gauss, summed

A, B, C = 0.3, 0.5, 1.4
VALUES = {"m": MASS, "a": A, "b": B, "c": C}
NOWHERE = (0.0, 0.0, 0.0)


def tube() -> Iterator[Particle]:
    for (z, dz), (s, ds), (turn, part) in product(gauss(-C / 2, C / 2), gauss(A, B), ANGLES):
        yield dz * ds * s * part, (s * cos(turn), s * sin(turn), z)


def plate() -> Iterator[Particle]:
    for (x, dx), (z, dz) in product(gauss(-A / 2, A / 2), gauss(-B / 2, B / 2)):
        yield dx * dz, (x, 0.0, z)


def blades(number: int) -> Iterator[Particle]:
    for (s, ds), k in product(gauss(0, C), range(number)):
        turn = 2 * pi * k / number
        yield ds / number, (s * cos(turn), s * sin(turn), 0.0)


# A shape, what is said of it, its particles, how many masses they have.
SHAPES = {
    "tube": ('shape = "tube", inner = "a", outer = "b", length = "c", axis = "z"', tube(), 1),
    "plate": ('shape = "plate", lengths = ["a", "b"], axis = "y"', plate(), 1),
    "one blade": ('shape = "blades", number = 1, length = "c", axis = "z"', blades(1), 1),
    "two blades": ('shape = "blades", number = 2, length = "c", axis = "z"', blades(2), 2),
    "five blades": ('shape = "blades", number = 5, length = "c", axis = "z"', blades(5), 5),
}


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_has_the_inertia_of_its_own_mass(name: str) -> None:
    says, cloud, count = SHAPES[name]
    unit = {"m": "kg", "a": "m", "b": "m", "c": "m"}
    parameters = "".join(
        f'{key} = {{ unit = "{unit[key]}", value = {value} }}\n' for key, value in VALUES.items()
    )
    text = f"""wanted = ["M"]
[parameters]
{parameters}[speeds]
W = {{ unit = "rad/s", range = [1, 5], rate = 0 }}
[frames.shaft]
angular_velocity = ["0", "0", "W"]
[bodies]
body = {{ frame = "shaft", mass = "m", {says} }}
[loads]
bearing = {{ on = "body", couple = ["?M_x", "?M_y", "?M"] }}
"""
    scene = parse_scene(text, "shape")
    found = [float(evaluate(f, VALUES, FLOATS)) for f in scene.body("body").inertia]
    true = [count * entry for entry in summed(list(cloud), NOWHERE)]
    assert found == pytest.approx(true, abs=ROUNDING * max(true))


SPRING = """
wanted = ["accelerations", "energy"]
[parameters]
m = { unit = "kg", range = [1, 2] }
h = { unit = "m", range = [0.3, 0.4] }
k = { unit = "N/m", range = [50, 100] }
c = { unit = "N s/m", range = [1, 2] }
l = { unit = "m", range = [0.6, 0.8] }
[coordinates]
q = { unit = "m", range = [0.5, 1.5] }
[frames.slide]
origin = ["q", "h", "0"]
[bodies]
mass = { frame = "slide", shape = "point", mass = "m" }
[loads]
rail = { on = "mass", force = ["0", "?rail_y", "?rail_z"] }
spring = { on = "mass", spring = "k", damper = "c", length = "l", to = ["0", "0", "0"], to_frame = "inertial" }
"""  # noqa: E501
FEW_U = 1e-14
"""Of sums of a handful of terms in double."""


def test_a_spring_pulls_by_its_stretch_and_its_damper_by_how_fast(tmp_path: Path) -> None:
    (tmp_path / "spring.toml").write_text(SPRING)
    found = opened(str(tmp_path / "spring.toml"))
    m, h, k, c, rest, q, rate = 1.3, 0.35, 70.0, 1.7, 0.65, 1.1, -0.8
    values = {"m": m, "h": h, "k": k, "c": c, "l": rest, "q": q, "q_dot": rate}
    length = hypot(q, h)
    pull = k * (length - rest) + c * rate * q / length
    (acceleration,) = found.answer("accelerations", values).values()
    (energy,) = found.answer("energy", values).values()
    assert acceleration == pytest.approx(-pull * q / length / m, rel=FEW_U)
    true = m * rate**2 / 2 + k * (length - rest) ** 2 / 2
    assert energy == pytest.approx(true, rel=FEW_U)
