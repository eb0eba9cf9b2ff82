"""Rules between the tables of a scene: what would be read singly, yet contradicts the rest.

A motion is either free (its acceleration is what the equations find) or prescribed (given, and
the moment is what they find). A scene that mixes the two needs reactions, which come later.
"""

import math
from collections.abc import Iterator

from derive.scene.declaration import SceneError, ShortForm, Turning
from derive.scene.doubtful import in_degrees
from derive.scene.escape import brief
from derive.scene.formula import ZERO, Formula, symbols
from derive.scene.moving import check_moving
from derive.scene.numbers import (
    carrier_doubts,
    check_axis,
    check_carrier,
    check_inertia,
    doubts,
    inexact_axis,
    merging,
)
from derive.scene.wanted import moves

FORWARD = ("acceleration", "state_rate")
ROTATIONAL = ("angular_velocity", "angular_acceleration")


def check(scene: ShortForm, said: tuple[str, ...]) -> None:
    """Raise SceneError for the first rule that the scene breaks.

    said : the known vectors that the file gives, as opposed to default ranges
    """
    _relative_motion(scene)
    _symmetry(scene)
    _turns(scene)
    _attitude(scene)
    _known(scene, said)
    _point(scene)
    _position(scene)
    check_inertia(scene.body, scene.parameters)
    _wheels(scene)
    _forward(scene)
    check_moving(scene, _prescribed(scene))


def _chain(scene: ShortForm) -> tuple[Turning, ...]:
    return scene.axes.turned + scene.body.turned


def _prescribed(scene: ShortForm) -> str:
    """Return what prescribes the rotation of the body, "" if it is free."""
    motions = {entry.name: entry.free for entry in scene.coordinates}
    if scene.axes.kind == "given":
        return "axes.angular_velocity is given"
    if scene.body.spin is not None:
        return "body.spin is given"
    if scene.known["angular_velocity"].formulas:
        return "known.angular_velocity is given by formulas"
    driven = [turn.coordinate for turn in _chain(scene) if not motions[turn.coordinate]]
    return f"coordinate '{driven[0]}' is prescribed" if driven else ""


def _relative_motion(scene: ShortForm) -> None:
    """How the body moves in the axes is said once: it does not, by angles, or by a spin."""
    turned, spin = scene.body.turned, scene.body.spin
    if turned and spin is not None:
        raise SceneError("body has both turned and spin; give its angles or its spin, not both")
    moves = "body.turned" if turned else "body.spin" if spin is not None else ""
    if scene.axes.fixed_in_body and moves:
        raise SceneError(f"{moves} moves the body in axes that are fixed in it")
    if not scene.axes.fixed_in_body and not moves:
        rule = "need body.turned, body.spin or fixed_in = 'body' to say how the body moves in them"
        said = "turned" if scene.axes.kind == "turned" else "angular_velocity"
        raise SceneError(f"axes given by {said} {rule}")


def _symmetry(scene: ShortForm) -> None:
    """A spin without an angle leaves the inertia constant only about an axis of symmetry."""
    body = scene.body
    if body.spin is None:
        return
    if body.axis is None:
        rule = "axes in which the body has a spin but no angle need an axisymmetric body"
        raise SceneError(f"{rule}, not '{body.kind}'; or give the angle by body.turned")
    for name, length in zip(("x", "y", "z"), body.centre or (), strict=False):
        if name != body.axis and length != ZERO:
            rule = f"must lie on the axis of spin '{body.axis}'"
            raise SceneError(f"body.centre {rule}, not at {name} = '{brief(length)}'")


