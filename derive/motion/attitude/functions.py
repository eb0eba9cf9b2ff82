"""The formulas for attitudes as functions with a name: what goes in, what comes out."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from derive.motion.attitude import apart, euler, matrix, quaternion, rodrigues
from derive.program.program import Program, Quantity, Role
from derive.program.recorded import needed
from derive.program.tape import Number, Tape
from derive.scene.wanted import SEQUENCES

OverNumbers = Callable[..., list[Number]]

PARTS = ("w", "x", "y", "z")
ENTRIES = ("xx", "yx", "zx", "xy", "yy", "zy", "xz", "yz", "zz")
HALF_TURN = Fraction("3.14159")
"""Samples of angles are taken up to here; the functions take any."""


@dataclass(frozen=True)
class AttitudeFunction:
    """One formula: ``formula`` takes each input as numbers, and returns the output.

    within : the promise, in u: no component is further off than this times the largest one
    """

    name: str
    says: str
    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    formula: OverNumbers
    within: int


def attitude_program(name: str) -> Program:
    """Return a formula for attitudes as a program, by its name.

    >>> attitude_program("quaternion_product").count
    {'add': 7, 'mul': 16, 'sub': 5}
    """
    function = next(f for f in FUNCTIONS if f.name == name)
    tape = Tape("t", below=Tape("p"))
    given = [[tape.input(c) for c in q.components] for q in function.inputs]
    results = tuple(value.operand for value in function.formula(*given))
    ops = needed(tape.ops, results)
    return Program(name, function.says, function.inputs, function.outputs, ops, results)


def _quaternion(name: str, frame: str, meaning: str, role: Role = "value") -> Quantity:
    parts = tuple(f"{name}_{part}" for part in PARTS)
    return Quantity(name, parts, (4,), "1", frame, Fraction(-1), Fraction(1), meaning, role)


def _vector(name: str, unit: str, frame: str, bound: Fraction | int, meaning: str) -> Quantity:
    parts = tuple(f"{name}_{axis}" for axis in "xyz")
    return Quantity(name, parts, (3,), unit, frame, -Fraction(bound), Fraction(bound), meaning)


def _angles(sequence: str) -> Quantity:
    parts = ("angle_first", "angle_second", "angle_third")
    says = f"angles about {', '.join(sequence)}, each about the axis as the ones before left it"
    return Quantity("angles", parts, (3,), "rad", "N from B", -HALF_TURN, HALF_TURN, says)


ATTITUDE = _quaternion(
    "attitude",
    "N from B",
    "attitude quaternion, scalar first, body to inertial, |q| = 1",
    "attitude",
)
ANY_LENGTH = _quaternion("quaternion", "N from B", "quaternion of any length, scalar first")
TURN = _vector(
    "rotation_vector", "rad", "B", HALF_TURN, "axis times angle, the same along N's and B's axes"
)
MRP = _vector("mrp", "1", "B", 1, "modified Rodrigues parameters: axis times tan(angle / 4)")
VECTOR_B = _vector("vector_B", "1", "B", 1, "any vector along B's axes")
VECTOR_N = _vector("vector_N", "1", "N", 1, "any vector along N's axes")
MATRIX = Quantity(
    "matrix",
    tuple(f"matrix_{entry}" for entry in ENTRIES),
    (9,),
    "1",
    "N from B",
    Fraction(-1),
    Fraction(1),
    "rotation matrix R_NB, column by column: v_N = R_NB v_B",
)


LEFT = _quaternion("left", "N from A", "quaternion of the rotation that comes last")
RIGHT = _quaternion("right", "A from B", "quaternion of the rotation that comes first")
TARGET = _quaternion("target", "N from target", "attitude to be reached, |q| = 1", "attitude")
ERROR = _vector(
    "attitude_error",
    "rad",
    "B",
    2,
    "axis times 2 sin(angle / 2) of the turn from target to attitude",
)
SLOPES = Quantity(
    "slopes",
    tuple(f"slopes_{entry}" for entry in ENTRIES),
    (9,),
    "1",
    "B",
    Fraction(-1),
    Fraction(1),
    "derivatives of attitude_error by delta, attitude exp(delta / 2), column by column",
)
PRODUCT = _quaternion("attitude", "N from B", "left times right", "attitude")


def _euler(sequence: str) -> tuple[AttitudeFunction, AttitudeFunction]:
    angles, name = _angles(sequence), f"euler_{sequence}"
    says = f"Euler angles {sequence} of an attitude quaternion; the third is 0 at gimbal lock"
    inverse = f"attitude quaternion of Euler angles {sequence}"
    there, back = (partial(f, sequence) for f in (euler.from_quaternion, euler.to_quaternion))
    return (
        AttitudeFunction(f"quaternion_to_{name}", says, (ATTITUDE,), (angles,), there, 6),
        AttitudeFunction(f"quaternion_from_{name}", inverse, (angles,), (ATTITUDE,), back, 5),
    )


def _of(
    formula: OverNumbers,
    name: str,
    inputs: tuple[Quantity, ...],
    output: Quantity,
    within: int,
    says: str,
) -> AttitudeFunction:
    return AttitudeFunction(f"quaternion_{name}", says, inputs, (output,), formula, within)


FUNCTIONS: tuple[AttitudeFunction, ...] = (
    _of(quaternion.product, "product", (LEFT, RIGHT), PRODUCT, 4,
        "product of two quaternions: the rotation of the second, then that of the first"),
    _of(quaternion.exponential, "exp", (TURN,), ATTITUDE, 6,
        "unit quaternion of a rotation vector"),
    _of(quaternion.logarithm, "log", (ANY_LENGTH,), TURN, 5,
        "rotation vector of a quaternion of any length, angle at most pi; 0 for the quaternion 0"),
    _of(quaternion.normalise, "normalise", (ANY_LENGTH,), ATTITUDE, 4,
        "quaternion of length 1 along one of any length; (1, 0, 0, 0) for the quaternion 0"),
    _of(quaternion.rotate, "rotate", (ATTITUDE, VECTOR_B), VECTOR_N, 8,
        "components along N's axes of a vector given along B's"),
    _of(quaternion.rotate_back, "rotate_back", (ATTITUDE, VECTOR_N), VECTOR_B, 8,
        "components along B's axes of a vector given along N's"),
    _of(apart.attitude_error, "error", (TARGET, ATTITUDE), ERROR, 4,
        "error of an attitude along body axes; its sign jumps at half a turn"),
    _of(apart.error_tangent, "error_tangent", (TARGET, ATTITUDE), SLOPES, 4,
        "derivatives of quaternion_error over errors of the attitude, rad along body axes"),
    _of(matrix.from_quaternion, "to_matrix", (ATTITUDE,), MATRIX, 7,
        "rotation matrix of an attitude quaternion"),
    _of(matrix.to_quaternion, "from_matrix", (MATRIX,), ATTITUDE, 6,
        "attitude quaternion of a rotation matrix, scalar part not negative"),
    _of(rodrigues.from_quaternion, "to_mrp", (ATTITUDE,), MRP, 4,
        "modified Rodrigues parameters of an attitude quaternion, of length at most 1"),
    _of(rodrigues.to_quaternion, "from_mrp", (MRP,), ATTITUDE, 4,
        "attitude quaternion of modified Rodrigues parameters of any length"),
    *(function for sequence in SEQUENCES for function in _euler(sequence)),
)  # fmt: skip
