"""What the quantities of a single body are called, and along which axes they lie.

An input of one function may be the answer of another: the moment, and the rate of omega.
"""

from collections.abc import Mapping

from derive.scene.declaration import ANY, AXES, Given, Input, Moving
from derive.scene.groups import of_scalar
from derive.scene.machine import Group, Groups
from derive.scene.short_form.declared import ShortForm
from derive.scene.short_form.told import POINT_PHRASES

ATTITUDE, WHEELS, OWN, NO_AXES = "N from B", "wheel axes", "", "none"
"""Along which axes components lie that are three along N or, ``OWN``, along those of the scene."""
RATE = "rate of angular momentum about {about}"
QUANTITIES: Mapping[str, tuple[str, str, str]] = {
    "position": ("m", "N", "position of the centre of mass"),
    "attitude": ("1", ATTITUDE, "attitude quaternion, scalar first, body to inertial, |q| = 1"),
    "velocity": ("m/s", "N", "velocity of the centre of mass"),
    "omega": ("rad/s", OWN, "angular velocity of the body in the inertial frame"),
    "wheel_speeds": ("rad/s", WHEELS, "speed of each wheel relative to the body"),
    "omega_dot": ("rad/s^2", OWN, "rate of the components of omega along the axes"),
    "wheel_accelerations": ("rad/s^2", WHEELS, "rate of the speed of each wheel"),
    "point_acceleration": ("m/s^2", OWN, "acceleration of the moving point in the inertial frame"),
    "force": ("N", OWN, "resultant external force"),
    "moment": ("N m", OWN, "external moment about {about}"),
    "wheel_torques": ("N m", WHEELS, "torque of its motor on each wheel"),
    "angular_momentum": ("kg m^2/s", OWN, "angular momentum about {about}"),
    "rate_in_axes": ("N m", OWN, f"{RATE}, seen from the axes"),
    "rate_absolute": ("N m", OWN, f"{RATE}, seen from the inertial frame"),
    "coordinate_rates": ("rad/s", NO_AXES, "rates of {free}"),
    "position_rate": ("m/s", "N", "rate of the position"),
    "velocity_rate": ("m/s^2", "N", "rate of the velocity"),
    "attitude_rate": ("1/s", ATTITUDE, "rate of the attitude quaternion"),
}
"""Unit, axes and meaning of each vector."""
RATES = ("coordinate_rates", "position_rate", "attitude_rate", "velocity_rate", "omega_dot",
         "wheel_accelerations")  # fmt: skip


def groups(scene: ShortForm) -> Groups:
    """Return the quantities that the scene of a single body speaks of, in canonical order."""
    made = {name for name, given in _given(scene).items() if given and given.formulas is not None}
    missing = _missing(scene) | made
    free = [c for c in scene.coordinates if c.free]
    driven = [c for c in scene.coordinates if not c.free]
    moving = list[Moving | Input]()
    for m in (*driven, *scene.speeds):
        moving += (m, *m.given)

    def of(*names: str) -> tuple[Group, ...]:
        return tuple(_group(scene, name) for name in names if name not in missing)

    whole = scene.position is not None or scene.point.kind != "centre_of_mass"
    says = "kinetic energy" if whole else "kinetic energy of turning about the centre of mass"
    energy = Group("kinetic_energy", ("kinetic_energy",), "J", "", None, None, says)
    states = (
        *map(of_scalar, free),
        *of("position", "attitude", "velocity", "omega", "wheel_speeds"),
    )
    inputs = (
        *map(of_scalar, (*moving, *scene.inputs)),
        *of("omega_dot", "wheel_accelerations", "point_acceleration", "force", "moment"),
        *of("wheel_torques"),
    )
    outputs = (
        *of("angular_momentum", "rate_in_axes", "rate_absolute"), energy,
        *([_group(scene, "moment")] if "moment" in made else []),
        *of("coordinate_rates", "position_rate", "velocity_rate", "attitude_rate"),
    )  # fmt: skip
    known = {g.name for g in (*inputs, *outputs)}
    return Groups(states, inputs, outputs, tuple(name for name in RATES if name in known))


def turns_freely(scene: ShortForm) -> bool:
    """Tell whether omega is a variable of its own and not made of prescribed rates."""
    alone = scene.axes.kind == "body" and scene.known["angular_velocity"].formulas is None
    return alone or any(c.free for c in scene.coordinates)


def _given(scene: ShortForm) -> Mapping[str, Given | None]:
    """Return the ranges or formulas that the scene gives for vectors."""
    known = scene.known
    return {
        "omega": known["angular_velocity"], "omega_dot": known["angular_acceleration"],
        "moment": known["moment"], "force": known["force"], "position": scene.position,
        "velocity": scene.velocity, "point_acceleration": scene.point.acceleration,
    }  # fmt: skip


def _missing(scene: ShortForm) -> set[str]:
    """Return the vectors of which the scene does not speak."""
    there = {
        ("position", "velocity", "position_rate", "velocity_rate", "force"): scene.position,
        ("attitude", "attitude_rate"): scene.axes.quaternion,
        ("omega", "omega_dot"): turns_freely(scene),
        ("wheel_speeds", "wheel_accelerations", "wheel_torques"): scene.wheels,
        ("point_acceleration",): scene.point.acceleration,
        ("coordinate_rates",): any(c.free for c in scene.coordinates),
    }
    return {name for names, is_so in there.items() if not is_so for name in names}


def _group(scene: ShortForm, name: str) -> Group:
    unit, axes, says = QUANTITIES[name]
    free = [c.name for c in scene.coordinates if c.free]
    about = POINT_PHRASES[scene.point.kind]
    given, frame = _given(scene).get(name), axes or ("B" if scene.axes.fixed_in_body else "xyz")
    low, high = (given.low, given.high) if given else ANY
    components = [f"{name}_{part}" for part in (("w", *AXES) if axes == ATTITUDE else AXES)]
    if axes == WHEELS:
        each = [w.torque if name == "wheel_torques" else w.speed for w in scene.wheels]
        low, high = min(i.low for i in each), max(i.high for i in each)
        components = [i.name + "_dot" * (name == "wheel_accelerations") for i in each]
    elif axes == NO_AXES:
        components, frame = [f"{c}_dot" for c in free], ""
    says = says.format(about=about, free=", ".join(free))
    return Group(name, tuple(components), unit, frame, low, high, says, name == "attitude")
