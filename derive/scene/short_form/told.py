"""What the scene of a single body declares, in sentences that name only what the user wrote.

Written out with frames, bodies and loads it has names of its own; none of them is said to a reader.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from derive.scene.declaration import Turning
from derive.scene.formula import ZERO, Formula
from derive.scene.named import named_told
from derive.scene.short_form.declared import Axes, Body, ShortForm, Wheel
from derive.scene.wanted import attitudes_only

POINT_PHRASES = {
    "centre_of_mass": "the centre of mass",
    "fixed": "the fixed point",
    "moving": "the moving point",
}
KINDS = {
    "general": "has a full inertia tensor about {point}",
    "principal": "has its own axes as principal axes about {point}",
    "axisymmetric": "is symmetrical about its {axis} axis",
    "spherical": "has the same moment of inertia about every axis",
    "rod": "is thin and lies along its {axis} axis",
}


def told(scene: ShortForm) -> tuple[str, ...]:
    """Return what a scene declares, one sentence each."""
    if attitudes_only(list(scene.wanted)):
        return ("Formulas for attitudes, which need no body.",)
    body = _body(scene.body, POINT_PHRASES[scene.point.kind])
    return (_axes(scene), body, _point(scene), *_wheels(scene.wheels), *_known(scene),
            *named_told(scene.named))  # fmt: skip


def spoken(scene: ShortForm, axes: str, body: str, own: str) -> Mapping[str, str]:
    """Return what a balance calls places, axes and bodies that the user gave no names.

    axes, body, own : what the scene written out calls the axes xyz, the body and its own axes
    """
    point, centre = POINT_PHRASES[scene.point.kind], "the centre of mass"
    at_centre = scene.body.centre is not None and scene.body.mass is not None
    return {
        body: "the body",
        f"the origin of {axes}": point,
        f"the origin of the axes of {body}": centre if at_centre else point,
        f"the mass centre of {body}": centre if at_centre else point,
        axes: "",
        own: "of the body's own axes",
        "inertial": "of the inertial axes",
    }


def _column(formulas: Iterable[Formula]) -> str:
    return f"({', '.join(f.as_written for f in formulas)})"


def _turns(turns: Iterable[Turning]) -> str:
    return ", then ".join(f"about {t.axis} by {t.angle.as_written}" for t in turns)


def _axes(scene: ShortForm) -> str:
    axes, body, omega = scene.axes, scene.body, scene.known["angular_velocity"].formulas
    says = f"The axes xyz {_moving(axes)}"
    if axes.quaternion:
        says += "; their attitude is a unit quaternion, scalar first, body to inertial"
    if axes.kind == "body" and omega:
        says += f"; the body turns with the angular velocity {_column(omega)} along them"
    if body.turned:
        says += f"; in them the body is turned {_turns(body.turned)}"
    if body.spin is not None:
        says += f"; in them the body spins about its {body.axis} axis at {body.spin.as_written}"
    return f"{says}."


def _moving(axes: Axes) -> str:
    if axes.kind == "body":
        return "are fixed in the body"
    fixed = ", and are fixed in the body" if axes.fixed_in_body else ""
    if axes.angular_velocity is not None:
        omega = _column(axes.angular_velocity)
        return f"turn with the angular velocity {omega} along themselves{fixed}"
    return f"are turned from the inertial axes {_turns(axes.turned)}{fixed}"


def _body(body: Body, point: str) -> str:
    parts = [f"a {body.look.replace('_', ' ')}"] if body.look else []
    parts += [f"of mass {body.mass.as_written}"] if body.mass is not None else []
    inner = f", {' '.join(parts)}," if parts else ""
    return f"The body{inner} {KINDS[body.kind].format(axis=body.axis, point=point)}."


def _point(scene: ShortForm) -> str:
    point, centre = scene.point, scene.body.centre
    says = f"Moments are about {POINT_PHRASES[point.kind]}"
    if point.acceleration is not None and point.acceleration.formulas:
        says += f", whose acceleration is {_column(point.acceleration.formulas)} along xyz"
    if centre is not None and any(f != ZERO for f in centre):
        says += f"; from there the mass centre lies at {_column(centre)} along the body's own axes"
    return f"{says}."


def _wheels(wheels: Sequence[Wheel]) -> Iterator[str]:
    for wheel in wheels:
        yield (
            f"Wheel {wheel.name} turns in the body about {_column(wheel.axis)} at "
            f"{wheel.speed.name}, with the moment of inertia {wheel.axial.as_written} about this "
            f"axis and the torque {wheel.torque.name} of its motor."
        )
    if wheels:
        yield "The inertia of the body is that of the whole, wheels locked."


def _known(scene: ShortForm) -> Iterator[str]:
    """Yield what acts on the body, as far as formulas say it, and where it may go."""
    for name, what in (("moment", "external moment"), ("force", "resultant external force")):
        given = scene.known[name].formulas
        if given == (ZERO, ZERO, ZERO):
            yield f"No {what} acts."
        elif given:
            yield f"The {what} is {_column(given)} along xyz."
    if scene.position is not None:
        yield "The body goes where the forces take it: its place is a state, in inertial axes."
