"""What a scene in short form declares: a single body, its axes, its point and its wheels.

All numbers are exact fractions, all formulas exact trees, all units SI. Vectors are triples along
the scene's axes unless said otherwise; a product of inertia is I_xy = +sum x y dm.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from derive.scene.declaration import (
    Axis,
    Given,
    Input,
    Moving,
    Parameter,
    Sextuple,
    Triple,
    Turning,
)
from derive.scene.formula import Formula
from derive.scene.named import Named
from derive.scene.shape import Portion


@dataclass(frozen=True)
class Axes:
    """The moving axes xyz: body axes, turned from the inertial axes, or Omega given along them."""

    kind: Literal["body", "turned", "given"]
    turned: tuple[Turning, ...]
    quaternion: bool
    fixed_in_body: bool
    angular_velocity: Triple | None


@dataclass(frozen=True)
class Body:
    """The rigid body; inertia (xx, yy, zz, xy, xz, yz) and centre along the axes it is turned to.

    The inertia is about the scene's point; ``axis`` is the axis of symmetry, if there is one.
    """

    kind: Literal["general", "principal", "axisymmetric", "spherical", "rod"]
    mass: Formula | None
    inertia: Sextuple
    centre: Triple | None
    axis: Axis | None
    turned: tuple[Turning, ...]
    spin: Formula | None
    lengths: Mapping[str, Formula]
    look: str = ""
    parts: tuple[Portion, ...] = ()


@dataclass(frozen=True)
class Wheel:
    """A balanced axisymmetric wheel on the carrier: relative speed (a state) and motor torque."""

    name: str
    axis: Triple
    axial: Formula
    speed: Input
    torque: Input


@dataclass(frozen=True)
class Point:
    """The point that moments and inertia refer to; a moving one has a known acceleration."""

    kind: Literal["centre_of_mass", "fixed", "moving"]
    acceleration: Given | None


@dataclass(frozen=True)
class ShortForm:
    """A single body as the user declared it, checked.

    head : what its ``Scene`` says of the whole: name, title, text, form, times and the like
    """

    head: Mapping[str, Any]
    parameters: tuple[Parameter, ...]
    coordinates: tuple[Moving, ...]
    speeds: tuple[Moving, ...]
    inputs: tuple[Moving, ...]
    axes: Axes
    body: Body
    wheels: tuple[Wheel, ...]
    point: Point
    known: Mapping[str, Given]
    position: Given | None
    velocity: Given | None
    warnings: tuple[str, ...]
    named: tuple[Named, ...] = ()

    @property
    def wanted(self) -> tuple[str, ...]:
        """Return the names of the wanted functions."""
        names: tuple[str, ...] = self.head["wanted"]
        return names
