"""Torque-free steps of bodies of revolution and of spheres, in closed form: exact at any step.

In one step the body turns about its angular momentum, which stands still in space, and then about
its own axis; both angles are the same in every step of a motion, and so are their sines.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from derive.motion.attitude.lengths import squares
from derive.motion.exact.inertia import Inertia
from derive.program.operations import cos, less, select, sin, sqrt
from derive.program.tape import Number, named, number

AXES = "xyz"
DOUBLED, TERMS = 24, 6
"""Up to 2^20 rad: of 2^-4 rad, six terms leave out 2^-64."""


About = Callable[[Sequence[Number], Number], tuple[Number, Number]]
"""From mu and h to sin(|mu| h/2)/|mu| and 1 - cos(|mu| h/2)."""


def plan_revolution(
    body: Inertia, omega: Sequence[Number], time_step: Number, about: About
) -> list[tuple[str, Number, str]]:
    """Return what every step of a body of revolution has in common: name, value, meaning."""
    i, j, k = body.places
    across, own = body.tensor[i], body.tensor[k]
    along = named("ratio", own / across, "moment about the axis over the other") * omega[k]
    sine, versed = about([omega[i], omega[j], along], time_step)
    slip = named("slip", (across - own) / across, "one less that ratio")
    angle = time_step * (slip * omega[k])
    half, quarter = sin(angle * Fraction(1, 2)), sin(angle * Fraction(1, 4))
    less_spin = 2 * quarter * quarter
    scalar = (1 - versed) * (1 - less_spin) - sine * along * half
    return [
        ("keep", sine * (1 - less_spin), "attitude change along omega across the axis, s"),
        ("turn", sine * half, "attitude change square to that, s"),
        ("spin", (1 - versed) * half + sine * along * (1 - less_spin), "attitude change, axis"),
        ("forward", scalar, "the scalar part of the attitude change, of which the sign is read"),
        ("sine", 2 * half * cos(angle * Fraction(1, 2)), "sine of the turn of omega in the body"),
        ("versed", 2 * half * half, "one less its cosine"),
    ]


def plan_sphere(
    omega: Sequence[Number], time_step: Number, about: About
) -> list[tuple[str, Number, str]]:
    """Return what every step of a sphere has in common: the attitude change itself."""
    sine, versed = about(omega, time_step)
    names = zip(AXES, omega, strict=True)
    return [("less", versed, "1 - scalar part of the attitude change")] + [
        (f"turn_{axis}", sine * w, "vector part of the attitude change") for axis, w in names
    ]


def about_momentum(mu: Sequence[Number], time_step: Number) -> tuple[Number, Number]:
    """Return sin(|mu| h/2)/|mu| and 1 - cos(|mu| h/2)."""
    size = sqrt(mu[0] * mu[0] + mu[1] * mu[1] + mu[2] * mu[2])
    turns = less(0, size)
    angle = time_step * size
    sine = sin(angle * Fraction(1, 2)) / select(turns, size, 1)
    quarter = sin(angle * Fraction(1, 4))
    return select(turns, sine, time_step * Fraction(1, 2)), 2 * quarter * quarter


def about_any(mu: Sequence[Number], time_step: Number) -> tuple[Number, Number]:
    """Return the same with slopes that keep their digits near mu = 0: both are functions of mu^2.

    A small part of the angle is doubled, up to ``DOUBLED`` times.
    """
    z = squares([time_step * m for m in mu]) * Fraction(1, 4 ** (DOUBLED + 1))
    sine, versed = number(1), number(0)
    for n in reversed(range(1, TERMS)):
        versed = z * Fraction(1, 2 * n * (2 * n - 1)) * (1 - versed)
    for n in reversed(range(1, TERMS)):
        sine = 1 - z * Fraction(1, 2 * n * (2 * n + 1)) * sine
    for _ in range(DOUBLED):
        cosine, square = 1 - versed, z * sine * sine
        size = cosine * cosine + square
        sine, versed, z = sine * cosine / size, 2 * square / size, 4 * z
    return time_step * Fraction(1, 2) * sine, versed


def change_of_revolution(
    body: Inertia, plan: Mapping[str, Number], omega: Sequence[Number]
) -> tuple[list[Number], list[Number]]:
    """Return the vector part of a step's attitude change, and the change of omega."""
    i, j, k = body.places
    turn, change = list(omega), [number(0)] * 3
    turn[i] = plan["keep"] * omega[i] + plan["turn"] * omega[j]
    turn[j] = plan["keep"] * omega[j] - plan["turn"] * omega[i]
    turn[k] = plan["spin"]
    change[i] = plan["sine"] * omega[j] - plan["versed"] * omega[i]
    change[j] = -(plan["sine"] * omega[i] + plan["versed"] * omega[j])
    return turn, change


def less_than_one(forward: Number, v: Sequence[Number]) -> Number:
    """Return one less the scalar part of a turn, from its vector and the scalar's sign.

    A scalar part from the plan would leave the same error of the length in every step.
    """
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    size = 1 + sqrt(1 - square)
    return select(less(0, forward), square / size, size)
