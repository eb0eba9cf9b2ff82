"""Bodies to check at: which inertias are bodies, and the ones that are hard to compute with.

A tensor is a body's if its second moments are not negative, which is the triangle inequality of
the principal moments. Hard bodies are entered through the scene's own parameters, where these are
the moments and products themselves.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random

from derive.mechanics.mechanism import Known, Mechanism
from derive.mechanics.specialise import Specialised
from derive.program.added import added
from derive.program.arithmetic import rounded
from derive.program.precision import Precision
from derive.scene.formula import FLOATS, Formula, evaluate
from derive.scene.numbers import Matrix, semidefinite, triangle

Triple = tuple[float, float, float]
OWN_AXES = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
TURN = (0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6)  # a rotation, exact in decimals


@dataclass(frozen=True)
class Hard:
    """A kind of body: second moments along its own axes, for the precision's smallest step.

    Turned bodies are full tensors; others lie along their principal axes.
    """

    kind: str
    second: Mapping[str, Triple]  # by precision: sum x^2 dm, sum y^2 dm, sum z^2 dm
    spread: float  # relative spread of the second moments
    axes: tuple[float, ...]  # the turn from them to the scene's axes, row by row


def _same(second: Triple) -> dict[str, Triple]:
    return {"f32": second, "f64": second}


BODIES = (
    Hard("sphere", _same((0.5, 0.5, 0.5)), 0.0, OWN_AXES),
    Hard("near sphere", _same((0.5, 0.5, 0.5)), 1e-8, OWN_AXES),
    Hard("thin rod", _same((1e-6, 1e-6, 1.0)), 0.5, OWN_AXES),
    Hard("thin disc", _same((1.0, 1.0, 0.0)), 0.5, OWN_AXES),
    Hard("turned, near sphere", _same((0.5, 0.5, 0.5)), 1e-8, TURN),
    Hard(
        "turned, ill-conditioned",
        {"f32": (1e-5, 2e-5, 1.0), "f64": (1e-9, 2e-9, 1.0)},
        0.5,
        TURN,
    ),
)


def bodies_taken(known: Known) -> tuple[Hard, ...]:
    """Return the kinds of hard bodies that a scene's parameters can describe."""
    if isinstance(known, Mechanism):
        return ()
    body = known.scene.body
    entered = [_entered(known, f) for f in body.inertia]
    if body.kind == "principal" and all(entered[:3]) and len(set(entered[:3])) == 3:
        return tuple(hard for hard in BODIES if hard.axes is OWN_AXES)
    if body.kind == "general" and all(entered) and len(set(entered)) == 6:
        return BODIES
    if body.kind == "axisymmetric" and sum(f is not None for f in set(entered[:3])) == 2:
        return tuple(hard for hard in BODIES if hard.axes is OWN_AXES)
    return ()


def _entered(known: Known, formula: Formula) -> str | None:
    free = {q.name for q in known.words.parameters}
    named = formula.operator == "symbol" and formula.name in free
    return formula.name if named else None


def hard_body(
    known: Specialised, hard: Hard, dice: Random, precision: Precision
) -> dict[str, float]:
    """Return the parameters of a hard body, and of wheels that are light enough for it."""
    a, b, c = (x * (1 + hard.spread * dice.random()) for x in hard.second[precision.name])
    body = known.scene.body
    if body.kind == "axisymmetric":
        a, b, c = _symmetric((a, b, c), body.axis or "z")
    moments = (b + c, c + a, a + b)
    whole = _turned(moments, hard.axes)
    entries = [float(rounded(Fraction(x), precision.dtype)) for x in whole]
    values = {
        f.name: x for f, x in zip(body.inertia, entries, strict=True) if f.operator == "symbol"
    }
    for wheel in known.scene.wheels:
        if wheel.axial.operator == "symbol":
            light = min(moments) * (0.1 + 0.1 * dice.random())
            values[wheel.axial.name] = float(rounded(Fraction(light), precision.dtype))
    return values


def _symmetric(second: Triple, axis: str) -> Triple:
    across = second[0] if axis == "z" else second[1]
    along = second[2]
    return tuple(along if name == axis else across for name in "xyz")  # type: ignore[return-value]


def _turned(moments: Triple, turn: Sequence[float]) -> tuple[float, ...]:
    """Return moments and products (+sum x y dm) of a turned body."""
    rows = [turn[0:3], turn[3:6], turn[6:9]]
    entry = [
        [added(rows[i][n] * moments[n] * rows[k][n] for n in range(3)) for k in range(3)]
        for i in range(3)
    ]
    own = [entry[0][0], entry[1][1], entry[2][2], -entry[0][1], -entry[0][2], -entry[1][2]]
    return tuple(own)


def formulas_of_body(
    known: Specialised,
) -> tuple[Sequence[Formula], list[tuple[Sequence[Formula], Formula]]]:
    """Return a body's moments and products, and axis and axial moment of each wheel."""
    scene = known.scene
    return scene.body.inertia, [(wheel.axis, wheel.axial) for wheel in scene.wheels]


def admissible(known: Known, values: Mapping[str, float]) -> bool:
    """Tell whether a scene's parameters describe a body, wheels included."""
    if isinstance(known, Mechanism):
        return True
    return solvable(known, values) and triangle(_tensor(known, values))


def solvable(known: Specialised, values: Mapping[str, float]) -> bool:
    """Tell whether the tensor, less the wheels' axial moments, has no negative moment.

    That is all that the equations need; a body keeps the triangle inequality besides.
    """
    numbers = _numbers(known, values)
    tensor = _tensor(known, values)
    size = sum(abs(tensor[i][i]) for i in range(3))
    for wheel in known.scene.wheels:
        axis, axial = [_number(f, numbers) for f in wheel.axis], _number(wheel.axial, numbers)
        tensor = tuple(
            tuple(tensor[i][k] - axial * axis[i] * axis[k] for k in range(3)) for i in range(3)
        )
    return semidefinite(tensor, Fraction(size))


def _numbers(known: Specialised, values: Mapping[str, float]) -> dict[str, float]:
    return dict(values) | {n: float(x) for n, x in known.words.numbers.items()}


def _tensor(known: Specialised, values: Mapping[str, float]) -> Matrix:
    numbers = _numbers(known, values)
    xx, yy, zz, xy, xz, yz = (_number(f, numbers) for f in known.scene.body.inertia)
    return (xx, -xy, -xz), (-xy, yy, -yz), (-xz, -yz, zz)


def _number(formula: Formula, numbers: Mapping[str, float]) -> Fraction:
    return Fraction(evaluate(formula, numbers, FLOATS))
