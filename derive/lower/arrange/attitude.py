"""Rates of attitude and position from velocities: turns undone one by one, quaternions."""

from typing import Any

from sympy import Expr, Matrix, zeros

from derive.lower.arrange.draft import Draft
from derive.mechanics.turning import PLACE, rotation, turn_matrix, unit_vector
from derive.scene import Turning


def coordinate_rates(draft: Draft, bindings: dict[str, Any]) -> dict[str, Any]:
    """Return the free coordinates' rates, and what they make of Omega and of the tensor's rate."""
    scene, words = draft.known.scene, draft.known.words
    if draft.known.motion.closure is None:
        return {}
    turns, axes_after = (*scene.axes.turned, *scene.body.turned), len(scene.axes.turned)
    if axes_after == 1:
        rates, _ = _rates(draft, turns[::-1], _turned(draft, turns[1]), words.column("omega"))
        seen = {}
    else:
        omega = _before_last(draft, turns[2], axes_after)
        rates, Omega = _rates(draft, turns, _turned(draft, turns[1]).T, omega)
        seen = {"Omega": Omega} if axes_after == 2 else {}
    named = words["coordinate_rates"].components
    found = [rates[name.removesuffix("_dot")] for name in named]
    unknowns = dict(zip(words.column("coordinate_rates"), found, strict=True))
    made = {name: bindings[name].subs(unknowns) for name in ("I_dot", "Omega")}
    return made | seen | {"coordinate_rates": found}


def _rates(
    draft: Draft, turns: tuple[Turning, ...], R: Matrix, omega: Matrix
) -> tuple[dict[str, Expr], Matrix]:
    """Return the rates of three turns, and omega less the last one's share.

    Seen from the axes between the second and the last turn, the last turns about a coordinate
    axis, the second too, and the first, carried there by ``R``, has no part along the second:
    three equations in a row. The same holds with the turns in the opposite order.
    """
    first, second, last = turns
    e = R * unit_vector(first.axis)
    k2, k3 = PLACE[second.axis], PLACE[last.axis]
    r = 3 - k2 - k3
    rate = draft.named("cut", "rate", omega[r] / e[r])
    carried = draft.named("cut", "carried", e[k3] * rate)
    rates = {
        first.coordinate: rate,
        second.coordinate: omega[k2],
        last.coordinate: omega[k3] - carried,
    }
    less = zeros(3, 1)
    less[r], less[k2], less[k3] = omega[r], omega[k2], carried
    return rates, less


def _turned(draft: Draft, turn: Turning) -> Matrix:
    return turn_matrix(turn.axis, draft.known.words.symbols[turn.coordinate])


def _before_last(draft: Draft, last: Turning, axes_after: int) -> Matrix:
    """Return omega along the axes before the last turn."""
    omega = draft.known.words.column("omega")
    return draft.column("cut", "u", _turned(draft, last) * omega) if axes_after == 3 else omega


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
