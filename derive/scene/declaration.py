"""The scalars, ranges and turns that a scene declares, as plain values.

All numbers are exact fractions, all formulas exact trees, all units SI. Vectors are triples along
the scene's axes unless said otherwise; a product of inertia is I_xy = +sum x y dm.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from derive.scene.formula import Formula

Axis = Literal["x", "y", "z"]
AXES: tuple[Axis, ...] = ("x", "y", "z")
Kind = Literal["coordinate", "speed", "input"]
Triple = tuple[Formula, Formula, Formula]
Sextuple = tuple[Formula, Formula, Formula, Formula, Formula, Formula]
ANY = (Fraction(-1), Fraction(1))
"""The range of what none is given for."""


class DeriveError(Exception):
    """What is refused or cannot be done; the sentence names the quantity, the rule and the value.

    Every error that this package raises at what it is given is one of these.
    """


class SceneError(DeriveError, ValueError):
    """A scene, or a value given for it, that breaks a rule; the sentence names what and which."""


@dataclass(frozen=True)
class Parameter:
    """A constant of the scene; with a ``value`` it is a number in the code, not an argument."""

    name: str
    unit: str
    low: Fraction
    high: Fraction
    meaning: str
    value: Fraction | None


@dataclass(frozen=True)
class Input:
    """A scalar that varies with time and enters from outside."""

    name: str
    unit: str
    low: Fraction
    high: Fraction
    meaning: str


@dataclass(frozen=True)
class Moving:
    """A coordinate, speed or input; a rate is an input, a formula, or None where it is unknown.

    Of an input no rate is known, of a free coordinate or speed the last rate is an unknown. A free
    coordinate without a rate has one that the angular velocity of its body fixes.
    A state is summed up from its rate: all that is free, and coordinates that a formula moves. What
    was declared with ``components`` says of which ``vector`` it is one. ``highest`` is what its
    highest rate is called, "" if that follows from its name; what is ``dependent`` follows others
    by a constraint.
    """

    name: str
    unit: str
    low: Fraction
    high: Fraction
    meaning: str
    kind: Kind
    free: bool
    state: bool
    rate: Input | Formula | None
    acceleration: Input | Formula | None
    vector: str = ""
    highest: str = ""
    dependent: bool = False

    @property
    def unknown(self) -> str:
        """Return the name of its highest rate: x_ddot of a coordinate, u_dot of a speed."""
        return self.highest or f"{self.name}_{'ddot' if self.kind == 'coordinate' else 'dot'}"

    @property
    def answer(self) -> str:
        """Return what answers with its highest rate: that alone, or the vector that holds it."""
        return self.of_vector(self.unknown)

    def of_vector(self, rate: str) -> str:
        """Return the rate of its vector that holds a rate of its own; the rate if it has none."""
        return self.vector + rate.removeprefix(self.name) if self.vector else rate

    @property
    def given(self) -> tuple[Input, ...]:
        """Return the rate and the acceleration where they are inputs."""
        return tuple(i for i in (self.rate, self.acceleration) if isinstance(i, Input))


@dataclass(frozen=True)
class Turning:
    """One turn about an axis of the axes so far, through a formula."""

    axis: Axis
    angle: Formula

    @property
    def coordinate(self) -> str:
        """Return the coordinate that the angle is, "" if it is another formula."""
        return self.angle.name if self.angle.operator == "symbol" else ""


@dataclass(frozen=True)
class Given:
    """A known vector: formulas, or else a range for three fresh inputs."""

    low: Fraction | None
    high: Fraction | None
    formulas: Triple | None
