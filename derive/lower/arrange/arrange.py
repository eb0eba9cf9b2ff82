"""From a truth to stages: what is computed, in which order, with what named in between.

Arrangement is where structure is used that no search for common subexpressions can see: the tensor
is inverted once in set-up, a multiple of the identity is taken off it (lecture step
"spherical_part"), wheels are eliminated, turns are undone one by one. Every arrangement is proved
afterwards by putting its program back into the truth.
"""

from collections.abc import Mapping

from sympy import zeros

from derive.lecture.vectors import cross, vector
from derive.lower.arrange.along_body import ALONG_BODY, Bindings, Way
from derive.lower.arrange.attitude import centre_acceleration, coordinate_rates, quaternion_rate
from derive.lower.arrange.constant_tensor import inverse
from derive.lower.arrange.draft import Arrangement, Draft, symmetric
from derive.lower.arrange.staging import staged, varying
from derive.mechanics.specialise import Specialised, balance_step, law, stated, wheel_axes
from derive.mechanics.truth import Truth


def arrange(known: Specialised, fact: Truth) -> tuple[Arrangement, ...]:
    """Return the ways to compute the outputs of ``fact``: along the axes, and along the body's own.

    Along its own axes a body's tensor is constant; if it is along the scene's too, one way is left.
    """
    varies = known.bindings["I"].free_symbols & varying(known)
    if not varies:
        return (_arranged(known, fact, _ALONG_AXES),)
    along_body = ALONG_BODY | {"state_rate": _state_rate_along_body}
    if fact.name in ("acceleration", "state_rate"):
        return (_arranged(known, fact, along_body),)
    return tuple(_arranged(known, fact, ways) for ways in (_ALONG_AXES, along_body))


def _arranged(known: Specialised, fact: Truth, ways: Mapping[str, Way]) -> Arrangement:
    draft = Draft(known, [])
    by_output = ways[fact.name](draft, bindings_of(draft))
    outputs = [v for output in fact.outputs for v in by_output[output.name]]
    return Arrangement(tuple(draft.stages), tuple(outputs))


def bindings_of(draft: Draft) -> Bindings:
    """Return the lecture's bindings, the rates of free coordinates and a varying tensor named.

    The tensor and its rate are one family: they are multiplied out together or not at all.
    """
    bindings = dict(draft.known.bindings)
    bindings |= coordinate_rates(draft, bindings)
    if bindings["I"].free_symbols & varying(draft.known):
        bindings["I"] = symmetric(draft, "I", bindings["I"], "I")
    bindings["I_dot"] = symmetric(draft, "I_dot", bindings["I_dot"], "I")
    return bindings


def _momentum_step(draft: Draft) -> str:
    return "gyrostat_momentum" if draft.known.scene.wheels else "angular_momentum"


def _angular_momentum(draft: Draft, bindings: Bindings) -> Bindings:
    return {"angular_momentum": staged(draft, law(_momentum_step(draft)), bindings)}


def _angular_momentum_rate(draft: Draft, bindings: Bindings) -> Bindings:
    """Return both rates; that of the axes' turning comes from l = I omega (+ h) as it stands."""
    own = staged(draft, law("rate_in_axes"), bindings) + bindings["h_dot"]
    own = draft.column("let", "l_dot", own)
    carried = cross(vector("Omega"), law(_momentum_step(draft)))
    return {"rate_in_axes": own, "rate_absolute": own + staged(draft, carried, bindings)}


def _moment(draft: Draft, bindings: Bindings) -> Bindings:
    step = balance_step(draft.known.scene)
    return {"moment": staged(draft, law(step), bindings)}


def _kinetic_energy(draft: Draft, bindings: Bindings) -> Bindings:
    known = draft.known
    step = "koenig" if "velocity" in known.words else "kinetic_energy_about_point"
    energy = staged(draft, law(step), bindings)
    speeds = known.words.column("wheel_speeds") if known.scene.wheels else []
    for wheel, axis, s in zip(
        known.scene.wheels, wheel_axes(known.scene, known.words), speeds, strict=True
    ):
        one = {"C": known.words.expression(wheel.axial), "a": axis, "s": s}
        energy += stated("wheel_energy", bindings | one)
    return {"kinetic_energy": [energy]}


def _acceleration(draft: Draft, bindings: Bindings) -> Bindings:
    return _forward(draft, bindings)


def _state_rate(draft: Draft, bindings: Bindings) -> Bindings:
    return _kinematics(draft, bindings) | _forward(draft, bindings)


def _state_rate_along_body(draft: Draft, bindings: Bindings) -> Bindings:
    return _kinematics(draft, bindings) | ALONG_BODY["acceleration"](draft, bindings)


def _kinematics(draft: Draft, bindings: Bindings) -> Bindings:
    """Return the rates of free coordinates, position, attitude and velocity."""
    words = draft.known.words
    found = {name: bindings[name] for name in ("coordinate_rates",) if name in bindings}
    if "position_rate" in words:
        found["position_rate"] = words.column("velocity")
    if "attitude_rate" in words:
        found["attitude_rate"] = quaternion_rate(draft)
    if "velocity_rate" in words:
        found["velocity_rate"] = centre_acceleration(draft, bindings)
    return found


def _forward(draft: Draft, bindings: Bindings) -> Bindings:
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
    omega_dot = draft.column("let", "omega_dot", inverse(draft.named, tensor) * tau)
    wheels = [u / C - (a.T * omega_dot)[0] for a, C, u in zip(axes, axial, motors, strict=True)]
    return {"omega_dot": omega_dot, "wheel_accelerations": wheels}


_ALONG_AXES: dict[str, Way] = {
    "angular_momentum": _angular_momentum,
    "angular_momentum_rate": _angular_momentum_rate,
    "moment": _moment,
    "kinetic_energy": _kinetic_energy,
    "acceleration": _acceleration,
    "state_rate": _state_rate,
}
