"""Six equations a body: forces and moments about its mass centre, summed over its particles."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray

from derive.scene.constraints import body_turning_with
from derive.scene.formula import ZERO
from derive.scene.machine import INERTIAL, Force, Gradient, Load, Spring, Weight
from derive.verify.cloud.history import History
from derive.verify.cloud.series import crossed, each

Acting = tuple[
    str, NDArray[Any], NDArray[Any], NDArray[Any]
]  # a body, the place, the force and the couple along N


def left_over(history: History) -> list[Any]:
    """Return mass times acceleration less loads, and its moment, of every body in turn."""
    rows: list[Any] = []
    loads = [one for load in history.machine.loads for one in acting(history, load)]
    for body in history.machine.bodies:
        centre = at_instant(history.centre(body.name))
        force = np.array([mpf(0)] * 3, dtype=object)
        moment = np.array([mpf(0)] * 3, dtype=object)
        for m, place in history.particles(body.name):
            f = m * each(lambda x: x.acceleration, place)
            force, moment = force + f, moment + crossed(at_instant(place) - centre, f)
        for on, place, f, couple in loads:
            if on == body.name:
                force, moment = force - f, moment - couple - crossed(place - centre, f)
        rows += [*force, *moment]
    return rows


def at_instant(array: NDArray[Any]) -> NDArray[Any]:
    """Return what is there at time zero."""
    return each(lambda x: x.value, array)


def acting(history: History, load: Load) -> Iterator[Acting]:
    """Yield what a load does to each body that it acts on."""
    match load:
        case Force():
            yield from _force(history, load)
        case Weight():
            g = along(history, load.along, load.gravity)
            for body in load.on:
                yield body, at_instant(history.centre(body)), history.mass(body) * g, 0 * g
        case Gradient():
            for body in load.on:
                yield _gradient(history, load, body)
        case Spring():
            yield from _spring(history, load)


def along(history: History, frame: str, formulas: tuple[Any, ...]) -> NDArray[Any]:
    """Return a vector given along the axes of a frame, along N."""
    if all(f == ZERO for f in formulas):
        return np.array([mpf(0)] * 3, dtype=object)
    return at_instant(history.rotations[frame] @ history.column(formulas))


def _force(history: History, load: Force) -> Iterator[Acting]:
    place = at_instant(history.place(load.frame, load.at))
    force, couple = (along(history, load.along, f) for f in (load.force, load.couple))
    yield load.on, place, force, couple
    other = place if load.other is None else at_instant(history.place(*load.other))
    if load.against:
        yield load.against, other, -force, -couple
    turning = _turning_with(history, load)
    if turning:  # what its axes turn with is held by the same points
        yield turning, place, -force, 0 * couple
        yield turning, other, force, 0 * couple


def _turning_with(history: History, load: Force) -> str:
    """Return the body along whose axes points of bodies are held at one place, "" if none is."""
    held = (c.name for c in history.machine.constraints
            if c.meeting and not c.of_rates and c.load == c.name == load.name)  # fmt: skip
    body = body_turning_with(history.machine, load.along) if any(held) else ""
    return "" if body == INERTIAL else body


def _gradient(history: History, load: Gradient, body: str) -> Acting:
    """Return the moment of the field on the particles themselves."""
    c, third = along(history, load.along, load.towards), history.value(load.strength).value / 3
    centre = at_instant(history.centre(body))
    couple = 0 * c
    for m, place in history.particles(body):
        arm = at_instant(place) - centre
        couple = couple + crossed(arm, m * third * (3 * (c @ arm) * c - arm))
    return body, centre, 0 * c, couple


def _spring(history: History, load: Spring) -> Iterator[Acting]:
    start, end = (history.place(f, at) for f, at in
                  ((load.frame, load.at), (load.to_frame, load.to)))  # fmt: skip
    d, v = at_instant(end - start), each(lambda x: x.velocity, end - start)
    k, c, rest = (history.value(f).value for f in (load.stiffness, load.damping, load.length))
    size = mp.sqrt(d @ d)
    force = k * d if rest == 0 else k * (1 - rest / size) * d
    force = force + c * (d @ v) / size**2 * d if c != 0 else force
    yield load.on, at_instant(start), force, 0 * d
    if load.against:
        yield load.against, at_instant(end), -force, 0 * d


def potential_energy(history: History) -> Any:
    """Return the energy of particles in their weights, and that of springs."""
    total = mpf(0)
    for load in history.machine.loads:
        if isinstance(load, Weight):
            g = along(history, load.along, load.gravity)
            for body in load.on:
                particles = history.particles(body)
                total -= mp.fsum(m * (g @ at_instant(place)) for m, place in particles)
        elif isinstance(load, Spring):
            ends = ((load.frame, load.at), (load.to_frame, load.to))
            start, end = (at_instant(history.place(f, at)) for f, at in ends)
            k, rest = (history.value(f).value for f in (load.stiffness, load.length))
            total += k * (mp.sqrt((end - start) @ (end - start)) - rest) ** 2 / 2
    return total
