"""Inertia of named shapes against their own mass, spread out and summed by quadrature.

The sums are over Gauss points in the volume, surface or line itself, in the body's coordinates;
they know lengths and a uniform density, no formula for a moment of inertia.
"""

from collections.abc import Iterator
from fractions import Fraction
from itertools import product
from math import cos, pi, sin, sqrt

import pytest

from derive.scene.formula import FLOATS, ZERO, evaluate, symbol
from derive.scene.shape import ROUND, Portion, moment, round_part
from derive.scene.short_form.declared import Body
from tests.made import short

MASS, RADIUS, LENGTH = 1.7, 0.6, 1.3
EDGES = (0.4, 0.9, 1.4)
VALUES = {"m": MASS, "r": RADIUS, "h": LENGTH, "a": EDGES[0], "b": EDGES[1], "c": EDGES[2]}
ROUNDING = 4e-15
"""A few dozen roundings of a sum of a few hundred terms, relative to the largest moment."""
NODES = ((-sqrt(3 / 5), 5 / 9), (0.0, 8 / 9), (sqrt(3 / 5), 5 / 9))
"""Three Gauss points: exact to degree five, and squared lengths times a cone's area have four."""
ANGLES = [(2 * pi * k / 8, 1 / 8) for k in range(8)]
"""Eight equal angles: exact for trigonometric polynomials below degree eight."""

Particle = tuple[float, tuple[float, float, float]]


def gauss(low: float, high: float) -> list[tuple[float, float]]:
    """Return points and weights of the interval; the weights add up to its length."""
    half = (high - low) / 2
    return [(low + half * (1 + node), half * weight) for node, weight in NODES]


def cylinder() -> Iterator[Particle]:
    for (z, dz), (s, ds), (turn, part) in product(
        gauss(-LENGTH / 2, LENGTH / 2), gauss(0, RADIUS), ANGLES
    ):
        yield dz * ds * s * part, (s * cos(turn), s * sin(turn), z)


def disc() -> Iterator[Particle]:
    for (s, ds), (turn, part) in product(gauss(0, RADIUS), ANGLES):
        yield ds * s * part, (s * cos(turn), s * sin(turn), 0.0)


def hoop() -> Iterator[Particle]:
    for turn, part in ANGLES:
        yield part, (RADIUS * cos(turn), RADIUS * sin(turn), 0.0)


def cone() -> Iterator[Particle]:
    """Yield particles from the apex at the origin along z; s is a fraction of the radius there."""
    for (z, dz), (s, ds), (turn, part) in product(gauss(0, LENGTH), gauss(0, 1), ANGLES):
        here = RADIUS * z / LENGTH
        yield dz * ds * s * here**2 * part, (here * s * cos(turn), here * s * sin(turn), z)


def rod() -> Iterator[Particle]:
    for z, dz in gauss(-LENGTH / 2, LENGTH / 2):
        yield dz, (0.0, 0.0, z)


def box() -> Iterator[Particle]:
    for ends in product(*(gauss(-edge / 2, edge / 2) for edge in EDGES)):
        (x, dx), (y, dy), (z, dz) = ends
        yield dx * dy * dz, (x, y, z)


def hollow_sphere() -> Iterator[Particle]:
    """Yield particles of the surface; equal heights have equal areas (Archimedes)."""
    for (z, dz), (turn, part) in product(gauss(-RADIUS, RADIUS), ANGLES):
        s = sqrt(RADIUS**2 - z**2)
        yield dz * part, (s * cos(turn), s * sin(turn), z)


def sphere() -> Iterator[Particle]:
    for (scale, ds), (weight, (x, y, z)) in product(gauss(0, 1), hollow_sphere()):
        yield ds * scale**2 * weight, (scale * x, scale * y, scale * z)


CLOUDS = {
    "cylinder": ('radius = "r"\nlength = "h"\naxis = "z"', cylinder),
    "disc": ('radius = "r"\naxis = "z"', disc),
    "hoop": ('radius = "r"\naxis = "z"', hoop),
    "cone": ('radius = "r"\nheight = "h"\naxis = "z"', cone),
    "rod": ('length = "h"\naxis = "z"', rod),
    "box": ('lengths = ["a", "b", "c"]', box),
    "sphere": ('radius = "r"', sphere),
    "hollow_sphere": ('radius = "r"', hollow_sphere),
}


