"""A cloud of particles in the inertial frame: where each one is at any time, and nothing else.

The moment on the cloud is found from the position histories alone: positions expanded in time,
forces from the accelerations, moments from the forces. No inertia tensor, no angular momentum, no
angular velocity and no transport theorem are known here.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from random import Random

from tests.lecture.jet import (
    ORDER,
    Column,
    Jet,
    Rows,
    added,
    applied,
    column,
    constant,
    crossed,
    product,
    rows,
    total,
    turning,
)

Place = tuple[Fraction, Fraction, Fraction]


@dataclass(frozen=True)
class Particle:
    """A mass and its position history in the inertial frame."""

    mass: Fraction
    position: Column


@dataclass(frozen=True)
class Wheel:
    """Particles, centre and axis, both fixed in the carrier, and the tangent of half its angle."""

    places: tuple[tuple[Fraction, Place], ...]
    centre: Place
    frame: Rows
    half_tangent: Jet


def rational(random: Random, size: int = 9) -> Fraction:
    """Return a small rational number."""
    return Fraction(random.randint(-size, size), random.randint(1, size))


def history(random: Random) -> Jet:
    """Return the history of a coordinate."""
    return Jet(tuple(rational(random) for _ in range(ORDER)))


def path(random: Random) -> Column:
    """Return the history of a point, or of a rotation's Gibbs vector."""
    return column(lambda _: history(random))


def places(random: Random, count: int) -> tuple[tuple[Fraction, Place], ...]:
    """Return masses and places of particles fixed in a body."""
    return tuple(
        (
            Fraction(random.randint(1, 9), random.randint(1, 5)),
            (rational(random), rational(random), rational(random)),
        )
        for _ in range(count)
    )


def fixed(place: Place) -> Column:
    """Return a place that does not change."""
    return column(lambda i: constant(place[i]))


def rigid(
    masses: tuple[tuple[Fraction, Place], ...], body: Rows, point: Column
) -> tuple[Particle, ...]:
    """Return the particles of a rigid body that turns as ``body`` does about a moving point."""
    return tuple(Particle(m, added(point, applied(body, fixed(place)))) for m, place in masses)


def balanced_wheel(random: Random) -> Wheel:
    """Return a wheel of two rings of four particles each, on any axis of the carrier."""
    radius, height = abs(rational(random)) + 1, rational(random)
    mass = Fraction(random.randint(1, 9), 7)
    zero = Fraction(0)
    ring = ((radius, zero), (zero, radius), (-radius, zero), (zero, -radius))
    particles = tuple((mass, (x, y, side * height)) for x, y in ring for side in (1, -1))
    centre = (rational(random), rational(random), rational(random))
    axis = turning(fixed((rational(random), rational(random), rational(random))))
    return Wheel(particles, centre, axis, history(random))


def spinning(wheel: Wheel, body: Rows, point: Column) -> tuple[Particle, ...]:
    """Return the wheel's particles: they turn about its axis, which the carrier carries."""
    turn = turning((constant(0), constant(0), wheel.half_tangent))
    seen = product(wheel.frame, turn)
    centre = fixed(wheel.centre)
    return tuple(
        Particle(m, added(point, applied(body, added(centre, applied(seen, fixed(place))))))
        for m, place in wheel.places
    )


def external_forces(particles: tuple[Particle, ...], random: Random) -> tuple[Place, ...]:
    """Return the external force on each particle: what its acceleration needs beside central
    internal forces of any strength."""
    strengths = {
        frozenset((i, k)): rational(random) for i in range(len(particles)) for k in range(i)
    }
    return tuple(_external(particles, i, strengths) for i in range(len(particles)))


def _external(
    particles: tuple[Particle, ...], i: int, strengths: dict[frozenset[int], Fraction]
) -> Place:
    here = particles[i]
    force = [here.mass * here.position[n].derivative(2) for n in range(3)]
    for k, other in enumerate(particles):
        if k != i:
            for n in range(3):
                apart = here.position[n].derivative(0) - other.position[n].derivative(0)
                force[n] -= strengths[frozenset((i, k))] * apart
    return force[0], force[1], force[2]


def moment(particles: tuple[Particle, ...], point: Column, forces: tuple[Place, ...]) -> Place:
    """Return the sum of arm x force about the point where it is now, along N's axes."""
    x, y, z = (
        total(
            [
                crossed(
                    column(lambda n, p=p: p.position[n] - point[n]),  # type: ignore[misc]
                    fixed(force),
                )[axis]
                for p, force in zip(particles, forces, strict=True)
            ]
        ).derivative(0)
        for axis in range(3)
    )
    return x, y, z


def kinetic_energy(particles: tuple[Particle, ...]) -> Fraction:
    """Return half the sum of m v^2 in the inertial frame."""
    squares = (p.mass * p.position[n].derivative(1) ** 2 for p in particles for n in range(3))
    return sum(squares, Fraction(0)) / 2


def identity() -> Rows:
    """Return axes that do not turn."""
    return rows(lambda i, k: constant(int(i == k)))
