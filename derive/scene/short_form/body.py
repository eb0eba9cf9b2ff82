"""The table ``[body]``: a kind or a shape, its inertia moved to the point of the scene."""

from dataclasses import replace
from typing import cast

from derive.scene.bodies import CHOSEN, InertiaKind, Substance, every_key, of_kind, of_shape
from derive.scene.declaration import AXES, SceneError, Sextuple, Triple, Turning
from derive.scene.entries import BODY
from derive.scene.entry import Reading
from derive.scene.escape import brief
from derive.scene.formula import ZERO
from derive.scene.scalars import Scalars
from derive.scene.shape import SHAPES, by_parallel_axes
from derive.scene.short_form.declared import Body
from derive.scene.table import Table, keys, nearest


def read_body(given: Table, point: str, scalars: Scalars) -> Body:
    """Return the body of a scene, its inertia about the scene's point along its own axes.

    point : the kind of the scene's point; a shape is moved to it unless it is the mass centre
    """
    said = [key for key in CHOSEN if key in given.entries]
    if not said:
        keys(given, (), every_key(BODY))
    if len(said) != 1:
        found = "both" if said else "neither"
        raise SceneError(f"body needs either a kind or a shape, and has {found}")
    by = Reading(scalars.scopes, {}, scalars.parameters)
    if "shape" in given.entries:
        made = of_shape(given, SHAPES, BODY, by)
        centre = made.said["centre"]
        if made.said.get("about") == "apex":
            centre = _from_apex(made, point)
        made = _at_point(made, centre, point)
    else:
        made = of_kind(given, BODY, by)
        if made.mass == ZERO:
            raise SceneError("body.mass must be positive, not 0")
        centre = made.said["centre"]
        for key in ("axial", "transverse"):
            if made.kind == "axisymmetric" and made.said[key] is None:
                raise SceneError(f"body needs '{key}'")
    turned, spin = made.said["turned"] or (), made.said["spin"]
    through_coordinates(turned, "body.turned", scalars)
    return Body(
        cast("InertiaKind", made.kind), made.mass, cast("Sextuple", made.inertia), centre,
        made.axis, turned, spin, made.lengths or {}, made.look, made.parts,
    )  # fmt: skip


def _from_apex(made: Substance, point: str) -> Triple:
    """Return the mass centre of a cone that opens from the point along its positive axis."""
    if point == "centre_of_mass":
        raise SceneError("body.about = 'apex' needs a fixed or moving point, not 'centre_of_mass'")
    if made.said["centre"] is not None:
        raise SceneError("body.centre follows from body.about = 'apex'; leave it out")
    return made.apex()


def _at_point(made: Substance, centre: Triple | None, point: str) -> Substance:
    """Move a shape's inertia to the scene's point, and say what kind of body it is about it."""
    if point == "centre_of_mass":
        return made
    if centre is None:
        raise SceneError(f"a shape about a {point} point needs body.centre, from that point")
    assert made.mass is not None  # noqa: S101 - every shape says its mass
    inertia = by_parallel_axes(cast("Sextuple", made.inertia), made.mass, centre)
    off = [name for name, length in zip(AXES, centre, strict=True) if length != ZERO]
    if not off or off == [made.axis]:
        return replace(made, inertia=inertia)
    if any(product != ZERO for product in inertia[3:]):
        return replace(made, kind="general", inertia=inertia, axis=None)
    if made.kind == "spherical":
        return replace(made, kind="axisymmetric", inertia=inertia, axis=off[0])
    return replace(made, kind="principal", inertia=inertia, axis=None)


def through_coordinates(turned: tuple[Turning, ...], label: str, scalars: Scalars) -> None:
    """Refuse turns of which one is not through a coordinate."""
    known = [c.name for c in scalars.coordinates]
    for turn in turned:
        if turn.coordinate not in known:
            rule = f"turns through '{brief(turn.angle)}', which is no coordinate of the scene"
            raise SceneError(f"{label} {rule}{nearest(str(turn.angle), known)}")
