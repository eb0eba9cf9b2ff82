"""What a scene says, in sentences: the body, the point, the axes, what acts, what is wanted."""

from derive.emit.page import machine
from derive.scene import Given, Machine, Scene, Turning
from derive.scene.formula import Formula

_BODIES = {
    "general": "a rigid body with a full inertia tensor",
    "principal": "a rigid body whose principal axes are known",
    "axisymmetric": "a rigid body with the {axis} axis as axis of symmetry",
    "spherical": "a rigid body with three equal moments of inertia",
    "rod": "a thin rod along the {axis} axis",
}
_POINTS = {
    "centre_of_mass": "Moments are taken about the mass centre.",
    "fixed": "Moments are taken about a point of the body that is fixed in the inertial frame.",
    "moving": "Moments are taken about a point of the body that moves with a known acceleration.",
}


def given(scene: Scene | Machine) -> list[str]:
    """Return what the scene gives, one sentence each."""
    if isinstance(scene, Machine):
        return machine.given(scene)
    sentences = [f"The body is {_BODIES[scene.body.kind].format(axis=scene.body.axis)}."]
    sentences += [_wheels(scene)] if scene.wheels else []
    sentences += [_POINTS[scene.point.kind], _axes(scene), *_turning(scene), *_loads(scene)]
    return sentences


def _wheels(scene: Scene) -> str:
    each = [f"wheel {w.name} along {_column(w.axis)}" for w in scene.wheels]
    return (
        f"It carries {_listed(each)}; each wheel is balanced and axisymmetric, and the tensor of "
        "the body is that of the whole with the wheels locked."
    )


def _axes(scene: Scene) -> str:
    axes = scene.axes
    if axes.turned:
        fixed = "They are fixed in the body." if axes.fixed_in_body else ""
        turns = f"axes turned from the inertial axes {_turns(axes.turned)}"
        return f"Vectors are resolved along {turns}. {fixed}".strip()
    if axes.angular_velocity is not None:
        own = _column(axes.angular_velocity)
        return f"Vectors are resolved along axes that turn with the angular velocity {own}."
    attitude = " Its attitude is a unit quaternion, scalar first." if axes.quaternion else ""
    return f"Vectors are resolved along axes fixed in the body.{attitude}"


def _turning(scene: Scene) -> list[str]:
    found = []
    if scene.body.turned:
        found.append(f"The body is turned from these axes {_turns(scene.body.turned)}.")
    if scene.body.spin is not None:
        found.append(f"It spins about its axis at {scene.body.spin} relative to the axes.")
    return found


def _loads(scene: Scene) -> list[str]:
    found = []
    moment = scene.known.get("moment")
    if moment is not None and moment.formulas is not None:
        found.append(f"The external moment is {_column(moment.formulas)}.")
    force = scene.known.get("force")
    if force is not None and force.formulas is not None:
        found.append(f"The external force is {_column(force.formulas)}.")
    acceleration: Given | None = scene.point.acceleration
    if acceleration is not None and acceleration.formulas is not None:
        found.append(f"The point accelerates at {_column(acceleration.formulas)}.")
    return found


def _turns(turns: tuple[Turning, ...]) -> str:
    return ", then ".join(f"about {turn.axis} by {turn.coordinate}" for turn in turns)


def _column(formulas: tuple[Formula, Formula, Formula]) -> str:
    return f"({', '.join(map(str, formulas))})"


def _listed(parts: list[str]) -> str:
    *first, last = parts
    return f"{', '.join(first)} and {last}" if first else last
