"""The formulas for attitudes as functions with a name: what goes in, what comes out."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from derive.motion.attitude import euler, matrix, quaternion, rodrigues
from derive.program.program import Program, Quantity
from derive.program.recorded import needed
from derive.program.tape import Number, Tape
from derive.scene.wanted import SEQUENCES

Formula = Callable[..., list[Number]]

PARTS = ("w", "x", "y", "z")
ENTRIES = ("xx", "yx", "zx", "xy", "yy", "zy", "xz", "yz", "zz")
HALF_TURN = Fraction("3.14159")
"""Samples of angles are taken up to here; the functions take any."""


@dataclass(frozen=True)
class AttitudeFunction:
    """One formula: ``formula`` takes a tape, and each input as numbers, and returns the output.

    within : the promise, in u: no component is further off than this times the largest one
    """

    name: str
    says: str
    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    formula: Formula
    within: int


def attitude_program(name: str) -> Program:
    """Return a formula for attitudes as a program, by its name.

    >>> attitude_program("quaternion_product").count()
    {'add': 7, 'mul': 16, 'sub': 5}
    """
    function = next(f for f in FUNCTIONS if f.name == name)
    tape = Tape("t", below=Tape("p"))
    given = [[tape.input(c) for c in q.components] for q in function.inputs]
    results = tuple(value.operand for value in function.formula(tape, *given))
    ops = needed(tape.ops, results)
    return Program(name, function.says, function.inputs, function.outputs, ops, results)


def _plain(formula: Formula, _tape: Tape, *given: Sequence[Number]) -> list[Number]:
    return formula(*given)


def _with_sequence(
    formula: Formula, sequence: str, _tape: Tape, given: list[Number]
) -> list[Number]:
    return formula(sequence, given)


def _quaternion(name: str, frame: str, meaning: str) -> Quantity:
    parts = tuple(f"{name}_{part}" for part in PARTS)
    return Quantity(name, parts, (4,), "1", frame, Fraction(-1), Fraction(1), meaning)


def _vector(name: str, unit: str, frame: str, bound: Fraction | int, meaning: str) -> Quantity:
    parts = tuple(f"{name}_{axis}" for axis in "xyz")
    return Quantity(name, parts, (3,), unit, frame, -Fraction(bound), Fraction(bound), meaning)


def _angles(sequence: str) -> Quantity:
    parts = ("angle_first", "angle_second", "angle_third")
    says = f"angles about {', '.join(sequence)}, each about the axis as the ones before left it"
    return Quantity("angles", parts, (3,), "rad", "N from B", -HALF_TURN, HALF_TURN, says)


ATTITUDE = _quaternion(
    "attitude", "N from B", "attitude quaternion, scalar first, body to inertial, |q| = 1"
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


def _euler(sequence: str) -> tuple[AttitudeFunction, AttitudeFunction]:
    angles = _angles(sequence)
    return (
        AttitudeFunction(
            f"quaternion_to_euler_{sequence}",
            f"Euler angles {sequence} of an attitude quaternion; the third is 0 at gimbal lock",
            (ATTITUDE,),
            (angles,),
            partial(_with_sequence, euler.from_quaternion, sequence),
            within=6,
        ),
        AttitudeFunction(
            f"quaternion_from_euler_{sequence}",
            f"attitude quaternion of Euler angles {sequence}",
            (angles,),
            (ATTITUDE,),
            partial(_with_sequence, euler.to_quaternion, sequence),
            within=5,
        ),
    )


FUNCTIONS: tuple[AttitudeFunction, ...] = (
    AttitudeFunction(
        "quaternion_product",
        "product of two quaternions: the rotation of the second, then that of the first",
        (
            _quaternion("left", "N from A", "quaternion of the rotation that comes last"),
            _quaternion("right", "A from B", "quaternion of the rotation that comes first"),
        ),
        (_quaternion("attitude", "N from B", "left times right"),),
        partial(_plain, quaternion.product),
        within=4,
    ),
    AttitudeFunction(
        "quaternion_exp",
        "unit quaternion of a rotation vector",
        (TURN,),
        (ATTITUDE,),
        quaternion.exponential,
        within=6,
    ),
    AttitudeFunction(
        "quaternion_log",
        "rotation vector of a quaternion of any length, angle at most pi; 0 for the quaternion 0",
        (ANY_LENGTH,),
        (TURN,),
        partial(_plain, quaternion.logarithm),
        within=5,
    ),
    AttitudeFunction(
        "quaternion_normalise",
        "quaternion of length 1 along one of any length; (1, 0, 0, 0) for the quaternion 0",
        (ANY_LENGTH,),
        (ATTITUDE,),
        partial(_plain, quaternion.normalise),
        within=4,
    ),
    AttitudeFunction(
        "quaternion_rotate",
        "components along N's axes of a vector given along B's",
        (ATTITUDE, VECTOR_B),
        (VECTOR_N,),
        partial(_plain, quaternion.rotate),
        within=8,
    ),
    AttitudeFunction(
        "quaternion_rotate_back",
        "components along B's axes of a vector given along N's",
        (ATTITUDE, VECTOR_N),
        (VECTOR_B,),
        partial(_plain, quaternion.rotate_back),
        within=8,
    ),
    AttitudeFunction(
        "quaternion_to_matrix",
        "rotation matrix of an attitude quaternion",
        (ATTITUDE,),
        (MATRIX,),
        partial(_plain, matrix.from_quaternion),
        within=7,
    ),
    AttitudeFunction(
        "quaternion_from_matrix",
        "attitude quaternion of a rotation matrix, scalar part not negative",
        (MATRIX,),
        (ATTITUDE,),
        partial(_plain, matrix.to_quaternion),
        within=6,
    ),
    AttitudeFunction(
        "quaternion_to_mrp",
        "modified Rodrigues parameters of an attitude quaternion, of length at most 1",
        (ATTITUDE,),
        (MRP,),
        partial(_plain, rodrigues.from_quaternion),
        within=4,
    ),
    AttitudeFunction(
        "quaternion_from_mrp",
        "attitude quaternion of modified Rodrigues parameters of any length",
        (MRP,),
        (ATTITUDE,),
        partial(_plain, rodrigues.to_quaternion),
        within=4,
    ),
    *(function for sequence in SEQUENCES for function in _euler(sequence)),
)
