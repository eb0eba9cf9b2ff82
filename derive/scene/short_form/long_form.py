"""The scene of a single body written out with frames, bodies and loads: what the short form means.

The axes become a frame, the body and its wheels become members, the known moment a load. A motion
is *sought* where accelerations are found from the moment, *given* where the moment is found.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from derive.scene.declaration import ANY, AXES, Input, Kind, Moving, Triple, Turning
from derive.scene.formula import ONE, ZERO, Formula, apply, symbol
from derive.scene.machine import (
    INERTIAL,
    Entries,
    Force,
    Frame,
    Load,
    Member,
    Place,
    Scene,
    Unknown,
)
from derive.scene.shape import by_parallel_axes
from derive.scene.short_form.declared import ShortForm
from derive.scene.short_form.inertia import carrier, of_one_body
from derive.scene.short_form.quantities import groups, turns_freely
from derive.scene.short_form.rules import singular_attitude
from derive.scene.short_form.told import spoken, told

FRAME, BODY = "xyz", "body"
NOWHERE: Triple = (ZERO, ZERO, ZERO)
Motion = Literal["sought", "given"]


def in_long_form(scene: ShortForm) -> Scene:
    """Return the machine that a scene of a single body is; names of scalars stay what they are."""
    given = replace(long_form(scene, "given"), wanted=())
    return replace(long_form(scene, "sought"), inverse=given, told=told(scene))


def long_form(scene: ShortForm, motion: Motion) -> Scene:
    """Return the machine of a single body whose motion is sought, or given."""
    speeds, inputs = [*scene.speeds], [*scene.inputs]
    if turns_freely(scene):
        speeds += _omega(scene, motion)
    coordinates = [_coordinate(scene, c) for c in scene.coordinates]
    if scene.position is not None:
        coordinates += _position()
    force = scene.known["force"] if scene.position else None
    known = (("moment", scene.known["moment"], "N m"), ("force", force, "N"),
             ("point_acceleration", scene.point.acceleration, "m/s^2"))  # fmt: skip
    for name, given, unit in known:
        if given is not None and given.formulas is None and (name, motion) != ("moment", "given"):
            inputs += [_driven(f"{name}_{a}", unit, "input") for a in AXES]
    wheels = [_wheel(scene, n, motion) for n in range(len(scene.wheels))]
    speeds += [speed for speed, _, _ in wheels]
    inputs += [_driven(w.torque.name, "N m", "input") for w in scene.wheels]
    loads, unknowns = _loads(scene, motion)
    return Scene(
        **scene.head, parameters=scene.parameters, coordinates=tuple(coordinates),
        speeds=tuple(speeds), inputs=tuple(inputs), frames=(Frame(INERTIAL, ""), _frame(scene)),
        bodies=(_body(scene), *(member for _, member, _ in wheels)),
        loads=(*loads, *(load for _, _, load in wheels)), unknowns=unknowns, results=(),
        momentum=Place(FRAME, NOWHERE, (BODY, *(member.name for _, member, _ in wheels))),
        about={}, steady={}, asked={}, warnings=scene.warnings,
        demands=of_one_body(scene), merging=singular_attitude(scene), groups=groups(scene),
        spoken=spoken(scene, FRAME, BODY, f"{BODY}.axes"),
        marks={FRAME: "", f"{BODY}.axes": "B", BODY: "B"},
    )  # fmt: skip


def _omega(scene: ShortForm, motion: Motion) -> list[Moving]:
    """Return the components of omega: free, or with rates that are given."""
    names = [(f"omega_{a}", f"omega_dot_{a}") for a in AXES]
    if motion == "sought":
        return [_free(name, "rad/s", "speed", None, rate) for name, rate in names]
    inputs = [Input(rate, "rad/s^2", *ANY, "") for _, rate in names]
    rates: Sequence[Input | Formula] = scene.known["angular_acceleration"].formulas or inputs
    return [_driven(n, "rad/s", "speed", r) for (n, _), r in zip(names, rates, strict=True)]


def _free(name: str, unit: str, kind: Kind, rate: Input | None, highest: str = "") -> Moving:
    return Moving(name, unit, *ANY, "", kind, free=True, state=True, rate=rate, acceleration=None,
                  highest=highest)  # fmt: skip


def _driven(name: str, unit: str, kind: Kind, rate: Input | Formula | None = None) -> Moving:
    return Moving(name, unit, *ANY, "", kind, free=False, state=False, rate=rate,
                  acceleration=None)  # fmt: skip


def _position() -> list[Moving]:
    """Return the coordinates of the mass centre, whose rates have names of their own."""
    return [
        _free(f"position_{a}", "m", "coordinate", Input(f"velocity_{a}", "m/s", *ANY, ""),
              f"velocity_rate_{a}")
        for a in AXES
    ]  # fmt: skip


def _coordinate(scene: ShortForm, c: Moving) -> Moving:
    """Return an angle of the body; the rate of a free one follows from omega."""
    if not c.free:
        return c
    return replace(c, free=False, state=True, rate=angle_rates(scene)[c.name])


def angle_rates(scene: ShortForm) -> dict[str, Formula]:
    """Return the rates of three free angles, from the components of omega along the axes.

    Along the axes after the second turn, that turn has its own axis, the third has its own, and
    the first lies in the plane across the second.
    """
    chain = (*scene.axes.turned, *scene.body.turned)
    (first, second, third), turned = chain, len(scene.axes.turned)
    omega = [symbol(f"omega_{a}") for a in AXES]
    if turned == 3:
        omega = _turned(omega, third)
    elif turned == 1:
        omega = _turned(omega, _back(second))
    line = _turned([ONE if a == first.axis else ZERO for a in AXES], _back(second))
    one, two, three = (AXES.index(turn.axis) for turn in chain)
    across = 3 - one - two if three == one else one  # along which the third turn has no part
    rate = omega[across] / line[across]
    return {
        first.coordinate: rate,
        second.coordinate: omega[two],
        third.coordinate: omega[three] - rate * line[three],
    }


def _back(turn: Turning) -> Turning:
    return Turning(turn.axis, -turn.angle)


def _turned(v: Sequence[Formula], turn: Turning) -> list[Formula]:
    """Return the components along the old axes of a vector given along turned ones."""
    k = AXES.index(turn.axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    s, c = apply("sin", turn.angle), apply("cos", turn.angle)
    found = list(v)
    found[i], found[j] = c * v[i] - s * v[j], s * v[i] + c * v[j]
    return found


def _frame(scene: ShortForm) -> Frame:
    """Return the axes as a frame; its origin is the scene's point."""
    axes, given = scene.axes, scene.known["angular_velocity"].formulas
    omega = axes.angular_velocity
    if axes.kind == "body":
        omega = given or tuple(symbol(f"omega_{a}") for a in AXES)  # type: ignore[assignment]
    attitude = "attitude" if axes.quaternion else ""
    frame = Frame(FRAME, INERTIAL, axes.turned, omega, attitude)
    if scene.position is not None:
        x, y, z = (symbol(f"position_{a}") for a in AXES)
        return replace(frame, origin=(x, y, z))
    if scene.point.kind == "fixed":
        return frame
    if scene.point.acceleration is None:
        return replace(frame, velocity=NOWHERE)
    x, y, z = scene.point.acceleration.formulas or (symbol(f"point_acceleration_{a}") for a in AXES)
    return replace(frame, acceleration=(x, y, z), velocity=NOWHERE)


