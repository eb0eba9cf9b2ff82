"""What a scene's quantities are called: parameters, states, inputs and outputs, in canonical order.

Every component has a SymPy symbol named by its place, not by the user's word for it, so nothing
that SymPy does can depend on how the user calls things.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import sympy
from sympy import Abs, Expr, Matrix, Rational, Symbol, pi

from derive.program.program import Quantity
from derive.scene import Given, Input, Scene, SceneError
from derive.scene.declaration import Moving
from derive.scene.escape import brief
from derive.scene.formula import Formula
from derive.scene.functions import FUNCTIONS, PLAIN

XYZ = ("x", "y", "z")
ANY = (Fraction(-1), Fraction(1))


@dataclass(frozen=True)
class Vocabulary:
    """The quantities of a scene by role; an input of one function may be an output of another."""

    parameters: tuple[Quantity, ...]
    states: tuple[Quantity, ...]
    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    numbers: Mapping[str, Fraction]
    symbols: Mapping[str, Symbol] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Quantity:
        return next(q for q in self.every() if q.name == name)

    def __contains__(self, name: str) -> bool:
        return any(q.name == name for q in self.every())

    def every(self) -> tuple[Quantity, ...]:
        """Return all quantities, parameters first."""
        return self.parameters + self.states + self.inputs + self.outputs

    def column(self, name: str) -> Matrix:
        """Return the symbols of a quantity's components as a column."""
        return Matrix([self.symbols[c] for c in self[name].components])

    def expression(self, formula: Formula) -> Expr:
        """Return a scene's formula in these symbols."""
        if formula.operator == "symbol" and formula.name == "pi":
            return pi
        if formula.operator == "symbol":
            number = self.numbers.get(formula.name)
            return self.symbols[formula.name] if number is None else rational(number)
        if formula.operator == "number":
            return rational(formula.number)
        if formula.operator == "power":
            return self.expression(formula.operands[0]) ** rational(formula.number)
        found = _OPERATORS[formula.operator](*map(self.expression, formula.operands))
        if formula.operator == "sqrt" and found.has(Abs):
            rule = "is of a square, so that its sign is lost and its slope jumps"
            raise SceneError(f"the root '{brief(formula)}' {rule}; write it without the root")
        return found


def rational(value: Fraction) -> Rational:
    """Return an exact number as SymPy's."""
    return Rational(value.numerator, value.denominator)


_OPERATORS: Mapping[str, Any] = {
    **PLAIN,
    **{name: getattr(sympy, name) for name in FUNCTIONS},
}
"""SymPy calls its functions as a formula does."""


def vocabulary(scene: Scene) -> Vocabulary:
    """Return the quantities that ``scene`` speaks of."""
    parameters = tuple(
        _scalar(p.name, p.unit, p.low, p.high, p.meaning)
        for p in scene.parameters
        if p.value is None
    )
    numbers = {p.name: p.value for p in scene.parameters if p.value is not None}
    states, inputs, outputs = _states(scene), _inputs(scene), _outputs(scene)
    names = [c for q in (*parameters, *states, *inputs, *outputs) for c in q.components]
    symbols = {
        name: Symbol(f"s{place:04d}", real=True) for place, name in enumerate(dict.fromkeys(names))
    }
    return Vocabulary(parameters, states, inputs, outputs, numbers, symbols)


def _scalar(name: str, unit: str, low: Fraction, high: Fraction, meaning: str) -> Quantity:
    return Quantity(name, (name,), (), unit, "", low, high, meaning)


def _of(entry: Moving | Input) -> Quantity:
    return _scalar(entry.name, entry.unit, entry.low, entry.high, entry.meaning)


def _vector(name: str, unit: str, frame: str, given: Given | None, meaning: str) -> Quantity:
    low, high = (given.low, given.high) if given else ANY
    return Quantity(name, tuple(f"{name}_{a}" for a in XYZ), (3,), unit, frame, low, high, meaning)


def axes_name(scene: Scene) -> str:
    """Return the name of the axes that vectors are resolved along: B (body) or xyz."""
    return "B" if scene.axes.fixed_in_body else "xyz"


def free_coordinates(scene: Scene) -> tuple[str, ...]:
    """Return the coordinates whose motion is unknown."""
    return tuple(c.name for c in scene.coordinates if c.free)


def omega_is_given(scene: Scene) -> bool:
    """Tell whether omega is a variable of its own and not made of prescribed rates."""
    alone = scene.axes.kind == "body" and not _by_formulas(scene.known["angular_velocity"])
    return alone or bool(free_coordinates(scene))


def _by_formulas(given: Given | None) -> bool:
    """Tell whether a known vector is made of other quantities, and so is none of its own."""
    return given is not None and given.formulas is not None


