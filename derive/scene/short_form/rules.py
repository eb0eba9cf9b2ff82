"""Rules between the tables of a scene: what would be read singly, yet contradicts the rest.

A motion is either free (its acceleration is what the equations find) or prescribed (given, and
the moment is what they find). A scene that mixes the two needs reactions, which come later.
A rule yields a sentence for each way in which a scene breaks it.
"""

import math
from collections.abc import Iterator
from itertools import chain, pairwise

from derive.scene.declaration import AXES, SceneError, Turning
from derive.scene.doubtful import in_degrees
from derive.scene.escape import brief
from derive.scene.formula import ONE, ZERO, symbols
from derive.scene.named import named_unused
from derive.scene.numbers import check_unit, ends_of, middle, valuations_of
from derive.scene.safe import formulas_of
from derive.scene.short_form.declared import ShortForm
from derive.scene.short_form.inertia import carrier, carrier_doubts, check_inertia, inertia_doubts
from derive.scene.wanted import ROTATIONAL, SPLITTINGS, TORQUE_FREE, moves, step_of

FORWARD = ("acceleration", "state_rate")


def check_rules(scene: ShortForm, said: tuple[str, ...]) -> None:
    """Raise SceneError for the first rule that the scene breaks.

    said : the known vectors that the file gives, as opposed to default ranges
    """
    broken = chain(
        _relative_motion(scene), _symmetry(scene), _turns(scene), _attitude(scene),
        _known(scene, said), _point(scene), _position(scene),
        check_inertia(scene.body, scene.parameters), _wheels(scene), _forward(scene),
        _steps_admitted(scene),
    )  # fmt: skip
    for sentence in broken:
        raise SceneError(sentence)


def _chain(scene: ShortForm) -> tuple[Turning, ...]:
    return scene.axes.turned + scene.body.turned


def _prescribed(scene: ShortForm) -> str:
    """Return what prescribes the rotation of the body, "" if it is free."""
    if scene.axes.kind == "given":
        return "axes.angular_velocity is given"
    if scene.body.spin is not None:
        return "body.spin is given"
    if scene.known["angular_velocity"].formulas:
        return "known.angular_velocity is given by formulas"
    free = {c.name for c in scene.coordinates if c.free}
    driven = [turn.coordinate for turn in _chain(scene) if turn.coordinate not in free]
    return f"coordinate '{driven[0]}' is prescribed" if driven else ""


def _relative_motion(scene: ShortForm) -> Iterator[str]:
    """How the body moves in the axes is said once: it does not, by angles, or by a spin."""
    turned, spin = scene.body.turned, scene.body.spin
    if turned and spin is not None:
        yield "body has both turned and spin; give its angles or its spin, not both"
    moves = "body.turned" if turned else "body.spin" if spin is not None else ""
    if scene.axes.fixed_in_body and moves:
        yield f"{moves} moves the body in axes that are fixed in it"
    if not scene.axes.fixed_in_body and not moves:
        rule = "need body.turned, body.spin or fixed_in = 'body' to say how the body moves in them"
        yield f"axes given by {_turning(scene)} {rule}"


def _turning(scene: ShortForm) -> str:
    """Return the entry by which axes turn that are not the body's."""
    return "turned" if scene.axes.kind == "turned" else "angular_velocity"


def _symmetry(scene: ShortForm) -> Iterator[str]:
    """A spin without an angle leaves the inertia constant only about an axis of symmetry."""
    body = scene.body
    if body.spin is None:
        return
    if body.axis is None:
        rule = "axes in which the body has a spin but no angle need an axisymmetric body"
        yield f"{rule}, not '{body.kind}'; or give the angle by body.turned"
    for name, length in zip(AXES, body.centre or (), strict=False):
        if name != body.axis and length != ZERO:
            rule = f"must lie on the axis of spin '{body.axis}'"
            yield f"body.centre {rule}, not at {name} = '{brief(length)}'"


def _turns(scene: ShortForm) -> Iterator[str]:
    """Every angle turns once, all are free or all are prescribed, and free ones are three."""
    used = [turn.coordinate for turn in _chain(scene)]
    for c in scene.coordinates:
        if used.count(c.name) > 1:
            yield f"coordinate '{c.name}' is turned through {used.count(c.name)} times"
        if c.free and c.name not in used:
            yield f"coordinate '{c.name}' is free, but nothing is turned through it"
    every = {c.name for c in scene.coordinates if c.free}
    free = [name for name in used if name in every]
    if free and (reason := _prescribed(scene)):
        later = "a motion partly free and partly prescribed is reserved for a later version"
        yield f"coordinate '{free[0]}' is free, but {reason}; {later}"
    if free and len(free) != 3:
        yield f"a free body is turned through three coordinates, not {len(free)}"
    for one, two in pairwise(_chain(scene) if free else ()):
        if one.axis == two.axis:
            pair = f"'{one.axis} {one.coordinate}' and '{two.axis} {two.coordinate}'"
            yield f"turns {pair} are about one axis, so their angles cannot be told apart"


