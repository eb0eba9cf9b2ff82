"""What a scene file may hold: every table, an entry a row; readers and manual follow them."""

from collections.abc import Mapping
from decimal import Decimal

from derive.scene.declaration import AXES
from derive.scene.entry import REQUIRED, Entry
from derive.scene.shape import ROUND

ORIGIN = [0, 0, 0]
MEANING = Entry("meaning", "text", "said wherever the name stands")
RANGE = Entry("range", "range", "where the code is checked", default=REQUIRED)
UNIT = Entry("unit", "text", "coherent SI, as `kg m^2`", default=REQUIRED)

COMPONENTS = Entry("components", "names", "of a vector: `x` makes `NAME_x`")
PARAMETER = (
    UNIT,
    Entry("range", "range", "of an argument of set-up; either this or `value`"),
    Entry("value", "number", "a number in the code"),
    MEANING,
)
SPEED = (
    Entry("unit", "text", "`rad/s` or `m/s`", default=REQUIRED),
    RANGE,
    MEANING,
    Entry("motion", "word", "if its rate is found or given", words=("free", "prescribed")),
    Entry("rate", "any", "prescribed: `{ range = [low, high] }`, an input `W_dot`, or 0"),
    COMPONENTS,
)
COORDINATE = (
    Entry("unit", "text", "`rad` or `m`", default=REQUIRED),
    *SPEED[1:4],
    Entry(
        "rate", "any", "`{ range }`, an input `psi_dot` or the range of a free one; 0; a formula"
    ),
    Entry("acceleration", "any", "prescribed: `{ range }`, an input `psi_ddot`, or 0"),
    COMPONENTS,
)
INPUT = (UNIT, RANGE, MEANING, COMPONENTS)
FRAME = (
    Entry("parent", "text", "the frame that carries it", default="inertial"),
    Entry("turned", "turns", "from the parent, each about the axes so far", scope="places"),
    Entry("angular_velocity", "three formulas", "relative to the parent, along its own axes",
          "rad/s", "motions"),
    Entry("attitude", "word", "a free attitude beside `angular_velocity`: a state, scalar first",
          words=("quaternion",)),
    Entry("origin", "three formulas", "along the parent's axes from its origin", "m", "places"),
    Entry("rolls", "table", "`{ body, at }`: that particle of the body is at rest"),
    Entry("velocity", "three formulas", "of the origin, seen from N, along its own axes", "m/s",
          "motions"),
    Entry("acceleration", "three formulas", "of the origin, seen from N, along its own axes",
          "m/s^2", "known"),
)  # fmt: skip
ROLLS = (
    Entry("body", "body", "that rolls", default=REQUIRED),
    Entry("at", "three formulas", "the particle, from the frame's origin", "m", "places", REQUIRED),
)
MOMENTS = (
    Entry("moments", "three formulas", "xx, yy, zz", "kg m^2"),
    Entry("second_moments", "three formulas", "sums of x^2, y^2, z^2 instead", "kg m^2"),
)
AXIS = Entry("axis", "word", "of symmetry", default=REQUIRED, words=AXES)
ACROSS = Entry(
    "moment", "formula", "about every axis; of a rod, across", "kg m^2", default=REQUIRED
)
KINDS: Mapping[str, tuple[Entry, ...]] = {
    "general": (
        *MOMENTS,
        Entry(
            "products", "three formulas xy, xz, yz", "xy = +sum x y dm", "kg m^2", default=REQUIRED
        ),
    ),
    "principal": MOMENTS,
    "axisymmetric": (
        AXIS,
        Entry("axial", "formula", "about the axis; a single body needs it", "kg m^2"),
        Entry("transverse", "formula", "across it; a single body needs it", "kg m^2"),
    ),
    "spherical": (ACROSS,),
    "rod": (AXIS, ACROSS),
}
"""What each kind of body must say."""
MASS = Entry("mass", "formula above 0, or 0", "if it is known; 0 is counted in another body", "kg")
POINT_MASS = Entry("mass", "formula above 0", "of the point", "kg", default=REQUIRED)
WHOLE_MASS = Entry("mass", "formula above 0", "of uniform density", "kg", default=REQUIRED)
SAID: Mapping[str, tuple[Entry, ...]] = {
    "box": (Entry("lengths", "any", "three edges", "m", default=REQUIRED),),
    "plate": (AXIS, Entry("lengths", "any", "two edges across the axis", "m", default=REQUIRED)),
    "point": (),
    "blades": (
        AXIS,
        Entry("number", "count", "of slender blades from the hub, `mass` each", default=REQUIRED),
        Entry("length", "formula above 0", "of a blade", "m", default=REQUIRED),
        Entry("first", "word", "along which the first lies; the axis after `axis`", words=AXES),
    ),
}
"""Shapes that are not round, and what each must say besides its mass."""
ABOUT = Entry(
    "about",
    "word",
    "what moments or a cone are about",
    default="centre",
    words=("centre", "origin", "apex"),
)
CENTRE_OR_APEX = Entry(
    "about", "word", "where the point lies", default="centre", words=("centre", "apex")
)
CENTRE = Entry("centre", "three formulas", "of mass", "m")
OWN_TURNS, SPIN = "from the axes to the body's own", "relative to the axes, about `axis`"
BODY = (
    CENTRE,
    Entry("turned", "turns through coordinates", OWN_TURNS, scope="places"),
    Entry("spin", "formula", f"{SPIN}, of a sphere about that of x, y, z on which its centre lies",
          "rad/s", "motions"),
)  # fmt: skip
"""What a single body may say besides its kind or shape."""
MEMBER = (
    Entry("frame", "frame", "that carries it", default=REQUIRED),
    CENTRE,
    Entry("turned", "turns", OWN_TURNS, scope="places"),
    Entry("spin", "formula", SPIN, "rad/s", "motions"),
    Entry("axial_speed", "formula", "the whole angular velocity about `axis`", "rad/s", "motions"),
    Entry("angular_velocity", "three formulas", "of a ball in its frame", "rad/s", "motions"),
    ABOUT,
)
"""What a body of a machine may say besides its kind or shape."""
AT = Entry("at", "three formulas", "a place, from the origin of `frame`", "m", "places", ORIGIN)
ON = Entry("on", "body", "that feels it", default=REQUIRED)
AGAINST = Entry("against", "body", "that feels the opposite")
OF = Entry("frame", "frame", "of the place; the body's if left out")
ALL = Entry("on", "bodies", "that feel it; all if left out")
ALONG = Entry("along", "frame", "along whose axes it is given", default="inertial")
FORCE = (
    ON,
    Entry("force", "any", "three formulas in N, or one unknown for three; 0 if left out"),
    Entry("couple", "any", "three formulas in N m, or one unknown for three; 0 if left out"),
    OF,
    AT,
    Entry("along", "frame", "along whose axes both are given; `frame` if left out"),
    AGAINST,
)
WEIGHT = (Entry("gravity", "three formulas", "free fall", "m/s^2", "known", REQUIRED), ALONG, ALL)
SPRING = (
    ON,
    Entry("spring", "formula", "stiffness", "N/m", "known", 0),
    Entry("damper", "formula", "damping", "N s/m", "known", 0),
    Entry("length", "formula", "at rest", "m", "known", 0),
    OF,
    AT,
    Entry("to", "three formulas", "the other end, from the origin of `to_frame`", "m", "places",
          ORIGIN),
    Entry("to_frame", "frame", "of the other end", default="inertial"),
    AGAINST,
)  # fmt: skip
GRADIENT = (
    Entry(
        "gravity_gradient",
        "any",
        "times e x I e: a formula in 1/s^2, or `{ mu, distance }`, or `{ orbital_rate }`",
        default=REQUIRED,
    ),
    Entry("towards", "three formulas", "the unit vector e", "1", "known", REQUIRED),
    ALONG,
    ALL,
)
CENTRE_OF_FIELD = (
    Entry("mu", "formula", "G M of the centre: 3 mu/distance^3", "m^3/s^2", "known"),
    Entry("distance", "formula", "from the centre", "m", "known"),
    Entry("orbital_rate", "formula", "of a circular orbit, instead: 3 orbital_rate^2", "rad/s",
          "known"),
)  # fmt: skip
FORMULA = (
    Entry("formula", "any", "of all that is known with the state", default=REQUIRED),
    MEANING,
    Entry("unit", "any", "coherent SI, which the formula must have; its own if left out"),
)
CONSTRAINT = (
    Entry("zero", "any", "a formula that stays 0: of places, or of rates and speeds; or points:"),
    Entry("on", "body", "whose point meets another"),
    OF,
    AT,
    AGAINST,
    Entry("to_frame", "frame", "of the other point; that of `against`, or inertial, if left out"),
    Entry("to", "three formulas", "the other point, from the origin of `to_frame`", "m", "places",
          ORIGIN),
    ALONG,
    Entry("axes", "any", "of `along`, on which the points meet; all three if left out"),
    Entry("equal", "word", "of the points, or of the bodies' particles there: rolling",
          default="places", words=("places", "velocities")),
    Entry("load", "text", "that enforces it; one by the constraint's name if left out"),
    Entry("dependent", "any", "free coordinates and speeds that follow the others, a list"),
)  # fmt: skip
RESULT = (
    Entry("formula", "any", "of answers, parameters and the motion", default=REQUIRED),
    MEANING,
    Entry("unit", "any", "in which it is given: of SI, or min, h, d, deg, rpm"),
)
MOMENTUM = (
    Entry("frame", "frame", "along whose axes it is", default="inertial"),
    Entry("at", "three formulas", "the point, from that frame's origin", "m", "places", ORIGIN),
    Entry("of", "bodies", "counted in; all if left out"),
)
STEADY = (
    Entry("unknown", "any", "what is to be found: a name or a list", default=REQUIRED),
    Entry("vanishes", "any", "a formula that is 0, instead of a balance; a list, of several"),
)
TIME_STEP = Entry("time_step", "bounds", "of a step, s", default={"range": [0, Decimal("0.01")]})
TIME = Entry("time", "bounds", "that a flow goes on for, s", default={"range": [0, 10]})
COLUMN = Entry("column", "word", "a further one of `_jacobian` and `_tangent` of steps",
               words=("time_step",))  # fmt: skip
