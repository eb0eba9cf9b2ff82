"""What laws rest on, in sentences that stand alone, and what their letters mean."""

from collections.abc import Iterable, Iterator, Mapping

from derive.emit.equations.dimensions import joined_dimensions
from derive.emit.equations.listed import Listed
from derive.lecture.chapters import LECTURE
from derive.lecture.chapters.letters import LETTERS
from derive.lecture.rate import rate_of
from derive.lecture.step import Step
from derive.lecture.vectors import Expression
from derive.scene.unit import dimension, spelled

ALONE: Mapping[str, str] = {
    "third_law": "The forces that two particles exert on each other are opposite.",
    "strong_third_law": "The forces that two particles exert on each other act along the line that "
    "joins them.",
    "A_is_fixed": "Where moments are taken about a fixed point A, it stays where it is.",
    "A_is_G": "Where moments are taken about the mass centre, A is G.",
    "A_accelerates_along_the_line_to_G": "Where A accelerates straight towards G or away from it, "
    "moments about it have no further term.",
    "reference_point": "A is fixed, or is G, or accelerates along the line to G, unless a law has "
    "a term with its acceleration a_A.",
    "body_triad": "Three perpendicular unit vectors that are fixed in the body are the columns of "
    "Q, and particles have coordinates along them.",
    "body_triad_is_orthonormal": "The vectors that are fixed in the body stay perpendicular and of "
    "unit length.",
    "axes_are_orthonormal": "The axes xyz, turned from the inertial ones by R, are perpendicular "
    "unit vectors.",
    "mirror_yz": "The yz plane is a mirror of the body.",
    "mirror_xy": "The xy plane is a mirror of the body.",
    "sine_and_cosine": "The sine and cosine of an angle have squares that add to one.",
    "turn_is_proper": "The body looks the same after a turn about z that is neither nothing nor "
    "half a turn.",
    "transverse": "A direction n is taken perpendicular to the axis of symmetry.",
    "rate_seen_from_N": "The rate of a vector seen from N is that of its components along N's "
    "axes, written along xyz.",
    "principal_directions": "Every inertia tensor has three principal directions.",
    "directions_are_perpendicular": "Two principal directions are perpendicular unit vectors.",
    "tensor_is_constant": "The axes see no change of the inertia tensor.",
    "products_vanish": "The products of inertia vanish.",
    "body_axes": "The axes are fixed in the body.",
    "principal_axes": "The axes are principal axes of the body: it has no products of inertia.",
    "spins_in_axes": "The axes follow the axis of the body but not its spin s.",
    "axis_is_z": "The axis of symmetry is the z axis.",
    "precession_across_axis": "The precession is perpendicular to the axis of symmetry.",
    "unit_quaternion": "The four numbers of an attitude form a unit quaternion.",
    "quaternion_of_axes": "An attitude is written with four numbers, a scalar q_w and a vector "
    "q_v.",
    "composed_turns": "Further axes are turned by R_2 from the axes xyz, which themselves turn.",
    "further_axes_are_right_handed": "Axes that are carried by turned axes are perpendicular, of "
    "unit length and right-handed.",
    "simple_turn": "Axes turn by an angle about a unit vector e.",
    "fixed_axis": "The unit vector e that axes turn about keeps its place.",
    "no_gimbal_lock": "The pitch is not 90 degrees up or down, where yaw and roll are singular.",
    "velocity_of_particle": "A particle of a rigid body moves at omega x rho, seen from A.",
    "kinetic_energy_about_point": "The energy of a rigid body that turns about a fixed point.",
    "koenig": "The energy of a free rigid body: that of its mass moving with G and that of its "
    "turning about G.",
    "transport_theorem": "The rate of the angular momentum seen from N is that seen from the axes, "
    "and what their turning adds.",
    "velocity_seen_from_axes": "The velocity of a particle is that seen from the axes, and what "
    "their turning adds.",
    "acceleration_seen_from_axes": "The acceleration of a particle is that seen from the axes, "
    "with terms of their angular acceleration, of Coriolis, and of the centripetal acceleration.",
    "general_form": "The moment balance of a body in its general form, about a fixed point or "
    "about G, in any axes.",
    "moving_point_form": "The moment balance about a point A that moves in any way.",
    "angular_velocities_add": "Angular velocities of axes that carry each other add.",
    "any_point_form": "A body, or several cut free together, can be balanced about any point.",
    "quaternion_rate_scalar": "The scalar part of an attitude has the rate of the scalar part of "
    "q (0, omega) / 2.",
    "quaternion_rate_vector": "The vector part of an attitude has the rate of the vector part of "
    "q (0, omega) / 2. No attitude is singular.",
}
"""Steps whose sentence in the lecture speaks of the sentences before it."""
STYLES: Mapping[tuple[int, ...], str] = {(): "scalar", (3,): "vector", (3, 3): "tensor"}
OTHERS: Mapping[str, tuple[str, str]] = {
    "R_2": ("1", "turns components along further axes into components along xyz"),
    "Omega_2": ("rad/s", "angular velocity of further axes relative to xyz, along them"),
    "Omega_1": ("rad/s", "angular velocity of further axes in N, along them"),
    "M_G": ("N m", "moment of the external forces about G"),
    "rho_i": ("m", "position of particle i from the point A"),
    "K": ("J", "kinetic energy of the motion relative to A"),
    "I_G": ("kg m^2", "inertia tensor about G along xyz"),
    "r_A": ("m", "position of A from a point fixed in N"),
    "v_A": ("m/s", "velocity of A seen from N"),
    "r_G": ("m", "position of G from a point fixed in N"),
    "l_O": ("kg m^2/s", "angular momentum about a point O fixed in N"),
    "M_O": ("N m", "moment of the external forces about O"),
    "u_any": ("1", "any vector, in its own unit"),
    "k": ("1/s^2", "strength of an attraction that grows with distance"),
    "c": ("1", "direction to a distant body that attracts"),
    "e": ("1", "unit vector along an axis"),
    "d": ("m", "position of a wheel's centre from A"),
    "m_w": ("kg", "mass of a wheel"),
    "A_w": ("kg m^2", "moment of inertia of a wheel across its axis"),
    "l_c": ("kg m^2/s", "angular momentum of the carrier"),
    "l_w": ("kg m^2/s", "angular momentum of a wheel"),
    "l_s": ("kg m^2/s", "angular momentum of a wheel about its centre"),
    "h_w": ("kg m^2/s", "angular momentum of a wheel relative to the carrier"),
    "I_c": ("kg m^2", "inertia tensor of the carrier about A"),
    "I_w": ("kg m^2", "inertia tensor of a wheel about A"),
    "K_c": ("J", "kinetic energy of the carrier relative to A"),
    "K_w": ("J", "kinetic energy of a wheel relative to A"),
    "T_w": ("J", "kinetic energy that a wheel adds by its spin"),
    "M_w": ("N m", "moment on a wheel about its centre"),
    "R_1": ("1", "turns components along further axes into components along N"),
    "W": ("1/s", "skew tensor of the angular velocity Omega"),
    "w": ("rad/s", "angular velocity of the body relative to the axes"),
    "v": ("1", "any vector, in its own unit"),
    "angle": ("rad", "angle of a turn"),
    "psi": ("rad", "yaw"),
    "theta": ("rad", "pitch"),
    "phi": ("rad", "roll"),
    "sec_theta": ("1", "one over the cosine of the pitch"),
}
"""Letters of laws that the lecture's table leaves out."""


