"""Rules for what moves a scene in time: which steps and flows its motion admits."""

from derive.scene.declaration import SceneError, ShortForm
from derive.scene.formula import ZERO, symbols
from derive.scene.wanted import ROTATIONAL, SPLITTINGS, TORQUE_FREE, moves, step_of


def check_moving(scene: ShortForm, prescribed: str) -> None:
    """Raise SceneError for the first step or flow that the scene does not admit.

    prescribed : what prescribes the rotation, "" if it is free
    """
    asked = [name for name in scene.wanted if moves(name)]
    for name in asked:
        if prescribed:
            raise SceneError(f"'{name}' moves a free motion in time, but {prescribed}")
        if scene.body.kind == "rod":
            rule = "needs an inertia about every axis, and a thin rod has none about its own"
            raise SceneError(f"'{name}' {rule}")
        if scene.point.kind == "moving" and name in ROTATIONAL:
            raise SceneError(f"'{name}' is about a fixed point or the mass centre, not 'moving'")
        if step_of(name) == "step_lie" or name in ROTATIONAL or name.endswith("_tangent"):
            _needs_attitude(scene, name)
        if name in ROTATIONAL:
            _needs_rotation_only(scene, name)
        if name in TORQUE_FREE and not _torque_free(scene):
            rule = "is of a torque-free motion: say known.moment = [0, 0, 0]"
            raise SceneError(f"'{name}' {rule}")
        if step_of(name) in SPLITTINGS:
            _needs_kicks(scene, name)


def _needs_attitude(scene: ShortForm, name: str) -> None:
    if not scene.axes.quaternion:
        raise SceneError(f"'{name}' moves a quaternion: say axes.attitude = 'quaternion'")


def _needs_rotation_only(scene: ShortForm, name: str) -> None:
    if scene.wheels:
        raise SceneError(f"'{name}' is of a rigid body, and wheels turn on this one")
    if scene.position is not None:
        raise SceneError(f"'{name}' moves attitude and omega only; leave [position] out")


def _torque_free(scene: ShortForm) -> bool:
    return scene.known["moment"].formulas == (ZERO, ZERO, ZERO)


def _needs_kicks(scene: ShortForm, name: str) -> None:
    """A kick turns no attitude, so the moment may depend on the attitude, but not on omega."""
    formulas = scene.known["moment"].formulas or ()
    rates = [s for f in formulas for s in symbols(f) if s in ("omega_x", "omega_y", "omega_z")]
    if rates:
        raise SceneError(f"'{name}' needs a moment that does not depend on '{rates[0]}'")
