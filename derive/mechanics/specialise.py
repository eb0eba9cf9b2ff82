"""A scene in the lecture's terms: what each of the lecture's symbols stands for in it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sympy import Matrix, zeros

from derive.lecture.chapters import LECTURE
from derive.lecture.vectors import Expression, components
from derive.mechanics.turning import Motion, motion, reduced, rotation
from derive.mechanics.vocabulary import Vocabulary, vocabulary
from derive.scene import Given, Scene, SceneError


@dataclass(frozen=True)
class Specialised:
    """A scene in the lecture's terms: its words, its motion, what the lecture's symbols mean."""

    scene: Scene
    words: Vocabulary
    motion: Motion
    bindings: Mapping[str, Any]


def specialise(scene: Scene) -> Specialised:
    """Return ``scene`` with every symbol of the lecture bound to the scene's own quantities."""
    words = vocabulary(scene)
    moves = motion(scene, words)
    bindings: dict[str, Any] = {
        "I": moves.tensor,
        "omega": moves.omega,
        "omega_dot": moves.omega_dot,
        "Omega": moves.Omega,
        "M": moment(scene, words),
        "h": zeros(3, 1),
        "h_dot": zeros(3, 1),
        "v_G": words.column("velocity") if "velocity" in words else zeros(3, 1),
        "F": _force(scene, words),
    }
    if scene.body.mass is not None:
        bindings["m"] = words.expression(scene.body.mass)
    if scene.point.kind == "moving":
        bindings |= _moving_point(scene, words)
    if scene.wheels:
        bindings["h"], bindings["h_dot"] = _wheel_momentum(scene, words)
    seen_from_axes = {"I": moves.tensor, "omega": moves.relative, "Omega": zeros(3, 1)}
    bindings["I_dot"] = stated("inertia_rate_in_axes", seen_from_axes).applyfunc(reduced)
    return Specialised(scene, words, moves, bindings)


def stated(step: str, bindings: Mapping[str, Any]) -> Any:
    """Return the right side of a lecture step in the components that ``bindings`` give."""
    return components(law(step), bindings)


def law(step: str) -> Expression:
    """Return the right side of a lecture step that makes one claim."""
    right = LECTURE[step].right
    if isinstance(right, tuple):
        raise TypeError(f"lecture step '{step}' makes {len(right)} claims, not one")
    return right


def moment(scene: Scene, words: Vocabulary) -> Matrix:
    """Return the external moment along the axes: formulas of the scene, or inputs."""
    return given_vector(scene.known["moment"], "moment", words)


def given_vector(given: Given, name: str, words: Vocabulary) -> Matrix:
    """Return a known vector along the axes: its formulas, or the inputs of its name."""
    if given.formulas is not None:
        return Matrix([words.expression(f) for f in given.formulas])
    return words.column(name)


def _force(scene: Scene, words: Vocabulary) -> Matrix:
    if scene.position is None:
        return zeros(3, 1)
    return given_vector(scene.known["force"], "force", words)


def _moving_point(scene: Scene, words: Vocabulary) -> dict[str, Any]:
    given, centre = scene.point.acceleration, scene.body.centre
    if centre is None or given is None:
        raise SceneError("point 'moving' needs body.centre")
    own = Matrix([words.expression(f) for f in centre])
    a_A = given_vector(given, "point_acceleration", words)
    return {"rho_G": rotation(words, scene.body.turned) * own, "a_A": a_A}


def wheel_axes(scene: Scene, words: Vocabulary) -> list[Matrix]:
    """Return each wheel's unit vector along the axes."""
    return [Matrix([words.expression(f) for f in wheel.axis]) for wheel in scene.wheels]


def _wheel_momentum(scene: Scene, words: Vocabulary) -> tuple[Matrix, Matrix]:
    speeds, rates = words.column("wheel_speeds"), words.column("wheel_accelerations")
    h, h_dot = zeros(3, 1), zeros(3, 1)
    for wheel, axis, s, s_dot in zip(
        scene.wheels, wheel_axes(scene, words), speeds, rates, strict=True
    ):
        one = {"C": words.expression(wheel.axial), "a": axis}
        h += stated("wheel_momentum", one | {"s": s})
        h_dot += stated("wheel_momentum", one | {"s": s_dot})
    return h, h_dot


def balance_step(scene: Scene) -> str:
    """Return the lecture step that balances moments in this scene."""
    if scene.wheels:
        return "gyrostat_form"
    return "moving_point_form" if scene.point.kind == "moving" else "general_form"


def quaternion(known: Specialised) -> dict[str, Any]:
    """Return the bindings of the scene's attitude quaternion, omega included."""
    w, x, y, z = known.words.column("attitude")
    return {"q_w": w, "q_v": Matrix([x, y, z]), "omega": known.motion.omega}
