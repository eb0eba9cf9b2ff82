"""What a scene declares, as plain values: frames, bodies, loads, and the answers wanted.

Formulas are exact trees, units SI. Triples lie along the axes of the frame that stands with them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal

from derive.scene.constraint import Constraint
from derive.scene.declaration import Axis, Given, Moving, Parameter, Triple, Turning
from derive.scene.formula import ZERO, Formula
from derive.scene.shape import Portion

INERTIAL = "inertial"
LEFT_OVER = "0 where motion is steady"  # said of ``steady``, no answer but a measure
Entries = tuple[Formula | None, ...]


@dataclass(frozen=True)
class Rolling:
    """The particle of a body that is at rest, as seen from the frame's origin."""

    body: str
    at: Triple


@dataclass(frozen=True)
class Frame:
    """Axes carried by a parent: how they turn in it, and where their origin is or how it moves.

    attitude : the name of their quaternion, "" if they have none
    """

    name: str
    parent: str
    turned: tuple[Turning, ...] = ()
    angular_velocity: Triple | None = None
    attitude: str = ""
    origin: Triple = (ZERO, ZERO, ZERO)
    velocity: Triple | None = None
    acceleration: Triple | None = None
    rolls: Rolling | None = None


@dataclass(frozen=True)
class Member:
    """A rigid body in a frame: inertia (xx, yy, zz, xy, xz, yz) about its mass centre, own axes.

    None stands for data that the user does not know. ``look`` is the shape, for people, ``parts``
    what is drawn of it, along the body's own axes;
    ``spin_axis`` a unit vector along the frame, of a body that spins about none of its axes;
    ``given`` the inertia as the user gave it, if that is about the frame's origin.
    """

    name: str
    frame: str
    mass: Formula | None
    inertia: Entries
    centre: Triple
    axis: Axis | None = None
    turned: tuple[Turning, ...] = ()
    spin: Formula | None = None
    axial_speed: Formula | None = None
    angular_velocity: Triple | None = None
    look: str = ""
    lengths: Mapping[str, Formula] = field(default_factory=dict)
    spin_axis: Triple | None = None
    given: Entries = ()
    parts: tuple[Portion, ...] = ()


@dataclass(frozen=True)
class Force:
    """A force and a couple at a point, on a body, and opposite, there or at ``other``, on one."""

    name: str
    on: str
    against: str
    frame: str
    at: Triple
    along: str
    force: Triple
    couple: Triple
    other: tuple[str, Triple] | None = None


@dataclass(frozen=True)
class Weight:
    """Gravity on bodies, along the axes of a frame."""

    name: str
    on: tuple[str, ...]
    along: str
    gravity: Triple


@dataclass(frozen=True)
class Spring:
    """A spring or damper between two points, each at a place of a frame."""

    name: str
    on: str
    against: str
    frame: str
    at: Triple
    to_frame: str
    to: Triple
    stiffness: Formula
    damping: Formula
    length: Formula


@dataclass(frozen=True)
class Gradient:
    """The couple of a central gravity field: strength times e x I e."""

    name: str
    on: tuple[str, ...]
    along: str
    towards: Triple
    strength: Formula


Load = Force | Weight | Spring | Gradient


@dataclass(frozen=True)
class Unknown:
    """A component of a load that the balances are to find."""

    name: str
    unit: str
    load: str


@dataclass(frozen=True)
class Result:
    """A formula of answers, parameters and the motion."""

    name: str
    unit: str
    formula: Formula
    meaning: str


@dataclass(frozen=True)
class Place:
    """A point fixed in a frame, and the bodies that are spoken of."""

    frame: str
    at: Triple
    of: tuple[str, ...]


@dataclass(frozen=True)
class Steady:
    """The unknowns of a steady motion; what vanishes in it and its unit, if these are no balances.

    A balance is without the factors that never vanish, so it has no unit to be given in.
    """

    unknown: tuple[str, ...]
    vanishes: tuple[Formula, ...]
    unit: str


