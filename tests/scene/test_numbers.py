"""Possible and impossible bodies: what masses can have is accepted, what they cannot is doubted."""

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from derive.scene import CATALOGUE, SceneError, parse_scene
from derive.scene.numbers import FractionMatrix, definite, triangle

WHOLE = st.integers(-9, 9)
PARTICLES = st.lists(st.tuples(st.integers(1, 9), WHOLE, WHOLE, WHOLE), min_size=1, max_size=6)


def cloud_tensor(particles: list[tuple[int, int, int, int]]) -> FractionMatrix:
    """Return the inertia tensor of a cloud of particles (mass, x, y, z) about the origin."""
    rows = [[Fraction(0)] * 3 for _ in range(3)]
    for mass, *place in particles:
        square = sum(x * x for x in place)
        for i in range(3):
            for j in range(3):
                rows[i][j] += mass * ((square if i == j else 0) - place[i] * place[j])
    return tuple(tuple(row) for row in rows)


@given(PARTICLES)
def test_every_cloud_of_particles_has_a_possible_inertia(
    particles: list[tuple[int, int, int, int]],
) -> None:
    assert triangle(cloud_tensor(particles))


@pytest.mark.long
@given(PARTICLES)
def test_an_inertia_is_definite_unless_its_particles_lie_on_a_line(
    particles: list[tuple[int, int, int, int]],
) -> None:
    places = [place for _, *place in particles if any(place)]
    assume(places)
    a = places[0]
    off_the_line = any(
        any(a[i] * b[j] != a[j] * b[i] for i in range(3) for j in range(3)) for b in places
    )
    assert definite(cloud_tensor(particles)) == off_the_line


@given(PARTICLES, st.permutations([0, 1, 2]), st.sampled_from([1, -1]))
def test_both_judgements_do_not_depend_on_how_the_axes_are_called(
    particles: list[tuple[int, int, int, int]], order: list[int], sign: int
) -> None:
    """A mass taken away from the cloud makes some inertias impossible; the verdict is the same."""
    matrix = cloud_tensor(particles)
    less = tuple(
        tuple(matrix[i][j] - (Fraction(50) if i == j == 0 else 0) for j in range(3))
        for i in range(3)
    )
    renamed = tuple(
        tuple(less[a][b] * (sign if (a == 0) != (b == 0) else 1) for b in order) for a in order
    )
    assert (definite(less), triangle(less)) == (definite(renamed), triangle(renamed))


def warned(name: str, old: str, new: str) -> tuple[str, ...]:
    text = (CATALOGUE / f"{name}.toml").read_text(encoding="utf-8")
    assert old in text
    return parse_scene(text.replace(old, new, 1), name).warnings


@pytest.mark.parametrize(
    ("name", "old", "new", "says"),
    [
        (
            "free_body_principal",
            "[1.2, 1.6]",
            "[4, 5]",
            "body inertia breaks the triangle inequality at I_xx = 4.5, I_yy = 1.6, I_zz = 1.8",
        ),
        (
            "free_body_principal",
            "[1.2, 1.6]",
            "[0.2, 1.6]",
            "body inertia breaks the triangle inequality at I_xx = 0.2, I_yy = 1.4, I_zz = 2",
        ),
        (
            "free_body_principal",
            "[1.2, 1.6]",
            "[-0.1, 1.6]",
            "body inertia is not positive definite at I_xx = -0.1, I_yy = 1.4, I_zz = 1.6",
        ),
        (
            "heavy_top",
            "m = {",
            'n = { unit = "kg", value = 1 }\nm = {',
            "parameter 'n' is not used",
        ),
        (
            "heavy_top",
            'turned     = ["z phi"]',
            'turned = ["z phi"]\nmass = 1\ncentre = [0, 0, "l"]',
            "body inertia less that of its mass at body.centre is no masses' at A = 0.0015",
        ),
        (
            "heavy_top",
            'turned     = ["z phi"]',
            'turned = ["z phi"]\nmass = "m"\ncentre = [0, 0, "l"]',
            "at body.centre is no masses' at A = 0.001, C = 0.0004, m = 1, l = 0.06",
        ),
        ("heavy_top", "[0.2, 2.9]", "[0, 2.9]", "the range of 'theta' holds an angle"),
        ("gyrostat", "[-1.4, 1.4]", "[-1.4, 1.6]", "the range of 'theta' holds an angle"),
        (
            "rotor_on_turning_axes",
            '"W_x", "W_y", "W_z"]',
            '"W_x", "W_y", "0"]',
            "'W_z' is declared, but nothing turns with it",
        ),
        (
            "rotor_on_turning_axes",
            "[body]",
            "[known]\nmoment = { range = [-1, 1] }\n[body]",
            "known.moment is given, but no acceleration or state_rate is wanted",
        ),
        (
            "free_body",
            "[body]",
            "[motion]\ntime_step = { range = [0, 0.1] }\n[body]",
            "motion.time_step is given, but nothing that is wanted takes it",
        ),
        (
            "edge_runner_flat",
            "[speeds]",
            "[motion]\ntime_step = { range = [0, 0.1] }\n[speeds]",
            "motion.time_step is given, but nothing that is wanted takes it",
        ),
        (
            "gyrostat",
            "[1, 0, 0]",
            "[0.7071067811, 0.7071067811, 0]",
            "wheel '1': axis has unit length only nearly; write it as a formula",
        ),
    ],
)
def test_what_is_unlikely_is_a_warning(name: str, old: str, new: str, says: str) -> None:
    assert any(says in warning for warning in warned(name, old, new))


@pytest.mark.parametrize(
    "axis", ['["3/5", "4/5", 0]', "[0.6, 0.8, 0]", '["1/sqrt(2)", "1/sqrt(2)", 0]']
)
def test_an_axis_that_is_a_unit_vector_raises_no_doubt(axis: str) -> None:
    assert warned("gyrostat", "[1, 0, 0]", axis) == ()


def test_a_thin_rod_may_lack_the_moment_about_its_axis_and_nothing_else_may() -> None:
    start = 'wanted = ["moment"]\n[body]\n'
    assert parse_scene(f'{start}kind = "rod"\naxis = "y"\nmoment = 2', "rod").warnings == ()
    with pytest.raises(SceneError, match="must be positive definite, not moments 2, 0, 2"):
        parse_scene(f'{start}kind = "principal"\nmoments = [2, 0, 2]', "rod")
    with pytest.raises(SceneError, match="a thin rod has none about its own"):
        parse_scene(
            'wanted = ["acceleration"]\n[body]\nkind = "rod"\naxis = "y"\nmoment = 2', "rod"
        )


def test_what_only_the_rate_of_an_angle_uses_is_used() -> None:
    text = """
    wanted = ["moment"]
    parameters.k = { unit = "1", range = [1, 2] }
    speeds.W = { unit = "rad/s", range = [1, 2], rate = 0 }
    axes.angular_velocity = ["0", "0", "0"]
    body = { kind = "principal", moments = [1, 2, 2.5], turned = ["x g"] }
    [coordinates.g]
    unit = "rad"
    range = [0, 1]
    motion = "prescribed"
    rate = "k*W"
    """
    assert parse_scene(text, "example").warnings == ()
