"""A body that turns in the scene's axes, worked out along its own, where its tensor is constant.

Vectors are turned into the body's axes one turn at a time, the lecture's law is used there, and
the result is turned out again. Nothing cancels that does not cancel in the law.
"""

from collections.abc import Callable
from typing import Any

from sympy import Matrix, zeros

from derive.lower.arrange.constant_tensor import inverse
from derive.lower.arrange.draft import Draft
from derive.lower.arrange.staging import staged
from derive.mechanics.specialise import balance_step, law
from derive.mechanics.turning import own_tensor, turn_matrix

Bindings = dict[str, Any]
Way = Callable[[Draft, Bindings], Bindings]


def into_body(draft: Draft, vector: Matrix) -> Matrix:
    """Return a vector's components along the body's own axes."""
    words = draft.known.words
    for turn in draft.known.scene.body.turned:
        back = turn_matrix(turn.axis, words.symbols[turn.coordinate]).T
        vector = draft.column("let", "b", back * vector)
    return vector


def out_of_body(draft: Draft, vector: Matrix) -> Matrix:
    """Return a vector's components along the scene's axes."""
    words = draft.known.words
    for turn in reversed(draft.known.scene.body.turned):
        R = turn_matrix(turn.axis, words.symbols[turn.coordinate])
        vector = draft.column("let", "o", R * vector)
    return vector


def along_body(draft: Draft, bindings: Bindings) -> Bindings:
    """Return the lecture's bindings along the body's axes, which are axes as good as any."""
    known = draft.known
    omega = into_body(draft, bindings["omega"])
    carried = bindings["Omega"].cross(bindings["omega"])
    inner = bindings | {
        "I": own_tensor(known.scene, known.words),
        "I_dot": zeros(3, 3),
        "omega": omega,
        "Omega": omega,
        "omega_dot": into_body(draft, bindings["omega_dot"] + carried),
    }
    if "a_A" in bindings and known.scene.body.centre is not None:
        inner["rho_G"] = Matrix([known.words.expression(f) for f in known.scene.body.centre])
        inner["a_A"] = into_body(draft, bindings["a_A"])
    return inner


def _angular_momentum(draft: Draft, bindings: Bindings) -> Bindings:
    own = staged(draft, law("angular_momentum"), along_body(draft, bindings))
    return {"angular_momentum": out_of_body(draft, own)}


def _angular_momentum_rate(draft: Draft, bindings: Bindings) -> Bindings:
    inner = along_body(draft, bindings)
    absolute = out_of_body(draft, staged(draft, law("general_form"), inner))
    momentum = out_of_body(draft, staged(draft, law("angular_momentum"), inner))
    carried = bindings["Omega"].cross(draft.column("let", "l", momentum))
    return {"rate_in_axes": absolute - carried, "rate_absolute": absolute}


def _moment(draft: Draft, bindings: Bindings) -> Bindings:
    step = balance_step(draft.known.scene)
    own = staged(draft, law(step), along_body(draft, bindings))
    return {"moment": out_of_body(draft, own)}


def _kinetic_energy(draft: Draft, bindings: Bindings) -> Bindings:
    step = "koenig" if "velocity" in draft.known.words else "kinetic_energy_about_point"
    return {"kinetic_energy": [staged(draft, law(step), along_body(draft, bindings))]}


def _forward(draft: Draft, bindings: Bindings) -> Bindings:
    """Return omega_dot from the moment."""
    known = draft.known
    inner = along_body(draft, bindings) | {"omega_dot": zeros(3, 1)}
    rest = staged(draft, law(balance_step(known.scene)), inner)
    tau = draft.column("let", "tau", into_body(draft, bindings["M"]) - rest)
    own = draft.column("let", "a", inverse(draft.named, inner["I"]) * tau)
    carried = bindings["Omega"].cross(bindings["omega"])
    return {"omega_dot": out_of_body(draft, own) - carried}


ALONG_BODY: dict[str, Way] = {
    "angular_momentum": _angular_momentum,
    "angular_momentum_rate": _angular_momentum_rate,
    "moment": _moment,
    "kinetic_energy": _kinetic_energy,
    "acceleration": _forward,
}