@dataclass(frozen=True)
class Group:
    """Components that enter and leave functions together, and the frame that they lie along.

    quaternion : whether they are an attitude, of length 1
    """

    name: str
    components: tuple[str, ...]
    unit: str
    frame: str
    low: Fraction | None
    high: Fraction | None
    meaning: str
    quaternion: bool = False


@dataclass(frozen=True)
class Groups:
    """What a scene's quantities are grouped as; an input of one function may answer another.

    rates : of inputs and outputs, those that answer with the rates of all states, in their order
    """

    states: tuple[Group, ...]
    inputs: tuple[Group, ...]
    outputs: tuple[Group, ...]
    rates: tuple[str, ...]

    def rate_of_each(self) -> dict[str, str]:
        """Return what answers with the rate of each component of the state."""
        named = {g.name: g.components for g in (*self.inputs, *self.outputs)}
        rates = [c for name in self.rates for c in named[name]]
        return dict(zip((c for g in self.states for c in g.components), rates, strict=True))


@dataclass(frozen=True)
class Above:
    """A formula of parameters that must be above zero."""

    label: str
    kind: Literal["mass", "length", "inertia"]
    formula: Formula


@dataclass(frozen=True)
class Tensor:
    """An inertia (xx, yy, zz, xy, xz, yz) that must be positive definite, or not negative.

    None stands for an entry that is not known or not asked about. ``whole`` is what masses must be
    able to make up, wheels included; ``given`` the tensor as the scene gives it, if that is about
    another point.
    """

    label: str
    entries: Entries
    relation: Literal["positive", "not negative"]
    whole: Entries
    given: Entries = ()


Demand = Above | Tensor
SOUGHT = ("acceleration", "accelerations", "state_rate")
"""Functions that find accelerations; what else may be asked of a body, its motion says."""


@dataclass(frozen=True)
class Scene:
    """Everything the user declared, checked; ``text`` is the file as it was read.

    column  : by what Jacobians of steps have a further column, None if they have none
    merging : words on where two of three free angles merge in their ranges, "" if nowhere
    groups  : what its functions are given and answer
    inverse : the same bodies where their motion is given, and what moves them is sought
    told    : what it declares, one sentence each
    spoken  : what places, axes and bodies are called that the user gave no names
    marks   : the index by which formulas tell quantities of such axes and bodies
    demands : what its parameters must fulfil, masses first, tensors last
    """

    name: str
    title: str
    source: str
    text: str
    parameters: tuple[Parameter, ...]
    coordinates: tuple[Moving, ...]
    speeds: tuple[Moving, ...]
    inputs: tuple[Moving, ...]
    frames: tuple[Frame, ...]
    bodies: tuple[Member, ...]
    loads: tuple[Load, ...]
    unknowns: tuple[Unknown, ...]
    results: tuple[Result, ...]
    momentum: Place
    about: Mapping[str, Formula]
    steady: Mapping[str, Steady]
    asked: Mapping[str, tuple[str, ...]]
    wanted: tuple[str, ...]
    form: Literal["fast", "accurate"]
    time_step: Given
    time: Given
    column: Literal["time_step"] | None
    emission: Literal["fast", "compact"]
    horizon: Fraction | None
    warnings: tuple[str, ...]
    demands: tuple[Demand, ...]
    merging: str = ""
    groups: Groups = Groups((), (), (), ())
    inverse: "Scene | None" = None
    told: tuple[str, ...] = ()
    spoken: Mapping[str, str] = field(default_factory=dict)
    marks: Mapping[str, str] = field(default_factory=dict)
    constraints: tuple[Constraint, ...] = ()

    def posed(self, function: str) -> "Scene":
        """Return the scene as a function poses it: its motion sought, or given."""
        return self if self.inverse is None or function in SOUGHT else self.inverse

    @property
    def moving(self) -> tuple[Moving, ...]:
        """Return coordinates, speeds and inputs, in this order."""
        return (*self.coordinates, *self.speeds, *self.inputs)

    def body(self, name: str) -> Member:
        """Return the body of a name."""
        return next(b for b in self.bodies if b.name == name)

    def frame(self, name: str) -> Frame:
        """Return the frame of a name."""
        return next(f for f in self.frames if f.name == name)
