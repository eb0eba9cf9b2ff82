"""What each body of a machine needs by its motion: force at the mass centre, moment about it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sympy import Expr, Matrix, zeros

from derive.lecture.stated import by_law
from derive.lecture.turning import reduced
from derive.mechanics.frames import ZERO, ByFrame, Frames, Located
from derive.mechanics.probe import vanishes
from derive.mechanics.words import inertia_name, mass_name
from derive.scene.machine import INERTIAL


@dataclass(frozen=True)
class Effort:
    """Mass times acceleration of G, in parts, and rate of angular momentum about G along a frame.

    centre : G, in the first frame that carries it
    """

    body: str
    frame: str
    centre: Located
    force: ByFrame
    moment: Matrix


def mass(frames: Frames, body: str) -> Expr:
    """Return the mass of a body, or a symbol if the user left it out."""
    return frames.words.data(frames.machine.body(body).mass, mass_name(body))


def inertia_tensor(frames: Frames, body: str) -> Matrix:
    """Return the inertia tensor of a body about its mass centre, along its own axes."""
    member = frames.machine.body(body)
    xx, yy, zz, xy, xz, yz = (
        frames.words.data(f, inertia_name(frames.machine, body, place))
        for place, f in enumerate(member.inertia)
    )
    return Matrix([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]])


def centre(frames: Frames, body: str) -> Located:
    """Return the mass centre of a body in the frame of its own axes."""
    member = frames.machine.body(body)
    if member.turned:
        return frames.own(body), ZERO
    return member.frame, frames.words.column(member.centre)


def effort(frames: Frames, body: str) -> Effort:
    """Return what the motion of ``body`` needs, by the general form and the motion of G."""
    sheet = frames.sheet
    name, at = attached(frames, centre(frames, body))
    force: dict[str, Matrix] = {}
    for part, a_G in frames.accelerated(name, at, frames.acceleration[name]).items():
        if not frames.linked(part, frames.own(body)):
            frames.carried(a_G, part, frames.own(body))
        known = {"m": mass(frames, body), "a_G": sheet.column(f"{body}.a_G", a_G)}
        force[part] = sheet.column(f"{body}.F", by_law("mass_centre_motion", known))
    return Effort(body, frames.own(body), (name, at), force, moment(frames, body))


def attached(frames: Frames, place: Located) -> Located:
    """Return a point in the first frame of the chain that carries it at a place of its own."""
    name, at = place
    while frames.fixed_in_parent(name):
        frame = frames.each[name]
        at = frames.words.column(frame.origin) + frames.carried(at, name, frame.parent)
        name = frame.parent
    return name, at


def moment(frames: Frames, body: str) -> Matrix:
    """Return the rate of the angular momentum of a body about its mass centre."""
    return _moment(frames, body, body, inertia_tensor(frames, body), {})


def moment_about(frames: Frames, body: str, at: Matrix) -> Matrix:
    """Return the moment that a body's motion needs about a point that it carries, along its axes.

    at : the point, along the body's own axes from their origin
    """
    known = {"m": mass(frames, body), "rho_G": centre(frames, body)[1] - at}
    I_P = by_law("parallel_axes", known | {"I_G": inertia_tensor(frames, body)})
    known["a_A"] = _accelerated(frames, body, at)
    return _moment(frames, body, f"{body}.about", I_P, known)


def _accelerated(frames: Frames, body: str, at: Matrix) -> Matrix:
    """Return the acceleration of a point that a body carries, along its axes."""
    own = frames.own(body)
    parts = frames.accelerated(own, at, frames.acceleration[own])
    a_A = sum((frames.carried(part, name, own) for name, part in parts.items()), ZERO)
    return frames.sheet.column(f"{body}.a_A", a_A)


def form_about(frames: Frames, body: str, at: Matrix) -> str:
    """Return the lecture step by which ``moment_about`` stands.

    A point at rest, G, and one that accelerates along the line to G need no further term.
    """
    term = (centre(frames, body)[1] - at).cross(_accelerated(frames, body, at))
    return (
        "general_form"
        if all(vanishes(frames.words, part) for part in term)
        else "moving_point_form"
    )


def _moment(
    frames: Frames,
    body: str,
    label: str,
    I: Matrix,  # noqa: E741
    about: Mapping[str, Any],
) -> Matrix:
    sheet, Omega = frames.sheet, frames.Omega[frames.own(body)]
    omega = sheet.column(f"{body}.omega", frames.turning_of_body(body))
    known = {"I": I, "omega": omega, "Omega": Omega}
    I_dot = by_law("inertia_rate_in_axes", known)
    known["I_dot"] = zeros(3, 3) if I_dot.applyfunc(reduced) == zeros(3, 3) else I_dot
    known["omega_dot"] = sheet.column(f"{body}.omega_dot", sheet.rate_of_column(omega))
    step = "moving_point_form" if about else "general_form"
    return sheet.column(f"{label}.M", by_law(step, known | dict(about)))


def carries(frames: Frames, body: str, place: Located) -> bool:
    """Tell whether a point moves with a body: fixed in its axes, and on the axis it spins on."""
    own, G = centre(frames, body)
    if place[0] != own or frames.sheet.rate_of_column(place[1]) != ZERO:
        return False
    member = frames.machine.body(body)
    if member.angular_velocity is not None:
        return bool(place[1] == G)
    if member.spin is None and member.axial_speed is None:
        return True
    return all(
        (x - y).expand() == 0
        for x, y, axis in zip(G, place[1], "xyz", strict=True)
        if axis != member.axis
    )


def momentum(frames: Frames, body: str) -> Matrix:
    """Return the angular momentum of a body about its mass centre."""
    omega = frames.sheet.column(f"{body}.omega", frames.turning_of_body(body))
    return by_law("angular_momentum", {"I": inertia_tensor(frames, body), "omega": omega})


def centre_velocity(frames: Frames, body: str) -> Matrix:
    """Return the velocity of a body's mass centre in the inertial frame."""
    own, at = centre(frames, body)
    known = {"rho_i": at, "rho_i_dot": frames.sheet.rate_of_column(at), "Omega": frames.Omega[own]}
    v = frames.velocity(own) + by_law("velocity_seen_from_axes", known)
    return frames.sheet.column(f"{body}.v_G", v, "" if at == ZERO else "velocity_seen_from_axes")


