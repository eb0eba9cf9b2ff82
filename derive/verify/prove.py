"""Proof that programs satisfy the lecture's equations, by exact values at random points.

Two rational functions that agree at random points of a wide grid are equal but for odds below one
in a million a point; sine and cosine enter as a pair of rationals with unit norm. Where a scene
holds a root or half an angle, balls of 4000 bits stand in for fractions.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from random import Random
from typing import Any

from flint import arb, ctx, fmpq, fmpq_mat

from derive.library.library import Library
from derive.program.program import Op, Program, component_names, read_by
from derive.program.recorded import needed
from derive.program.run import results_by_name
from derive.scene.declaration import DeriveError
from derive.scene.formula import Arithmetic
from derive.scene.wanted import JACOBIAN
from derive.verify.equations import Equations, stated
from derive.verify.operators import IN_FRACTIONS, IrrationalError
from derive.verify.reference import BALLS, NoValueError
from derive.verify.solution import Solved, solution

EXACT_SAMPLES = 2
TRIES = 50
SEED = "derive: proof by exact values"
BITS = 4000
SPAN = 9973  # numerators up to this, denominators up to its hundredth


class ProofError(DeriveError, ArithmeticError):
    """A program that does not satisfy its equations; the sentence says where and by how much."""


def _inverse(rows: list[list[Any]]) -> list[list[Any]]:
    return [list(row) for row in fmpq_mat(rows).inv().tolist()]


FRACTIONS: Arithmetic = {
    **IN_FRACTIONS,
    "inverse": _inverse,
    "size": lambda _: 1.0,
    "coefficient": lambda _: 1.0,
    "most": max,
    "unless_zero": lambda size, other: size or other,
}
WIDE_BALLS: Arithmetic = {
    **BALLS,
    "power_of_two": lambda x: x * 0 + 1,
    "size": lambda _: 1.0,
    "coefficient": lambda _: 1.0,
}


@dataclass(frozen=True)
class ExactSample:
    """Exact values of parameters and inputs, the constants made of them, and their arithmetic."""

    arithmetic: Arithmetic
    values: Mapping[str, Any]


def prove(library: Library) -> None:
    """Raise ProofError unless every program satisfies its problem at exact random points.

    Raises NoValueError if no such point is found at which the scene's formulas have values.
    """
    every = stated(library)
    for number in range(EXACT_SAMPLES):
        try:
            if any(map(_halves_angles, (library.setup, *library.functions, *library.rates))):
                raise IrrationalError
            _prove_at(library, every, exact_sample(library, number))
        except (IrrationalError, ZeroDivisionError):  # a cosine of 1 is 0 in fractions
            with ctx.workprec(BITS):
                _prove_in_balls(library, every, number)


def _halves_angles(program: Program) -> bool:
    """Tell whether a program takes the sine of half an angle, which no pair of rationals knows."""
    ops = [op for op in program.ops if isinstance(op, Op)]
    halves = {op.result for op in ops if op.operator == "mul" and Fraction(1, 2) in op.operands}
    return any(op.operator == "sin" and op.operands[0] in halves for op in ops)


def _prove_in_balls(library: Library, every: Mapping[str, Equations], number: int) -> None:
    """Prove at the first point at which every root exists."""
    for tries in range(TRIES):
        at = ball_sample(library, number + EXACT_SAMPLES * tries)
        if all(_exists(equations, at) for equations in every.values()):
            _prove_at(library, every, at)
            return
    raise NoValueError("no random point was found at which all roots exist")


def _exists(equations: Equations, at: ExactSample) -> bool:
    true = solution(equations, at.values, (), at.arithmetic).unknowns()
    return all(known.value.is_finite() for known in true.values())


def exact_sample(library: Library, number: int) -> ExactSample:
    """Return random fractions for all parameters and inputs of a library."""
    return ExactSample(FRACTIONS, dict(_dice(library, number)))


def ball_sample(library: Library, number: int) -> ExactSample:
    """Return the same fractions as narrow balls, all above zero."""
    values = {name: arb(abs(x)) for name, x in _dice(library, number)}
    return ExactSample(WIDE_BALLS, values)


def _dice(library: Library, number: int) -> Iterator[tuple[str, Any]]:
    dice = Random(f"{SEED} {number}")  # noqa: S311 - points of a proof, no secret
    for quantity in library.vocabulary.given():
        for name in quantity.components:
            top = dice.randint(1, SPAN) * dice.choice((-1, 1))
            yield name, fmpq(top, dice.randint(1, SPAN // 100))


def _prove_at(library: Library, every: Mapping[str, Equations], at: ExactSample) -> None:
    constants = results_by_name(lectured(library), at.arithmetic, at.values)
    for name, equations in every.items():
        functions = [
            f for f in (*library.functions, *library.rates) if f.name.removesuffix(JACOBIAN) == name
        ]
        columns = {c for f in functions for s in (f.sparsity or {}).values() for c in s.columns}
        true = solution(equations, at.values, columns, at.arithmetic).unknowns()
        for program in functions:
            fault = first_fault(program, true, constants, at)
            if fault:
                raise ProofError(_sentence(library, program, fault))


def lectured(library: Library) -> Program:
    """Return the part of set-up that the functions which are proved read."""
    setup = library.setup
    every = (*library.functions, *library.rates)
    proved = [f for f in every if f.name.removesuffix(JACOBIAN) in library.problems]
    used = {name for f in proved for name in read_by(f)}
    names = component_names(setup)
    kept = [(c, r) for c, r in zip(names, setup.results, strict=True) if c in used]
    outputs = tuple(replace(q, components=tuple(c for c, _ in kept)) for q in setup.outputs)
    results = tuple(r for _, r in kept)
    return replace(setup, outputs=outputs, ops=needed(setup.ops, results), results=results)


def first_fault(
    program: Program, true: Mapping[str, Solved], constants: Mapping[str, Any], at: ExactSample
) -> tuple[str, Any] | None:
    """Return the first output component that is not what the equations say, and by how much."""
    given = {c: None for q in program.inputs if q.role == "constants" for c in q.components}
    # constants of motion alone are not made, and not read either
    results = results_by_name(program, at.arithmetic, {**given, **at.values, **constants})
    for name, should in _expected(program, true).items():
        gap = results.get(name, 0) - should
        if not _vanishes(gap):
            return name, gap
    return None


def _expected(program: Program, true: Mapping[str, Solved]) -> dict[str, Any]:
    """Return what each output should be, and each entry of a Jacobian, in the pattern or not."""
    patterns = program.sparsity or {}
    expected = {
        c: true[c].value for q in program.outputs if q.name not in patterns for c in q.components
    }
    for pattern in patterns.values():
        within = {(pattern.rows[i], pattern.columns[k]) for i, k in pattern.places()}
        for row in pattern.rows:
            slopes = true[row].slopes
            for column in pattern.columns:
                if column in slopes or (row, column) in within:
                    slope, _ = slopes.get(column, (0, 0.0))
                    expected[f"d({row})/d({column})"] = slope
    return expected


def _vanishes(gap: Any) -> bool:
    if isinstance(gap, arb):
        return bool(gap.contains(0)) and bool(gap.rad() < arb(2) ** (-BITS // 2))
    return bool(gap == 0)


def _sentence(library: Library, program: Program, fault: tuple[str, Any]) -> str:
    name, gap = fault
    size = float(arb(gap) if isinstance(gap, fmpq) else gap)
    base = program.name.removesuffix(JACOBIAN)
    steps = ", ".join(f"'{step}'" for step in library.problems[base].steps)
    return (
        f"scene '{library.scene.name}': function '{program.name}' must satisfy lecture step "
        f"{steps} exactly, but '{name}' is off by {size:.3g} at a random exact point"
    )
