"""A body that turns freely: the frame whose attitude is a quaternion and all that is fixed in it.

Steps in time and samples of hard bodies need its tensor and its moment, whatever bodies and loads
these are the sums of.
"""

from dataclasses import dataclass

from sympy import Expr, Matrix, zeros

from derive.lecture.stated import by_law
from derive.lecture.turning import reduced
from derive.mechanics.bodies import centre, inertia_tensor, mass
from derive.mechanics.frames import ZERO, Frames
from derive.mechanics.loads import Wrench, wrenches
from derive.program.program import Quantity
from derive.scene import SceneError
from derive.scene.machine import INERTIAL, Frame


@dataclass(frozen=True)
class FreeRotation:
    """The free rotation of a frame about its origin, which is at rest or the mass centre.

    attitude : quaternion of the frame in the inertial one      omega : (3,) rad/s, along the frame
    tensor   : (3, 3) kg m^2 about the origin, along the frame, of parameters only
    moment   : (3, 1) N m of all loads about the origin, along the frame, of inputs and states
    """

    frame: str
    attitude: Quantity
    omega: Quantity
    tensor: Matrix
    moment: Matrix


def free_rotation(frames: Frames) -> FreeRotation | None:
    """Return the rotation of the only quaternion, None where other things move with it.

    It is free if omega is a vector of the state, every body is fixed in the frame, and the loads
    have a known moment about its origin.
    """
    turning = [frame for frame in frames.each.values() if frame.attitude]
    bodies = [body.name for body in frames.machine.bodies]
    if len(turning) != 1 or turning[0].parent != INERTIAL:
        return None
    (frame,) = turning
    omega = _omega(frames, frame)
    if omega is None or not all(_fixed(frames, body, frame.name) for body in bodies):
        return None
    if not (_at_rest(frames, frame) or _balanced(frames, frame.name)):
        return None
    whole = sum((_tensor(frames, body, frame.name) for body in bodies), zeros(3, 3))
    try:
        acting = sum((_moment(frames, frame.name, w) for w in wrenches(frames)), ZERO)
    except SceneError:  # a load at a place, or along axes, that are not known in the frame
        return None
    acting = acting.applyfunc(lambda value: written_out(frames, value))
    if (whole.free_symbols | acting.free_symbols) & {*frames.sheet.unknowns, *frames.words.hidden}:
        return None
    return FreeRotation(frame.name, frames.words.spoken[frame.attitude], omega, whole, acting)


def _omega(frames: Frames, frame: Frame) -> Quantity | None:
    """Return the vector of the state that a frame turns with, None if it turns otherwise."""
    parts = tuple(f.name for f in frame.angular_velocity or () if f.operator == "symbol")
    return next((q for q in frames.words.spoken.states if q.components == parts), None)


def _fixed(frames: Frames, body: str, name: str) -> bool:
    """Tell whether a body keeps its place and its axes in a frame."""
    member, own = frames.machine.body(body), frames.own(body)
    if (member.spin, member.axial_speed, member.angular_velocity) != (None, None, None):
        return False
    chain = frames.chain(own)
    still = name in chain and all(map(frames.fixed_in_parent, chain[: chain.index(name)]))
    return still and _zero(frames.sheet.rate_of_column(centre(frames, body)[1]))


def _at_rest(frames: Frames, frame: Frame) -> bool:
    if frame.velocity is not None:
        return _zero(frames.words.column(frame.velocity))
    if frame.acceleration is not None or frame.rolls is not None:
        return False
    return _zero(frames.sheet.rate_of_column(frames.words.column(frame.origin)))


def _balanced(frames: Frames, name: str) -> bool:
    """Tell whether the mass centre of all bodies is the origin of their frame."""
    first = sum((mass(frames, b.name) * _arm(frames, b.name, name) for b in frames.machine.bodies),
                ZERO)  # fmt: skip
    return _zero(first.applyfunc(reduced))


def _zero(column: Matrix) -> bool:
    return bool(column == ZERO)


def _arm(frames: Frames, body: str, name: str) -> Matrix:
    return frames.apart((name, ZERO), centre(frames, body), name)


def _tensor(frames: Frames, body: str, name: str) -> Matrix:
    """Return the tensor of a body about the origin of a frame that carries it, along the frame."""
    about_G, arm, at = inertia_tensor(frames, body), _arm(frames, body, name), frames.own(body)
    while at != name:
        R = frames.rotations[at]
        about_G = by_law("change_of_axes", {"R": R, "I": about_G}).applyfunc(reduced)
        at = frames.each[at].parent
    if arm == ZERO:
        return about_G
    known = {"m": mass(frames, body), "rho_G": arm, "I_G": about_G}
    return by_law("parallel_axes", known).applyfunc(lambda value: value.expand())


def _moment(frames: Frames, name: str, acts: Wrench) -> Matrix:
    """Return the moment of a load about the origin of a frame, along the frame."""
    couple = frames.carried(acts.couple, acts.along, name)
    if acts.force == ZERO:
        return couple
    arm = frames.apart((name, ZERO), acts.point, name)
    if arm == ZERO:
        return couple
    force = frames.carried(acts.force, acts.along, name)
    return by_law("moment_about_any_point", {"M_G": couple, "rho_G": arm, "F": force})


def written_out(frames: Frames, value: Expr) -> Expr:
    """Return a value with no named quantity in it."""
    while named := value.free_symbols & frames.sheet.definitions.keys():
        value = value.xreplace({s: frames.sheet.definitions[s] for s in named})
    return value
