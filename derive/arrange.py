"""From a truth to stages: what is computed, in which order, with what named in between.

Arrangement is where structure is used that no search for common subexpressions can see: the tensor
is inverted once in set-up, a multiple of the identity is taken off it (lecture step
"spherical_part"), wheels are eliminated, turns are undone one by one. Every arrangement is proved
afterwards by putting its program back into the truth.
"""

from collections.abc import Mapping
from typing import Any

from sympy import Matrix, Symbol, eye, zeros

from derive.attitude import centre_acceleration, coordinate_rates, quaternion_rate
from derive.draft import Arrangement, Draft, symmetric
from derive.inverse import inverse
from derive.motion import own_tensor, rotation
from derive.specialise import Specialised, balance_step, law, stated, wheel_axes
from derive.truth import Truth
from derive.vectors import COMPONENTS, Expression, components, cross, vector


def arrange(known: Specialised, fact: Truth) -> Arrangement:
    """Return how to compute the outputs of ``fact``."""
    draft = Draft(known, [], [])
    by_output = _ARRANGED[fact.name](draft)
    outputs = [v for output in fact.outputs for v in by_output[output.name]]
    return Arrangement(tuple(draft.stages), tuple(outputs), tuple(draft.positive))


def staged(draft: Draft, expression: Expression, bindings: Mapping[str, Any]) -> Any:
    """Return the components of a lecture expression, naming the second factor of every product."""
    if expression.operator not in ("cross", "dot", "apply", "add", "negate", "scale"):
        return components(expression, bindings)
    inner = dict(bindings)
    first, *rest = expression.operands
    left = staged(draft, first, bindings)
    if expression.operator == "cross" and left == bindings["omega"]:
        inner["I"] = without_spherical_part(draft.known, bindings["I"])
    operands = [left, *(staged(draft, operand, inner) for operand in rest)]
    if expression.operator in ("cross", "dot"):
        operands[1] = draft.column("let", "l", operands[1])
    return COMPONENTS[expression.operator](*operands)


def without_spherical_part(known: Specialised, tensor: Matrix) -> Matrix:
    """Return the tensor less the multiple of the identity that leaves the fewest moments.

    omega x (I omega) does not change, by the lecture step "spherical_part"; near a sphere its
    cancellation is gone and on the way there are fewer operations.
    """
    if tensor.free_symbols & _varying(known):
        return tensor
    moments = [tensor[1, 1], tensor[0, 0], tensor[2, 2]]
    best = max(moments, key=lambda c: sum((m - c).expand() == 0 for m in moments))
    return tensor - best * eye(3)


def _varying(known: Specialised) -> set[Symbol]:
    words = known.words
    fixed = {words.symbols[c] for q in words.parameters for c in q.components}
    return set(words.symbols.values()) - fixed


def _bindings(draft: Draft) -> dict[str, Any]:
    """Return the lecture's bindings, the rates of free coordinates and a varying tensor named."""
    bindings = dict(draft.known.bindings)
    bindings |= coordinate_rates(draft, bindings)
    if bindings["I"].free_symbols & _varying(draft.known):
        bindings["I"] = symmetric(draft, "I", bindings["I"])
    bindings["I_dot"] = symmetric(draft, "I_dot", bindings["I_dot"])
    return bindings


def _momentum_step(draft: Draft) -> str:
    return "gyrostat_momentum" if draft.known.scene.wheels else "angular_momentum"


def _angular_momentum(draft: Draft) -> dict[str, Any]:
    return {"angular_momentum": staged(draft, law(_momentum_step(draft)), _bindings(draft))}


def _angular_momentum_rate(draft: Draft) -> dict[str, Any]:
    """Return both rates; that of the axes' turning comes from l = I omega (+ h) as it stands."""
    bindings = _bindings(draft)
    own = staged(draft, law("rate_in_axes"), bindings) + bindings["h_dot"]
    own = draft.column("let", "l_dot", own)
    carried = cross(vector("Omega"), law(_momentum_step(draft)))
    return {"rate_in_axes": own, "rate_absolute": own + staged(draft, carried, bindings)}


def _moment(draft: Draft) -> dict[str, Any]:
    step = balance_step(draft.known.scene)
    return {"moment": staged(draft, law(step), _bindings(draft))}


def _kinetic_energy(draft: Draft) -> dict[str, Any]:
    known, bindings = draft.known, _bindings(draft)
    step = "koenig" if "velocity" in known.words else "kinetic_energy_about_point"
    energy = staged(draft, law(step), bindings)
    speeds = known.words.column("wheel_speeds") if known.scene.wheels else []
    for wheel, axis, s in zip(
        known.scene.wheels, wheel_axes(known.scene, known.words), speeds, strict=True
    ):
        one = {"C": known.words.expression(wheel.axial), "a": axis, "s": s}
        energy += stated("wheel_energy", bindings | one)
    return {"kinetic_energy": [energy]}


def _acceleration(draft: Draft) -> dict[str, Any]:
    return _forward(draft, _bindings(draft))


def _state_rate(draft: Draft) -> dict[str, Any]:
    bindings, words = _bindings(draft), draft.known.words
    found = {name: bindings[name] for name in ("coordinate_rates",) if name in bindings}
    if "position_rate" in words:
        found["position_rate"] = words.column("velocity")
    if "attitude_rate" in words:
        found["attitude_rate"] = quaternion_rate(draft)
    if "velocity_rate" in words:
        found["velocity_rate"] = centre_acceleration(draft, bindings)
    return found | _forward(draft, bindings)


def _forward(draft: Draft, bindings: dict[str, Any]) -> dict[str, Any]:
    """Return omega_dot (and wheel accelerations) from the moment: solve the balance for them."""
    known = draft.known
    at_rest = bindings | {"omega_dot": zeros(3, 1), "h_dot": zeros(3, 1)}
    rest = staged(draft, law(balance_step(known.scene)), at_rest)
    torques, tensor = zeros(3, 1), bindings["I"]
    axes = wheel_axes(known.scene, known.words)
    axial = [known.words.expression(wheel.axial) for wheel in known.scene.wheels]
    motors = [known.words.symbols[wheel.torque.name] for wheel in known.scene.wheels]
    for a, C, u in zip(axes, axial, motors, strict=True):
        torques += a * u
        tensor = tensor - C * a * a.T
    tau = draft.column("let", "tau", bindings["M"] - torques - rest)
    omega_dot = draft.column("let", "omega_dot", _solved(draft, tensor, tau))
    wheels = [u / C - (a.T * omega_dot)[0] for a, C, u in zip(axes, axial, motors, strict=True)]
    return {"omega_dot": omega_dot, "wheel_accelerations": wheels}


def _solved(draft: Draft, tensor: Matrix, tau: Matrix) -> Matrix:
    """Return the vector that ``tensor`` takes to ``tau``.

    A tensor that varies along the axes is constant along the body's own: solve there.
    """
    if not draft.known.bindings["I"].free_symbols & _varying(draft.known):
        return inverse(draft, tensor) * tau
    R = rotation(draft.known.words, draft.known.scene.body.turned)
    own = inverse(draft, own_tensor(draft.known.scene, draft.known.words))
    along_body = draft.column("let", "b", R.T * tau)
    return R * draft.column("let", "a", own * along_body)


_ARRANGED = {
    "angular_momentum": _angular_momentum,
    "angular_momentum_rate": _angular_momentum_rate,
    "moment": _moment,
    "kinetic_energy": _kinetic_energy,
    "acceleration": _acceleration,
    "state_rate": _state_rate,
}
