"""What the quantities of a single body are called, and along which axes they lie.

An input of one function may be the answer of another: the moment, and the rate of omega.
"""

from fractions import Fraction

from derive.scene.declaration import AXES, Given, Input, Moving, ShortForm
from derive.scene.machine import Group, Groups
from derive.scene.told import POINTS

QUATERNION = ("w", *AXES)
ANY = (Fraction(-1), Fraction(1))


def groups(scene: ShortForm) -> Groups:
    """Return the quantities that the scene of a single body speaks of, in canonical order."""
    states, outputs = tuple(_states(scene)), tuple(_outputs(scene))
    rates = ("coordinate_rates", "position_rate", "attitude_rate", "velocity_rate", "omega_dot",
             "wheel_accelerations")  # fmt: skip
    inputs = tuple(_inputs(scene))
    known = {g.name for g in (*inputs, *outputs)}
    return Groups(states, inputs, outputs, tuple(name for name in rates if name in known))


def _scalar(entry: Moving | Input) -> Group:
    return Group(entry.name, (entry.name,), entry.unit, "", entry.low, entry.high, entry.meaning)


def _vector(name: str, unit: str, frame: str, given: Given | None, meaning: str) -> Group:
    low, high = (given.low, given.high) if given else ANY
    return Group(name, tuple(f"{name}_{a}" for a in AXES), unit, frame, low, high, meaning)


def _quaternion(name: str, unit: str, says: str) -> Group:
    return Group(name, tuple(f"{name}_{p}" for p in QUATERNION), unit, "N from B", *ANY, says)


def _axes(scene: ShortForm) -> str:
    """Return the name of the axes that vectors are resolved along: B (body) or xyz."""
    return "B" if scene.axes.fixed_in_body else "xyz"


def turns_freely(scene: ShortForm) -> bool:
    """Tell whether omega is a variable of its own and not made of prescribed rates."""
    alone = scene.axes.kind == "body" and not _by_formulas(scene.known["angular_velocity"])
    return alone or any(c.free for c in scene.coordinates)


def _by_formulas(given: Given | None) -> bool:
    """Tell whether a known vector is made of other quantities, and so is none of its own."""
    return given is not None and given.formulas is not None


def _states(scene: ShortForm) -> list[Group]:
    found = [_scalar(c) for c in scene.coordinates if c.free]
    if scene.position is not None:
        says = "position of the centre of mass"
        found.append(_vector("position", "m", "N", scene.position, says))
    if scene.axes.quaternion:
        says = "attitude quaternion, scalar first, body to inertial, |q| = 1"
        found.append(_quaternion("attitude", "1", says))
    if scene.velocity is not None:
        says = "velocity of the centre of mass"
        found.append(_vector("velocity", "m/s", "N", scene.velocity, says))
    if turns_freely(scene):
        given = scene.known.get("angular_velocity")
        says = "angular velocity of the body in the inertial frame"
        found.append(_vector("omega", "rad/s", _axes(scene), given, says))
    return found + _wheels(scene, "wheel_speeds", "rad/s", "speed relative to the carrier")


def _wheels(scene: ShortForm, name: str, unit: str, says: str) -> list[Group]:
    if not scene.wheels:
        return []
    each = [w.torque if name == "wheel_torques" else w.speed for w in scene.wheels]
    dot = "_dot" if name == "wheel_accelerations" else ""
    low, high = min(i.low for i in each), max(i.high for i in each)
    parts = tuple(i.name + dot for i in each)
    return [Group(name, parts, unit, "wheel axes", low, high, f"wheel {says}")]


def _with_rates(m: Moving) -> tuple[Moving | Input, ...]:
    return m, *m.given


def _inputs(scene: ShortForm) -> list[Group]:
    axes, known = _axes(scene), scene.known
    moving = (*(c for c in scene.coordinates if not c.free), *scene.speeds)
    found = [_scalar(one) for m in moving for one in _with_rates(m)]
    found += map(_scalar, scene.inputs)
    if turns_freely(scene) and not _by_formulas(known["angular_acceleration"]):
        given = known.get("angular_acceleration")
        says = "rate of the components of omega along the axes"
        found.append(_vector("omega_dot", "rad/s^2", axes, given, says))
    says = "acceleration relative to the carrier"
    found += _wheels(scene, "wheel_accelerations", "rad/s^2", says)
    acceleration = scene.point.acceleration
    if scene.point.kind == "moving" and not _by_formulas(acceleration):
        says = "acceleration of the moving point in the inertial frame"
        found.append(_vector("point_acceleration", "m/s^2", axes, acceleration, says))
    if scene.position is not None and not _by_formulas(known["force"]):
        found.append(_vector("force", "N", axes, known["force"], "resultant external force"))
    if not _by_formulas(known["moment"]):
        found.append(_moment(scene))
    return found + _wheels(scene, "wheel_torques", "N m", "torque of the motor on the wheel")


def _moment(scene: ShortForm) -> Group:
    says = f"external moment about {POINTS[scene.point.kind]}"
    return _vector("moment", "N m", _axes(scene), scene.known["moment"], says)


def _outputs(scene: ShortForm) -> list[Group]:
    axes, about = _axes(scene), f"angular momentum about {POINTS[scene.point.kind]}"
    said = (("angular_momentum", "kg m^2/s", about),
            ("rate_in_axes", "N m", f"rate of {about}, seen from the axes"),
            ("rate_absolute", "N m", f"rate of {about}, seen from the inertial frame"),
            )  # fmt: skip
    energy = "kinetic energy"
    if scene.position is None and scene.point.kind == "centre_of_mass":
        energy = "kinetic energy of turning about the centre of mass"
    found = [_vector(name, unit, axes, None, says) for name, unit, says in said]
    found.append(Group("kinetic_energy", ("kinetic_energy",), "J", "", None, None, energy))
    if _by_formulas(scene.known["moment"]):
        found.append(_moment(scene))
    free = [c.name for c in scene.coordinates if c.free]
    if free:
        parts, says = tuple(f"{name}_dot" for name in free), f"rates of {', '.join(free)}"
        found.append(Group("coordinate_rates", parts, "rad/s", "", *ANY, says))
    if scene.position is not None:
        found.append(_vector("position_rate", "m/s", "N", None, "rate of the position"))
        found.append(_vector("velocity_rate", "m/s^2", "N", None, "rate of the velocity"))
    if scene.axes.quaternion:
        found.append(_quaternion("attitude_rate", "1/s", "rate of the attitude quaternion"))
    return found