AXES_OF_ONE = (
    Entry("fixed_in", "word", "axes of the body", words=("body",)),
    Entry("attitude", "word", "free body axes: a state, scalar first", words=("quaternion",)),
    Entry("turned", "turns through coordinates",
          "from the inertial axes, each about the axes so far", scope="places"),
    Entry("angular_velocity", "three formulas", "Omega, along themselves", "rad/s", "motions"),
)  # fmt: skip
WHEEL = (
    Entry("name", "any", "letters and digits", default=REQUIRED),
    Entry("axis", "three formulas", "a unit vector along the body's axes", default=REQUIRED),
    Entry("axial", "formula above 0", "moment of inertia about it", "kg m^2", default=REQUIRED),
    Entry("speed_range", "range", "relative to the body, rad/s", default=REQUIRED),
    Entry("torque_range", "range", "of the motor, N m", default=REQUIRED),
)
POINT = (
    Entry("kind", "word", "what moments are about", default="centre_of_mass",
          words=("centre_of_mass", "fixed", "moving")),
    Entry("acceleration", "vector", "of a moving one", "m/s^2", "known"),
)  # fmt: skip
KNOWN = (
    Entry("angular_velocity", "vector", "omega", "rad/s", "motions", {"range": [-10, 10]}),
    Entry("angular_acceleration", "vector", "its rate", "rad/s^2", "known", {"range": [-50, 50]}),
    Entry("moment", "vector", "about the point", "N m", "loads", {"range": [-1, 1]}),
    Entry("force", "vector", "resultant", "N", "loads", {"range": [-10, 10]}),
)
POSITION = (
    Entry("position", "bounds", "of the mass centre, m", default=REQUIRED),
    Entry("velocity", "bounds", "of the mass centre, m/s", default=REQUIRED),
)
FILE = (
    Entry("title", "text", "of the scene; its name if left out"),
    Entry("source", "text", "where a machine is described"),
    Entry("wanted", "any", "functions, a list", default=REQUIRED),
    Entry("form", "word", "whether they work on pairs of floats", default="fast",
          words=("fast", "accurate")),
    Entry("emission", "word", "whether steps are short loops", default="fast",
          words=("fast", "compact")),
    Entry("horizon", "number above 0", "s, end of the report's motions; else about ten turns"),
)  # fmt: skip
"""What a file says above its first table."""


def shape_entries(shape: str) -> tuple[Entry, ...]:
    """Return what a shape must say, its mass first."""
    mass = POINT_MASS if shape == "point" else WHOLE_MASS
    return (mass, *(_round_entries(shape) if shape in ROUND else SAID[shape]))


def _round_entries(shape: str) -> tuple[Entry, ...]:
    lengths = tuple(
        Entry(name, "formula above 0", "", "m", default=REQUIRED) for name in ROUND[shape].lengths
    )
    axes = () if ROUND[shape].sphere else (AXIS,)
    return (*lengths, *axes, *((CENTRE_OR_APEX,) if shape == "cone" else ()))