def scene_body(shape: str, words: str, point: str) -> Body:
    """Return the body of a scene with a shape, about a point."""
    parameters = "".join(
        f'{name} = {{ unit = "{"kg" if name == "m" else "m"}", value = {value} }}\n'
        for name, value in VALUES.items()
    )
    text = f"""wanted = ["moment"]
[parameters]
{parameters}[body]
shape = "{shape}"
mass = "m"
{words}
[point]
kind = "{point}"
"""
    return short(text).body


def summed(cloud: list[Particle], centre: tuple[float, float, float]) -> list[float]:
    """Return xx, yy, zz, xy, xz, yz of a cloud of mass MASS whose centre is put at ``centre``."""
    whole = sum(weight for weight, _ in cloud)
    middle = [sum(w * place[i] for w, place in cloud) / whole for i in range(3)]
    result = [0.0] * 6
    for weight, place in cloud:
        dm = MASS * weight / whole
        x, y, z = (place[i] - middle[i] + centre[i] for i in range(3))
        terms = (y * y + z * z, x * x + z * z, x * x + y * y, x * y, x * z, y * z)
        result = [total + dm * term for total, term in zip(result, terms, strict=True)]
    return result


def close(body: Body, expected: list[float]) -> bool:
    found = [evaluate(part, VALUES, FLOATS) for part in body.inertia]
    bound = ROUNDING * max(expected)
    return all(abs(one - other) <= bound for one, other in zip(found, expected, strict=True))


def turned(values: list[float], axis: str) -> list[float]:
    """Return moments of a body with axis z as they are with another axis, cyclically renamed."""
    shift = ("z", "x", "y").index(axis)
    moments = values[:3][-shift:] + values[:3][:-shift] if shift else values[:3]
    return [*moments, *values[3:]]


@pytest.mark.parametrize("shape", CLOUDS)
def test_a_shape_about_its_mass_centre_is_the_sum_over_its_mass(shape: str) -> None:
    words, cloud = CLOUDS[shape]
    body = scene_body(shape, words, "centre_of_mass")
    assert close(body, summed(list(cloud()), (0, 0, 0)))


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("shape", ["cylinder", "disc", "hoop", "cone", "rod"])
def test_a_shape_may_lie_along_any_axis(shape: str, axis: str) -> None:
    words, cloud = CLOUDS[shape]
    body = scene_body(shape, words.replace('"z"', f'"{axis}"'), "centre_of_mass")
    assert close(body, turned(summed(list(cloud()), (0, 0, 0)), axis))


@pytest.mark.parametrize("centre", [(0.0, 0.0, 0.5), (0.25, 0.0, 0.0), (0.25, -0.5, 0.75)])
@pytest.mark.parametrize("shape", CLOUDS)
def test_a_shape_about_a_fixed_point_is_moved_there(
    shape: str, centre: tuple[float, float, float]
) -> None:
    words, cloud = CLOUDS[shape]
    body = scene_body(shape, f"{words}\ncentre = {list(centre)}", "fixed")
    assert close(body, summed(list(cloud()), centre))


def test_a_cone_about_its_apex_is_the_sum_over_its_mass_from_there() -> None:
    words, cloud = CLOUDS["cone"]
    body = scene_body("cone", f'{words}\nabout = "apex"', "fixed")
    middle = sum(w * place[2] for w, place in cloud()) / sum(w for w, _ in cloud())
    assert close(body, summed(list(cloud()), (0, 0, middle)))
    assert body.kind == "axisymmetric"
    assert body.centre is not None
    assert evaluate(body.centre[2], VALUES, FLOATS) == pytest.approx(middle, rel=ROUNDING)


def of_rims(part: Portion) -> Iterator[Particle]:
    """Yield particles of what is drawn of a round body, along z: solid, plate, ring or line."""
    rims = [tuple(evaluate(f, VALUES, FLOATS) for f in rim) for rim in part.rims]
    if len(rims) == 1:
        ((z, inner, outer),) = rims
        for (s, ds), (turn, share) in product(gauss(inner, outer), ANGLES):
            weight = ds * s if outer > inner else 1.0
            yield weight * share, (s * cos(turn), s * sin(turn), z)
        return
    (low, *start), (high, *end) = rims
    for (z, dz), (t, dt), (turn, share) in product(gauss(low, high), gauss(0, 1), ANGLES):
        at = (z - low) / (high - low)
        inner, outer = (a + (b - a) * at for a, b in zip(start, end, strict=True))
        s = inner + (outer - inner) * t
        weight = dz * dt * (outer - inner) * s if max(*start, *end) else dz * dt
        yield weight * share, (s * cos(turn), s * sin(turn), z)