def _attitude(scene: ShortForm) -> Iterator[str]:
    if scene.axes.quaternion:
        says = "axes.attitude = 'quaternion'"
        if scene.axes.kind != "body":
            yield f"{says} contradicts axes.{_turning(scene)}; give one of them"
        if reason := _prescribed(scene):
            yield f"{says} is for free motion, but {reason}"


def _known(scene: ShortForm, said: tuple[str, ...]) -> Iterator[str]:
    """A known vector must not be given twice, nor made of what is no state."""
    reason = _prescribed(scene)
    own = reason.startswith("known.") and scene.axes.kind == "body"
    for name in ("angular_velocity", "angular_acceleration"):
        if name in said and reason and not (own and name == "angular_velocity"):
            yield f"known.{name} follows from the rest: {reason}"
    for name in ("moment", "force"):
        for part in scene.known[name].formulas or ():
            found = [s for s in sorted(symbols(part)) if s.startswith("omega_")]
            if found and reason:
                yield f"known.{name} uses '{found[0]}', which is no state: {reason}"
    if scene.known["angular_acceleration"].formulas:
        for name in scene.wanted:
            if _forwards(name) or moves(name):
                rule = "finds the angular acceleration, but known.angular_acceleration gives it"
                yield f"'{name}' {rule} by formulas"
    if "force" in said and scene.position is None:
        yield "known.force needs [position]: without it the centre's motion is not asked"


def _forwards(name: str) -> bool:
    """Tell whether a function finds an acceleration."""
    return name.removesuffix("_jacobian") in FORWARD


def _point(scene: ShortForm) -> Iterator[str]:
    body, kind = scene.body, scene.point.kind
    if kind == "centre_of_mass" and body.centre is not None:
        yield "body.centre is zero about the mass centre; leave it out or name the point"
    if kind == "moving":
        for name, found in (("mass", body.mass), ("centre", body.centre)):
            if found is None:
                yield f"a moving point needs body.{name}"
        for name in ("kinetic_energy", "kinetic_energy_jacobian"):
            if name in scene.wanted:
                yield f"'{name}' needs the velocity of the moving point, which is not given"


def _position(scene: ShortForm) -> Iterator[str]:
    if scene.position is None:
        return
    if scene.body.mass is None:
        yield "[position] needs body.mass"
    if scene.point.kind != "centre_of_mass":
        yield f"[position] is that of the mass centre, not of a {scene.point.kind} point"
    if reason := _prescribed(scene):
        yield f"[position] is for free motion, but {reason}"
    if not (scene.axes.quaternion or scene.axes.turned):
        yield "[position] needs axes.attitude = 'quaternion' or axes.turned"


def _wheels(scene: ShortForm) -> Iterator[str]:
    if scene.wheels and not scene.axes.fixed_in_body:
        yield "wheels need axes fixed in their carrier, the body: fixed_in = 'body'"
    if scene.wheels and scene.point.kind == "moving":
        yield "wheels need a point that is fixed or the mass centre, not moving"
    values = middle(ends_of(scene.parameters))
    for wheel in scene.wheels:
        check_unit(wheel.axis, f"wheel '{wheel.name}': axis", values)
    if scene.wheels:
        yield from carrier_doubts(carrier(scene), (), [values])


def _forward(scene: ShortForm) -> Iterator[str]:
    """An acceleration can be found only where the motion is free and the inertia invertible."""
    for name in filter(_forwards, scene.wanted):
        if reason := _prescribed(scene):
            yield f"'{name}' can be found only for free motion, but {reason}"
        yield from _rod(scene, name)


def _rod(scene: ShortForm, name: str) -> Iterator[str]:
    if scene.body.kind == "rod":
        rule = "needs an inertia about every axis, and a thin rod has none about its own"
        yield f"'{name}' {rule}"