def _states(scene: Scene) -> tuple[Quantity, ...]:
    states = [
        _scalar(c.name, c.unit, c.low, c.high, c.meaning) for c in scene.coordinates if c.free
    ]
    if scene.position is not None:
        states.append(
            _vector("position", "m", "N", scene.position, "position of the centre of mass")
        )
    if scene.axes.quaternion:
        parts = tuple(f"attitude_{part}" for part in ("w", *XYZ))
        says = "attitude quaternion, scalar first, body to inertial, |q| = 1"
        states.append(Quantity("attitude", parts, (4,), "1", "N from B", *ANY, says))
    if scene.velocity is not None:
        states.append(
            _vector("velocity", "m/s", "N", scene.velocity, "velocity of the centre of mass")
        )
    if omega_is_given(scene):
        given = scene.known.get("angular_velocity")
        says = "angular velocity of the body in the inertial frame"
        states.append(_vector("omega", "rad/s", axes_name(scene), given, says))
    return (*states, *_wheels(scene, "wheel_speeds", "rad/s", "speed relative to the carrier"))


def _wheels(scene: Scene, name: str, unit: str, says: str) -> tuple[Quantity, ...]:
    if not scene.wheels:
        return ()
    each = [w.torque if name == "wheel_torques" else w.speed for w in scene.wheels]
    dot = "_dot" if name == "wheel_accelerations" else ""
    low, high = min(i.low for i in each), max(i.high for i in each)
    parts = tuple(i.name + dot for i in each)
    return (Quantity(name, parts, (len(each),), unit, "wheel axes", low, high, f"wheel {says}"),)


def _inputs(scene: Scene) -> tuple[Quantity, ...]:
    inputs: list[Quantity] = []
    for c in scene.coordinates:
        if not c.free:
            inputs += [_of(c), *map(_of, c.given)]
    for s in scene.speeds:
        inputs += [_of(s), *map(_of, s.given)]
    inputs += map(_of, scene.inputs)
    axes, known = axes_name(scene), scene.known
    if omega_is_given(scene) and not _by_formulas(known["angular_acceleration"]):
        given = scene.known.get("angular_acceleration")
        says = "rate of the components of omega along the axes"
        inputs.append(_vector("omega_dot", "rad/s^2", axes, given, says))
    inputs += _wheels(
        scene, "wheel_accelerations", "rad/s^2", "acceleration relative to the carrier"
    )
    if scene.point.kind == "moving" and not _by_formulas(scene.point.acceleration):
        says = "acceleration of the moving point in the inertial frame"
        inputs.append(_vector("point_acceleration", "m/s^2", axes, scene.point.acceleration, says))
    if scene.position is not None and not _by_formulas(known["force"]):
        inputs.append(_vector("force", "N", axes, known["force"], "resultant external force"))
    if not _by_formulas(known["moment"]):
        inputs.append(_moment(scene))
    return (*inputs, *_wheels(scene, "wheel_torques", "N m", "torque of the motor on the wheel"))


def _moment(scene: Scene) -> Quantity:
    says = f"external moment about the {scene.point.kind.replace('_', ' ')}"
    says = says.replace("fixed", "fixed point").replace("moving", "moving point")
    return _vector("moment", "N m", axes_name(scene), scene.known["moment"], says)


def _outputs(scene: Scene) -> tuple[Quantity, ...]:
    axes = axes_name(scene)
    outputs = [
        _vector("angular_momentum", "kg m^2/s", axes, None, "angular momentum"),
        _vector("rate_in_axes", "N m", axes, None, "rate of angular momentum seen from the axes"),
        _vector(
            "rate_absolute",
            "N m",
            axes,
            None,
            "rate of angular momentum seen from the inertial frame",
        ),
        Quantity("kinetic_energy", ("kinetic_energy",), (), "J", "", None, None, "kinetic energy"),
    ]
    if _by_formulas(scene.known["moment"]):
        outputs.append(_moment(scene))
    free = free_coordinates(scene)
    if free:
        parts = tuple(f"{name}_dot" for name in free)
        says = "rates of " + ", ".join(free)
        outputs.append(Quantity("coordinate_rates", parts, (len(free),), "rad/s", "", *ANY, says))
    if scene.position is not None:
        outputs.append(_vector("position_rate", "m/s", "N", None, "rate of the position"))
        outputs.append(_vector("velocity_rate", "m/s^2", "N", None, "rate of the velocity"))
    if scene.axes.quaternion:
        parts = tuple(f"attitude_rate_{part}" for part in ("w", *XYZ))
        outputs.append(
            Quantity(
                "attitude_rate",
                parts,
                (4,),
                "1/s",
                "N from B",
                *ANY,
                "rate of the attitude quaternion",
            )
        )
    return tuple(outputs)