def _turns(scene: ShortForm) -> None:
    """Every angle turns once, all are free or all are prescribed, and free ones are three."""
    motions = {entry.name: entry.free for entry in scene.coordinates}
    used = [turn.coordinate for turn in _chain(scene)]
    for name, motion in motions.items():
        if used.count(name) > 1:
            raise SceneError(f"coordinate '{name}' is turned through {used.count(name)} times")
        if motion and name not in used:
            raise SceneError(f"coordinate '{name}' is free, but nothing is turned through it")
    free = [name for name in used if motions[name]]
    if not free:
        return
    if reason := _prescribed(scene):
        later = "a motion partly free and partly prescribed is reserved for a later version"
        raise SceneError(f"coordinate '{free[0]}' is free, but {reason}; {later}")
    if len(free) != 3:
        raise SceneError(f"a free body is turned through three coordinates, not {len(free)}")
    for first, second in zip(_chain(scene), _chain(scene)[1:], strict=False):
        if first.axis == second.axis:
            pair = f"'{first.axis} {first.coordinate}' and '{second.axis} {second.coordinate}'"
            raise SceneError(
                f"turns {pair} are about one axis, so their angles cannot be told apart"
            )


def _attitude(scene: ShortForm) -> None:
    if not scene.axes.quaternion:
        return
    if scene.axes.kind != "body":
        said = "turned" if scene.axes.kind == "turned" else "angular_velocity"
        raise SceneError(f"axes.attitude = 'quaternion' contradicts axes.{said}; give one of them")
    if reason := _prescribed(scene):
        raise SceneError(f"axes.attitude = 'quaternion' is for free motion, but {reason}")


def _known(scene: ShortForm, said: tuple[str, ...]) -> None:
    """A known vector must not be given twice, nor made of what is no state."""
    reason = _prescribed(scene)
    own = reason.startswith("known.") and scene.axes.kind == "body"
    for name in ROTATIONAL:
        if name in said and reason and not (own and name == "angular_velocity"):
            raise SceneError(f"known.{name} follows from the rest: {reason}")
    for name in ("moment", "force"):
        for part in scene.known[name].formulas or ():
            found = [s for s in sorted(symbols(part)) if s.startswith("omega_")]
            if found and reason:
                raise SceneError(f"known.{name} uses '{found[0]}', which is no state: {reason}")
    if scene.known["angular_acceleration"].formulas:
        for name in scene.wanted:
            if name.removesuffix("_jacobian") in FORWARD or moves(name):
                rule = "finds the angular acceleration, but known.angular_acceleration gives it"
                raise SceneError(f"'{name}' {rule} by formulas")
    if "force" in said and scene.position is None:
        raise SceneError(
            "known.force needs [position]: without it the centre's motion is not asked"
        )


def _point(scene: ShortForm) -> None:
    body, kind = scene.body, scene.point.kind
    if kind == "centre_of_mass" and body.centre is not None:
        raise SceneError(
            "body.centre is zero about the mass centre; leave it out or name the point"
        )
    if kind != "moving":
        return
    for name, found in (("mass", body.mass), ("centre", body.centre)):
        if found is None:
            raise SceneError(f"a moving point needs body.{name}")
    for name in ("kinetic_energy", "kinetic_energy_jacobian"):
        if name in scene.wanted:
            raise SceneError(f"'{name}' needs the velocity of the moving point, which is not given")


def _position(scene: ShortForm) -> None:
    if scene.position is None:
        return
    if scene.body.mass is None:
        raise SceneError("[position] needs body.mass")
    if scene.point.kind != "centre_of_mass":
        raise SceneError(
            f"[position] is that of the mass centre, not of a {scene.point.kind} point"
        )
    if reason := _prescribed(scene):
        raise SceneError(f"[position] is for free motion, but {reason}")
    if not (scene.axes.quaternion or scene.axes.turned):
        raise SceneError("[position] needs axes.attitude = 'quaternion' or axes.turned")


def _wheels(scene: ShortForm) -> None:
    if scene.wheels and not scene.axes.fixed_in_body:
        raise SceneError("wheels need axes fixed in their carrier, the body: fixed_in = 'body'")
    if scene.wheels and scene.point.kind == "moving":
        raise SceneError("wheels need a point that is fixed or the mass centre, not moving")
    for wheel in scene.wheels:
        check_axis(wheel, scene.parameters)
    check_carrier(scene.body, scene.wheels, scene.parameters)


