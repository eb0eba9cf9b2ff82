"""From the lecture and a scene to the equations which that scene needs, and no others.

A ``Truth`` is a wanted function as the lecture states it: equations, linear in the unknowns, that
hold between inputs and outputs. How to compute the outputs cheaply is left to ``arrange``; the
reference solves the truths as they stand, and a program is right if it satisfies them.
"""

from dataclasses import dataclass
from typing import Any

from sympy import Expr, Matrix, Rational, Symbol

from derive.mechanics.specialise import Specialised, balance_step, quaternion, stated, wheel_axes
from derive.mechanics.turning import rotation
from derive.program.program import Quantity
from derive.scene import SceneError


@dataclass(frozen=True)
class Truth:
    """``residuals`` are zero, linear in ``unknowns``; the outputs' components are among these."""

    name: str
    says: str
    outputs: tuple[Quantity, ...]
    unknowns: tuple[Symbol, ...]
    residuals: tuple[Expr, ...]
    steps: tuple[str, ...]


def truth(known: Specialised, wanted: str) -> Truth:
    """Return what the lecture says of a wanted function."""
    return _TRUTHS[wanted](known)


def _explicit(
    known: Specialised, name: str, says: str, parts: dict[str, Any], steps: tuple[str, ...]
) -> Truth:
    """Return the truth of outputs that the lecture gives outright."""
    words = known.words
    unknowns = [s for output in parts for s in words.column(output)]
    values = [v for value in parts.values() for v in Matrix([value])]
    residuals = [v - s for s, v in zip(unknowns, values, strict=True)]
    outputs = tuple(words[output] for output in parts)
    rates, closure, more = _closure(known)
    if set(rates) & {s for r in residuals for s in r.free_symbols}:
        unknowns, residuals, steps = unknowns + rates, residuals + closure, (*steps, *more)
    return Truth(name, says, outputs, tuple(unknowns), tuple(residuals), steps)


def _angular_momentum(known: Specialised) -> Truth:
    step = "gyrostat_momentum" if known.scene.wheels else "angular_momentum"
    says = "Angular momentum from the angular velocity."
    return _explicit(
        known, "angular_momentum", says, {"angular_momentum": stated(step, known.bindings)}, (step,)
    )


def _angular_momentum_rate(known: Specialised) -> Truth:
    own = stated("rate_in_axes", known.bindings) + known.bindings["h_dot"]
    momentum = stated(
        "gyrostat_momentum" if known.scene.wheels else "angular_momentum", known.bindings
    )
    absolute = stated("transport_theorem", dict(known.bindings) | {"l_dot": own, "l": momentum})
    says = "Rate of the angular momentum, seen from the axes and from the inertial frame."
    steps = ("rate_in_axes", "transport_theorem")
    return _explicit(
        known,
        "angular_momentum_rate",
        says,
        {"rate_in_axes": own, "rate_absolute": absolute},
        steps,
    )


def _moment(known: Specialised) -> Truth:
    step = balance_step(known.scene)
    says = "External moment that the motion needs (inverse dynamics)."
    return _explicit(known, "moment", says, {"moment": stated(step, known.bindings)}, (step,))


def _kinetic_energy(known: Specialised) -> Truth:
    if known.scene.point.kind == "moving":
        rule = "needs a fixed point or the mass centre, not 'moving'"
        raise SceneError(f"kinetic_energy {rule}")
    step = "koenig" if "velocity" in known.words else "kinetic_energy_about_point"
    energy: Expr = stated(step, known.bindings)
    steps: tuple[str, ...] = (step,)
    if known.scene.wheels:
        energy, steps = energy + _wheel_energy(known), (step, "wheel_energy")
    return _explicit(known, "kinetic_energy", "Kinetic energy.", {"kinetic_energy": energy}, steps)


def _wheel_energy(known: Specialised) -> Expr:
    total: Expr = Rational(0)
    for wheel, axis, s in zip(
        known.scene.wheels,
        wheel_axes(known.scene, known.words),
        known.words.column("wheel_speeds"),
        strict=True,
    ):
        bindings = {"C": known.words.expression(wheel.axial), "a": axis, "s": s}
        total += stated("wheel_energy", dict(known.bindings) | bindings)
    return total