@pytest.mark.parametrize("shape", [name for name, row in ROUND.items() if row.rims])
def test_what_is_drawn_of_a_shape_has_its_inertia_and_its_mass_centre(shape: str) -> None:
    own = {"radius": "r", "length": "h", "height": "h", "inner": "a", "outer": "b"}
    lengths = {name: symbol(value) for name, value in own.items()}
    row, cloud = ROUND[shape], list(of_rims(round_part(shape, "z", lengths)))
    whole = sum(w for w, _ in cloud)
    assert abs(sum(w * z for w, (_, _, z) in cloud)) <= ROUNDING * whole * LENGTH
    axial, across = (
        evaluate(moment(terms, symbol("m"), lengths), VALUES, FLOATS)
        for terms in (row.axial, row.transverse)
    )
    found = summed(cloud, (0, 0, 0))
    expected = [across, across, axial, 0, 0, 0]
    assert found == pytest.approx(expected, rel=ROUNDING, abs=ROUNDING * across)


def test_a_sphere_is_drawn_by_its_radius_alone() -> None:
    for shape in ("sphere", "hollow_sphere"):
        assert round_part(shape, None, {"radius": symbol("r")}).edges == (symbol("r"),) * 3


def test_a_wrong_factor_is_seen_by_the_quadrature() -> None:
    """The checker fails where it must: a disc is not a hoop, by any bound in use."""
    words, _ = CLOUDS["disc"]
    body = scene_body("disc", words, "centre_of_mass")
    assert not close(body, summed(list(hoop()), (0, 0, 0)))
    almost = [value * (1 + 1e-12) for value in summed(list(disc()), (0, 0, 0))]
    assert not close(body, almost)


@pytest.mark.parametrize(
    ("shape", "centre", "kind", "axis"),
    [
        ("cylinder", [0, 0, 1], "axisymmetric", "z"),
        ("cylinder", [0, 1, 0], "principal", None),
        ("cylinder", [0, 1, 1], "general", None),
        ("rod", [0, 0, 1], "rod", "z"),
        ("rod", [1, 0, 0], "principal", None),
        ("sphere", [0, 0, 0], "spherical", None),
        ("sphere", [0, 2, 0], "axisymmetric", "y"),
        ("box", [1, 1, 1], "general", None),
    ],
)
def test_a_moved_shape_keeps_the_symmetry_that_it_still_has(
    shape: str, centre: list[int], kind: str, axis: str | None
) -> None:
    body = scene_body(shape, f"{CLOUDS[shape][0]}\ncentre = {centre}", "fixed")
    assert (body.kind, body.axis) == (kind, axis)


def test_equal_moments_are_one_formula_and_zero_products_are_zero() -> None:
    words, _ = CLOUDS["cylinder"]
    body = scene_body("cylinder", f'{words}\ncentre = [0, 0, "h"]', "fixed")
    assert body.inertia[0] == body.inertia[1]
    assert body.inertia[3:] == (ZERO, ZERO, ZERO)


def test_second_moments_are_kept_as_sums_so_that_their_differences_stay_exact() -> None:
    text = """wanted = ["moment"]
[parameters]
a = { unit = "kg m^2", range = [1, 2] }
b = { unit = "kg m^2", range = [1, 2] }
c = { unit = "kg m^2", range = [1, 2] }
[body]
kind = "principal"
second_moments = ["a", "b", "c"]
"""
    body = short(text).body
    assert [str(part) for part in body.inertia[:3]] == ["b + c", "a + c", "a + b"]


def test_shape_factors_are_exact() -> None:
    body = scene_body("cone", CLOUDS["cone"][0], "centre_of_mass")
    exact = {**FLOATS, "number": Fraction}
    ones = dict.fromkeys(VALUES, Fraction(1))
    assert evaluate(body.inertia[0], ones, exact) == Fraction(3, 20) + Fraction(3, 80)