def _forward(scene: ShortForm) -> None:
    """An acceleration can be found only where the motion is free and the inertia invertible."""
    asked = [name for name in scene.wanted if name.removesuffix("_jacobian") in FORWARD]
    if not asked:
        return
    if reason := _prescribed(scene):
        raise SceneError(f"'{asked[0]}' can be found only for free motion, but {reason}")
    if scene.body.kind == "rod":
        rule = "needs an inertia about every axis, and a thin rod has none about its own"
        raise SceneError(f"'{asked[0]}' {rule}")


def warnings(scene: ShortForm, said: tuple[str, ...]) -> tuple[str, ...]:
    """Return sentences on what is allowed and yet unlikely to be meant."""
    return (
        *doubts(scene.body, scene.parameters),
        *carrier_doubts(scene.body, scene.wheels, scene.parameters),
        *_unused(scene, said),
        *_doubtful_angles(scene),
        *in_degrees((*scene.coordinates, *scene.parameters, *scene.inputs)),
    )


def _unused(scene: ShortForm, said: tuple[str, ...]) -> Iterator[str]:
    used = {name for formula in _formulas(scene) for name in symbols(formula)}
    used |= {turn.coordinate for turn in _chain(scene)}
    for entry in scene.parameters:
        if entry.name not in used:
            yield f"parameter '{entry.name}' is not used"
    turning = [entry.name for entry in scene.coordinates]
    for name in turning + [entry.name for entry in scene.speeds]:
        if name not in used and f"{name}_dot" not in used:
            yield f"'{name}' is declared, but nothing turns with it"
    for one in scene.inputs:
        if one.name not in used:
            yield f"input '{one.name}' is not used"
    for name, users in (("moment", (*FORWARD, "step_", "flow_")), ("force", FORWARD[1:])):
        if name in said and not any(w.startswith((*users, "step_")) for w in scene.wanted):
            asked = "acceleration or state_rate" if name == "moment" else "state_rate or step"
            yield f"known.{name} is given, but no {asked} is wanted"


def _formulas(scene: ShortForm) -> Iterator[Formula]:
    """Yield every formula of a scene."""
    body, point = scene.body, scene.point
    yield from body.inertia
    yield from body.centre or ()
    yield from (part for part in (body.mass, body.spin) if part is not None)
    yield from scene.axes.angular_velocity or ()
    for wheel in scene.wheels:
        yield from (*wheel.axis, wheel.axial)
    for moving in (*scene.coordinates, *scene.speeds):
        yield from (r for r in (moving.rate, moving.acceleration) if isinstance(r, Formula))
    for given in (*scene.known.values(), *([point.acceleration] if point.acceleration else [])):
        yield from given.formulas or ()


def _doubtful_angles(scene: ShortForm) -> Iterator[str]:
    for wheel in scene.wheels:
        if inexact_axis(wheel):
            yield f"wheel '{wheel.name}': axis has unit length only nearly; write it as a formula"
    if where := singular_attitude(scene):
        yield where


def singular_attitude(scene: ShortForm) -> str:
    """Return words on where two of three free angles merge in the ranges, "" if nowhere."""
    ranges = {entry.name: entry for entry in scene.coordinates}
    chain = _chain(scene)
    if len(chain) != 3 or any(not ranges[turn.coordinate].free for turn in chain):
        return ""
    middle = ranges[chain[1].coordinate]
    angle = merging(middle, 0 if chain[0].axis == chain[2].axis else math.pi / 2)
    if angle is None:
        return ""
    at = f"{middle.name} = {angle:.6g}"
    return f"the range of '{middle.name}' holds an angle at which the other two merge, {at}"