def alone(step: Step) -> str:
    """Return a step as a sentence that needs none before it."""
    return ALONE.get(step.name, step.says)


def lecture_symbols(steps: Iterable[Step]) -> Iterator[Listed]:
    """Yield what the letters of some laws mean, each once."""
    sides = (side for step in steps for claim in step.claims for side in claim)
    for name, shape in {name: shape for side in sides for name, shape in _letters(side)}.items():
        unit, says = _meant(name)
        yield Listed((name,), (name,), unit, says, STYLES[shape])


def _names(step: Step) -> set[str]:
    return {name for claim in step.claims for side in claim for name, _ in _letters(side)}


def _letters(side: Expression) -> Iterator[tuple[str, tuple[int, ...]]]:
    """Yield the name and the shape of every letter."""
    if side.operator in ("symbol", "inertia"):
        yield side.name, side.shape
    for part in side.operands:
        yield from _letters(part)


def _meant(name: str) -> tuple[str, str]:
    known = {str(letter.name): (letter.si_unit, letter.says) for letter in LETTERS}
    known |= OTHERS
    if name in known:
        return known[name]
    below = rate_of(name)
    if below is None:
        first = next(step for step in LECTURE.steps if name in _names(step))
        return "as there", f"letter of the lecture's step {first.name}"
    unit, says = _meant(below[0])
    return spelled(
        joined_dimensions(dimension(unit), dimension("1/s"))
    ), f"rate of {below[0]}: {says}"
