"""A wrong sign or a choice the wrong way round, anywhere in a formula, breaks its promise."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, partial

import flint
import numpy as np
import pytest

from derive.program.program import Op, Program
from tests.motion.attitude import cases, truth
from tests.motion.attitude.measured import PRECISIONS, Rows, called, error, program, promise
from tests.motion.attitude.truth import Vector, plain

SWAPPED = {"add": "sub", "sub": "add"}


@dataclass(frozen=True)
class Subject:
    """A function's truth, and few samples that between them need every operation of it."""

    true: Callable[..., Vector]
    given: tuple[Rows, ...]


def unit_or_one(q: Vector) -> Vector:
    return truth.unit(q) if any(c != 0 for c in q) else [flint.arb(int(k == 0)) for k in range(4)]


def log_or_zero(q: Vector) -> Vector:
    return truth.log(unit_or_one(q))


def of_matrix(matrix: Vector) -> Vector:
    """Return the one of the samples, w >= 0, that a rotation matrix was made from."""

    def off(q: Vector) -> float:
        true = truth.by_column(q)
        return max(float(abs(a - b)) for a, b in zip(matrix, true, strict=True))

    q = min(([flint.arb(float(c)) for c in one] for one in TURNED), key=off)
    return truth.unit([-c for c in q] if q[0] < 0 else q)


def some(*rows: Rows) -> Rows:
    """Return some ordinary samples and those that are named hard."""
    return np.concatenate([np.asarray(r, np.float64) for r in rows])


UNITS = cases.units(np.float64, 12)
HARD = cases.hard_units(np.float64)[::9]
FAR = some(*(size * np.eye(4) + 1 for size in (1e300, 3e38)), [(1e18, 1e-12, -1e-12, 0)])
TURNED = some(UNITS, *(np.eye(4) + np.array(d) * 1e-9 for d in ((1, 2, 3, 1), (3, 1, 1, 3))))
AXES = 3 * np.eye(3)
NO_TURN = np.array(
    [(1, 1e-200, 0, 0), (1, 0, 1e-200, 0), (1, 1e-9, 1e-200, 0), (1, 1e-200, 1e-9, 0)]
)
TURNS = some(AXES, cases.vectors(9, np.float64) * 300, cases.rotation_vectors(np.float32)[::12])
VECTORS = cases.vectors(12, np.float64)
LENGTHS = some(cases.of_any_length(4, np.float64)[::7], np.zeros((1, 4)))
SUBJECTS = {
    "product": Subject(truth.times, (UNITS, np.roll(UNITS, 1, axis=0))),
    "exp": Subject(truth.exp, (TURNS,)),
    "log": Subject(
        log_or_zero, (some(UNITS, LENGTHS, FAR, cases.of_mixed_scales(np.float64)[::29]),)
    ),
    "normalise": Subject(unit_or_one, (some(UNITS, LENGTHS),)),
    "rotate": Subject(truth.rotate, (UNITS, VECTORS)),
    "rotate_back": Subject(truth.rotate_back, (UNITS, VECTORS)),
    "error": Subject(truth.attitude_error, (UNITS, np.roll(UNITS, 1, axis=0))),
    "error_tangent": Subject(truth.error_slopes, (UNITS, np.roll(UNITS, 1, axis=0))),
    "to_matrix": Subject(truth.by_column, (UNITS,)),
    "from_matrix": Subject(
        of_matrix,
        (np.array([[float(e) for e in plain(truth.by_column, q)] for q in TURNED]),),
    ),
    "to_mrp": Subject(truth.mrp, (some(UNITS, HARD),)),
    "from_mrp": Subject(truth.from_mrp, (some(VECTORS, AXES * 1e200, AXES * 1e-200),)),
    **{
        f"to_euler_{s}": Subject(partial(truth.to_euler, s), (some(UNITS, NO_TURN),))
        for s in ("zyx", "xyz", "zxz")
    },
    **{
        f"from_euler_{s}": Subject(partial(truth.from_euler, s), (VECTORS,)) for s in ("zyx", "zxz")
    },
}


@cache
def given(name: str, dtype: type) -> tuple[Rows, ...]:
    """Return the samples in a precision, without those that overflow there."""
    with np.errstate(over="ignore"):
        each = [rows.astype(dtype) for rows in SUBJECTS[name].given]
    fit = np.all([np.all(np.isfinite(rows), axis=1) for rows in each], axis=0)
    return tuple(rows[fit] for rows in each)


@cache
def truths(name: str, dtype: type) -> tuple[Vector, ...]:
    every = zip(*given(name, dtype), strict=True)
    return tuple(plain(SUBJECTS[name].true, *one) for one in every)


def noticed(name: str, mutant: Program) -> bool:
    """Tell whether a mutant breaks the promise in either precision: some choices serve one only."""
    limit = promise(f"quaternion_{name}")
    return any(
        not error(f, t, dtype) <= limit
        for dtype in PRECISIONS
        for f, t in zip(called(mutant, *given(name, dtype)), truths(name, dtype), strict=True)
    )


def splits(one: Program, op: Op) -> bool:
    """Tell whether a sign only turns the short half of a number into its negative.

    Its square, and (a - half) (a + half), are all that is used, so nothing becomes wrong.
    """
    made = {o.result: o for o in one.ops if isinstance(o, Op)}
    splitters = {name for name, o in made.items() if o.operator == "splitter"}
    shifts = {name for name, o in made.items() if splitters & set(o.operands)}
    longs = {n for n, o in made.items() if o.operator == "mul" and shifts & set(o.operands)}
    return op.result in shifts or (op.operator == "add" and bool(longs & set(op.operands)))


def bends(op: Op) -> bool:
    """Tell whether an operation is 1 less what rounds away: for derivatives, and judged by them."""
    return op.operator == "sub" and op.operands[0] == Fraction(1)


def mutants(one: Program) -> Iterator[tuple[str, Program]]:
    """Yield the program with the sign of one sum wrong, or one choice the wrong way round."""
    for place, op in enumerate(one.ops):
        assert isinstance(op, Op)
        if splits(one, op) or bends(op):
            continue
        changed = []
        if op.operator in SWAPPED:
            changed.append(replace(op, operator=SWAPPED[op.operator]))
        if op.operator == "select":
            condition, yes, no = op.operands
            changed.append(replace(op, operands=(condition, no, yes)))
        if op.operator == "neg":
            changed.append(Op(op.result, "add", (*op.operands, Fraction(0))))
        for new in changed:
            ops = (*one.ops[:place], new, *one.ops[place + 1 :])
            yield f"{place}: {op}", replace(one, ops=ops)


@pytest.mark.parametrize("name", SUBJECTS)
def test_every_wrong_sign_and_choice_is_noticed(name):
    own = program(f"quaternion_{name}")
    assert not noticed(name, own)
    missed = [says for says, mutant in mutants(own) if not noticed(name, mutant)]
    assert missed == []