def turns_about_fixed_point(frames: Frames, body: str) -> bool:
    """Tell whether a body carries the origin of its axes, and that is a fixed place."""
    own = frames.own(body)
    at_rest = frames.placed(own, INERTIAL) and frames.velocity(own) == ZERO
    return at_rest and carries(frames, body, (own, ZERO))


def kinetic_energy(frames: Frames, body: str) -> Expr:
    """Return the kinetic energy of a body; along which axes v_G is does not matter to it."""
    own, at = centre(frames, body)
    known = {
        "m": mass(frames, body),
        "I": inertia_tensor(frames, body),
        "omega": frames.sheet.column(f"{body}.omega", frames.turning_of_body(body)),
    }
    if turns_about_fixed_point(frames, body):
        about = {"I_G": known["I"], "rho_G": at, "m": known["m"]}
        known["I"] = by_law("parallel_axes", about)
    else:
        v_G = frames.origin_velocity(own)[1] if at == ZERO else centre_velocity(frames, body)
        known["v_G"] = frames.sheet.column(f"{body}.v_G", v_G)
    energy: Expr = by_law(energy_form(frames, body), known)
    return energy


def energy_form(frames: Frames, body: str) -> str:
    """Return the lecture step by which the kinetic energy of a body stands.

    Of a body of which no place is known, G is where it is: there is nothing but its turning.
    """
    if turns_about_fixed_point(frames, body):
        return "kinetic_energy_about_point"
    own, at = centre(frames, body)
    nowhere = not frames.placed(own, INERTIAL) and at == ZERO and frames.velocity(own) == ZERO
    return "energy_of_turning" if nowhere else "koenig"