def _body(scene: ShortForm) -> Member:
    """Return the carrier: the body without what its wheels have about their axes."""
    body = scene.body
    inertia: Entries = carrier(scene)
    centre = NOWHERE
    if body.mass is not None and body.centre is not None:
        centre, inertia = body.centre, by_parallel_axes(carrier(scene), -body.mass, body.centre)
        for turn in reversed(body.turned):
            x, y, z = _turned(centre, turn)
            centre = (x, y, z)
    return Member(BODY, FRAME, body.mass, inertia, centre, body.axis, body.turned, body.spin,
                  parts=body.parts)  # fmt: skip


def _wheel(scene: ShortForm, n: int, motion: Motion) -> tuple[Moving, Member, Load]:
    """Return the speed of a wheel, the wheel, and what its motor and its bearing do to it."""
    wheel, (x, y, z) = scene.wheels[n], scene.wheels[n].axis
    s, u, C = symbol(wheel.speed.name), symbol(wheel.torque.name), wheel.axial
    rate, moves = Input(f"{wheel.speed.name}_dot", "rad/s^2", *ANY, ""), wheel.speed.name
    speed = _driven(moves, "rad/s", "speed", rate)
    if motion == "sought":
        speed = _free(moves, "rad/s", "speed", None)
    inertia = (C * x * x, C * y * y, C * z * z, -C * x * y, -C * x * z, -C * y * z)
    name = f"wheel {wheel.name}"
    spin_axis = None if sorted(map(str, (x, y, z))) == ["0", "0", "1"] else (x, y, z)
    member = Member(name, FRAME, ZERO, inertia, NOWHERE, angular_velocity=(s * x, s * y, s * z),
                    spin_axis=spin_axis)  # fmt: skip
    held = [symbol(_held(wheel.name, a)) for a in AXES]
    along = x * held[0] + y * held[1] + z * held[2]
    turning = u if motion == "sought" else along
    couple = tuple(k + a * (turning - along) for k, a in zip(held, (x, y, z), strict=True))
    force = tuple(symbol(_held(wheel.name, f"f{a}")) for a in AXES)
    load = Force(name, name, BODY, FRAME, NOWHERE, FRAME, force, couple)  # type: ignore[arg-type]
    return speed, member, load


def _held(wheel: str, part: str) -> str:
    return f"bearing of wheel {wheel}, {part}"


def _loads(scene: ShortForm, motion: Motion) -> tuple[list[Load], tuple[Unknown, ...]]:
    """Return what acts on the body, and which of it is to be found."""
    names = [
        _held(w.name, part) for w in scene.wheels for part in (*AXES, *(f"f{a}" for a in AXES))
    ]
    if motion == "given":
        names += [f"moment_{a}" for a in AXES]
    moment = scene.known["moment"].formulas if motion == "sought" else None
    couple = moment or tuple(symbol(f"moment_{a}") for a in AXES)
    force: tuple[Formula, ...] = NOWHERE
    if scene.position is not None:
        force = scene.known["force"].formulas or tuple(symbol(f"force_{a}") for a in AXES)
    else:
        held = [f"force that holds the point, {a}" for a in AXES]
        names += held
        force = tuple(map(symbol, held))
    load = Force("external", BODY, "", FRAME, NOWHERE, FRAME, force, couple)  # type: ignore[arg-type]
    return [load], tuple(Unknown(name, "", "external") for name in names)