def _steps_admitted(scene: ShortForm) -> Iterator[str]:
    """What moves a scene in time is admitted by its motion."""
    for name in filter(moves, scene.wanted):
        if reason := _prescribed(scene):
            yield f"'{name}' moves a free motion in time, but {reason}"
        yield from _rod(scene, name)
        if scene.point.kind == "moving" and name in ROTATIONAL:
            yield f"'{name}' is about a fixed point or the mass centre, not 'moving'"
        turning = (
            step_of(name) in ("step_lie", "step_rk4_unit")
            or name in ROTATIONAL
            or name.endswith("_tangent")
        )
        if turning and not scene.axes.quaternion:
            yield f"'{name}' moves a quaternion: say axes.attitude = 'quaternion'"
        yield from _rotated(scene, name) if name in ROTATIONAL else ()


def _rotated(scene: ShortForm, name: str) -> Iterator[str]:
    """A free rotation is moved alone, and a kick of a splitting must not depend on omega."""
    moment = scene.known["moment"].formulas or ()
    if scene.wheels:
        yield f"'{name}' is of a rigid body, and wheels turn on this one"
    if scene.position is not None:
        yield f"'{name}' moves attitude and omega only; leave [position] out"
    if name in TORQUE_FREE and moment != (ZERO, ZERO, ZERO):
        yield f"'{name}' is of a torque-free motion: say known.moment = [0, 0, 0]"
    rates = [s for f in moment for s in symbols(f) if s in [f"omega_{a}" for a in AXES]]
    if rates and step_of(name) in SPLITTINGS:
        yield f"'{name}' needs a moment that does not depend on '{rates[0]}'"


def warnings(scene: ShortForm, said: tuple[str, ...]) -> tuple[str, ...]:
    """Return sentences on what is allowed and yet unlikely to be meant."""
    merging = singular_attitude(scene)
    return (
        *inertia_doubts(scene.body, scene.parameters),
        *_doubtful_wheels(scene),
        *_unused(scene, said),
        *_doubtful_axes(scene),
        *named_unused(scene.named, scene.head["text"]),
        *([merging] if merging else []),
        *in_degrees((*scene.coordinates, *scene.parameters, *scene.inputs)),
    )


def _doubtful_wheels(scene: ShortForm) -> Iterator[str]:
    if scene.wheels:
        shown = (*scene.body.inertia, *(f for w in scene.wheels for f in (*w.axis, w.axial)))
        yield from carrier_doubts(carrier(scene), shown, valuations_of(scene.parameters, shown))


def _doubtful_axes(scene: ShortForm) -> Iterator[str]:
    for wheel in scene.wheels:
        x, y, z = wheel.axis
        numbers = all(part.operator == "number" for part in wheel.axis)
        if numbers and x * x + y * y + z * z != ONE:
            yield f"wheel '{wheel.name}': axis has unit length only nearly; write it as a formula"


def _unused(scene: ShortForm, said: tuple[str, ...]) -> Iterator[str]:
    used = {name for _, formula in formulas_of(scene) for name in symbols(formula)}
    for entry in scene.parameters:
        if entry.name not in used:
            yield f"parameter '{entry.name}' is not used"
    for m in (*scene.coordinates, *scene.speeds):
        if m.name not in used and f"{m.name}_dot" not in used:
            yield f"'{m.name}' is declared, but nothing turns with it"
    for one in scene.inputs:
        if one.name not in used:
            yield f"input '{one.name}' is not used"
    for name, users in (("moment", (*FORWARD, "step_", "flow_")), ("force", FORWARD[1:])):
        if name in said and not any(w.startswith((*users, "step_")) for w in scene.wanted):
            asked = "acceleration or state_rate" if name == "moment" else "state_rate or step"
            yield f"known.{name} is given, but no {asked} is wanted"


def singular_attitude(scene: ShortForm) -> str:
    """Return words on where two of three free angles merge in the ranges, "" if nowhere.

    There the first and the third turn are about one line: at a middle angle of 0 for axes as
    z, x, z, at a right angle for axes as z, y, x, and whole numbers of pi further.
    """
    free = {c.name: c for c in scene.coordinates if c.free}
    turns = _chain(scene)
    if len(turns) != 3 or any(turn.coordinate not in free for turn in turns):
        return ""
    turned = free[turns[1].coordinate]
    angle = 0 if turns[0].axis == turns[2].axis else math.pi / 2
    low, high = ((float(end) - angle) / math.pi for end in (turned.low, turned.high))
    if math.floor(high) < math.ceil(low):
        return ""
    at = f"{turned.name} = {angle + math.ceil(low) * math.pi:.6g}"
    return f"the range of '{turned.name}' holds an angle at which the other two merge, {at}"
