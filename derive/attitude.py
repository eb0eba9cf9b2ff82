"""Rates of attitude and position from velocities: turns undone one by one, quaternions."""

from typing import Any

from sympy import Expr, Matrix, zeros

from derive.draft import Draft
from derive.motion import PLACE, rotation, turn_matrix, unit_vector
from derive.scene import Turn


def coordinate_rates(draft: Draft, bindings: dict[str, Any]) -> dict[str, Any]:
    """Return the free coordinates' rates, and what they make of Omega and of the tensor's rate.

    Seen from the axes after the second of three turns, the third turns about a coordinate axis,
    the second too, and the first has no part along the second: three equations in a row.
    """
    scene, words = draft.known.scene, draft.known.words
    if draft.known.motion.closure is None:
        return {}
    first, second, third = turns = (*scene.axes.turned, *scene.body.turned)
    omega = _seen_after_second(draft, turns, len(scene.axes.turned))
    e = turn_matrix(second.axis, words.symbols[second.coordinate]).T * unit_vector(first.axis)
    k2, k3 = PLACE[second.axis], PLACE[third.axis]
    r = 3 - k2 - k3
    rate = draft.named("cut", "rate", omega[r] / e[r])
    carried = draft.named("cut", "carried", e[k3] * rate)
    rates = {
        first.coordinate: rate,
        second.coordinate: omega[k2],
        third.coordinate: omega[k3] - carried,
    }
    named = words["coordinate_rates"].components
    found = [rates[name.removesuffix("_dot")] for name in named]
    unknowns = dict(zip(words.column("coordinate_rates"), found, strict=True))
    seen = {name: bindings[name].subs(unknowns) for name in ("I_dot", "Omega")}
    if len(scene.axes.turned) == 2:
        seen["Omega"] = zeros(3, 1)
        seen["Omega"][r], seen["Omega"][k2], seen["Omega"][k3] = omega[r], omega[k2], carried
    return seen | {"coordinate_rates": found}


def _seen_after_second(draft: Draft, turns: tuple[Turn, ...], axes_after: int) -> Matrix:
    """Return omega along the axes after the second turn."""
    words = draft.known.words
    omega = words.column("omega")
    if axes_after == 3:
        back = turn_matrix(turns[2].axis, words.symbols[turns[2].coordinate])
        return draft.column("cut", "u", back * omega)
    if axes_after == 1:
        on = turn_matrix(turns[1].axis, words.symbols[turns[1].coordinate]).T
        return draft.column("cut", "u", on * omega)
    return omega


def quaternion_rate(draft: Draft) -> list[Expr]:
    """Return the rate of the attitude quaternion: q (0, omega / 2)."""
    w, x, y, z = draft.known.words.column("attitude")
    half = draft.column("cut", "half", draft.known.motion.omega / 2)
    vector = Matrix([x, y, z])
    return [-(vector.T * half)[0], *(w * half + vector.cross(half))]


def centre_acceleration(draft: Draft, bindings: dict[str, Any]) -> Matrix:
    """Return the rate of the velocity along the inertial axes from the force along the body's."""
    f = draft.column("let", "f", bindings["F"] / bindings["m"])
    if "attitude" not in draft.known.words:
        return rotation(draft.known.words, draft.known.scene.axes.turned) * f
    w, x, y, z = draft.known.words.column("attitude")
    vector = Matrix([x, y, z])
    t = draft.column("let", "t", draft.column("let", "d", 2 * vector).cross(f))
    return f + w * t + vector.cross(t)