def _balance(known: Specialised) -> tuple[list[Symbol], list[Expr], list[str]]:
    """Return unknowns, residuals and steps of the rotational balance, wheels included."""
    words, step = known.words, balance_step(known.scene)
    unknowns = list(words.column("omega_dot"))
    residuals = list(stated(step, known.bindings) - known.bindings["M"])
    if not known.scene.wheels:
        return unknowns, residuals, [step]
    unknowns += list(words.column("wheel_accelerations"))
    for wheel, axis, s_dot in zip(
        known.scene.wheels,
        wheel_axes(known.scene, words),
        words.column("wheel_accelerations"),
        strict=True,
    ):
        one = {"C": words.expression(wheel.axial), "a": axis, "s_dot": s_dot}
        motor = stated("wheel_equation", dict(known.bindings) | one)
        residuals.append(motor - words.symbols[wheel.torque.name])
    return unknowns, residuals, [step, "wheel_equation"]


def _needs_free_motion(known: Specialised, wanted: str) -> None:
    if "omega_dot" not in known.words:
        raise SceneError(f"{wanted} needs a free motion, but every rate is prescribed")


def _closure(known: Specialised) -> tuple[list[Symbol], list[Expr], list[str]]:
    """Return the rates of the free coordinates as unknowns that agree with omega."""
    closure = known.motion.closure
    if closure is None:
        return [], [], []
    rates = list(known.words.column("coordinate_rates"))
    if len(rates) != 3:
        rule = f"fixes the rates of three free coordinates, found {len(rates)}"
        raise SceneError(f"omega {rule}")
    return rates, list(closure), ["angular_velocities_add"]


def _acceleration(known: Specialised) -> Truth:
    _needs_free_motion(known, "acceleration")
    unknowns, residuals, steps = _balance(known)
    rates, closure, more = _closure(known)
    names = ["omega_dot"] + (["wheel_accelerations"] if known.scene.wheels else [])
    return Truth(
        "acceleration",
        "Rate of the angular velocity from the moment (forward dynamics).",
        tuple(known.words[name] for name in names),
        (*unknowns, *rates),
        (*residuals, *closure),
        (*steps, *more),
    )


def _state_rate(known: Specialised) -> Truth:
    _needs_free_motion(known, "state_rate")
    words = known.words
    unknowns, residuals, steps = _closure(known)
    names = ["coordinate_rates"] if unknowns else []
    for name, step, residual in _kinematics(known):
        names.append(name)
        unknowns += list(words.column(name))
        residuals += list(residual)
        steps += step
    rotational = _balance(known)
    names += ["omega_dot"] + (["wheel_accelerations"] if known.scene.wheels else [])
    return Truth(
        "state_rate",
        "Rate of the state from the state and the inputs (forward dynamics).",
        tuple(words[name] for name in names),
        (*unknowns, *rotational[0]),
        (*residuals, *rotational[1]),
        tuple(dict.fromkeys([*steps, *rotational[2]])),
    )


def _kinematics(known: Specialised) -> list[tuple[str, list[str], Matrix]]:
    """Return name, steps and residual of the rates of position, attitude and velocity."""
    words = known.words
    found: list[tuple[str, list[str], Matrix]] = []
    if "position_rate" in words:
        found.append(
            ("position_rate", [], words.column("velocity") - words.column("position_rate"))
        )
    if "attitude_rate" in words:
        steps = ["quaternion_rate_scalar", "quaternion_rate_vector"]
        right = [v for step in steps for v in Matrix([stated(step, quaternion(known))])]
        found.append(("attitude_rate", steps, Matrix(right) - words.column("attitude_rate")))
    if "velocity_rate" in words:
        a_G = words.column("velocity_rate")
        force = known.bindings["F"]
        if "attitude" in words:
            force = stated("rotation_of_vector", quaternion(known) | {"v": force})
        else:
            force = rotation(words, known.scene.axes.turned) * force
        steps = ["mass_centre_motion"] + (["rotation_of_vector"] if "attitude" in words else [])
        found.append(
            (
                "velocity_rate",
                steps,
                stated("mass_centre_motion", dict(known.bindings) | {"a_G": a_G}) - force,
            )
        )
    return found


_TRUTHS = {
    "angular_momentum": _angular_momentum,
    "angular_momentum_rate": _angular_momentum_rate,
    "moment": _moment,
    "kinetic_energy": _kinetic_energy,
    "acceleration": _acceleration,
    "state_rate": _state_rate,
}
