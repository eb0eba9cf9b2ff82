"""Second derivatives of the step that keeps the length of q, of a sum of its results with weights.

The step is q+ = q d, d = P / |P|, and z+, with d and z+ made of v = (z, u): the rest of the state
and the inputs. With weights l of q+ and m of z+ the sum is c . d + m . z+, c = conj(q) l, linear in
q: there is no block by q twice, one by q and v, and one symmetric by v twice. P is linear in each
of the four angular velocities, so its second derivatives by one of them vanish, and with
conj(d) dP / |P| = (r, t), conj(d) c = (c . d, e) those of c . P / |P| beside those of P are

    -(r' (e t) + (e t)' r + (c . d) t' t).

Those of z+ are what the rates' own come to, each stage's weighed by what it does to the sum.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.lower.order import with_values_read_soon
from derive.lower.signs import with_signs_outside
from derive.motion.attitude.quaternion import conjugate, norm_squared
from derive.motion.attitude.quaternion import product as hamilton
from derive.motion.runge_kutta.classic import THIRD, Stages, StageTurns, added, one_and, stages
from derive.motion.runge_kutta.curvature import curvature
from derive.motion.runge_kutta.dependence import closure, free_omega
from derive.motion.runge_kutta.matrices import (
    Matrix,
    NumberRow,
    identity,
    plus,
    product,
    sandwich_matrix,
    tangent_matrix,
    times,
    transposed,
    zeros,
)
from derive.motion.runge_kutta.system import System, pattern_of, tape_for
from derive.motion.runge_kutta.unit import turn_kept
from derive.program.operations import sqrt
from derive.program.pattern import compressed
from derive.program.program import Operand, Program, Quantity
from derive.program.recorded import needed
from derive.program.tape import Number, Tape, number

NEXT_PART = (1, 1, 2, 0)
"""What of a stage's rate times h/2 the state of the stage after it has."""
SHARE = (THIRD, 2 * THIRD, 2 * THIRD, THIRD)


@dataclass(frozen=True)
class StatePlaces:
    """Where things stand: q, then the rest z of the state, and omega among the rest."""

    attitude: slice
    rest: tuple[int, ...]
    omega: slice


@dataclass(frozen=True)
class Bent:
    """What a turn adds to the sum: by v twice, by q and v, and by each stage's omega."""

    twice: Matrix
    across: Matrix
    on_omega: list[NumberRow]
    between: list[Matrix]


def second_derivatives(system: System) -> Program:
    """Return the second derivatives of ``adjoint`` times the state after step_rk4_unit.

    They are the nonzeros of the lower triangle, by the states and the inputs.
    Raises ValueError where a rate beside that of q rests on q, or holds an operator without a rule.
    """
    places, tape = _places(system), tape_for(system)
    names = [*system.names, *(c for q in system.inputs for c in q.components)]
    adjoint = _adjoint(system)
    at = stages(tape, system)
    rows = _whole(system, places, *_blocks(tape, system, at, places))
    lower = [[x if k <= i else number(0) for k, x in enumerate(row)] for i, row in enumerate(rows)]
    pattern, nonzeros = compressed(lower, names, names, lambda x: x.exact == 0)
    parts = tuple(f"d2/d({pattern.rows[i]})/d({pattern.columns[k]})" for i, k in pattern.places())
    says = "nonzeros of the lower triangle, in compressed-column order, each in its own unit"
    results = tuple[Operand, ...](x.operand for x in nonzeros)
    constants = (q for q in system.rate.inputs if q.role == "constants")
    program = Program(
        "step_rk4_unit_hessian",
        "Second derivatives of adjoint times the state after step_rk4_unit.",
        (*constants, *system.states, *system.inputs, system.step, adjoint),
        (Quantity("hessian", parts, (len(parts),), "", "", None, None, says),),
        needed(tape.ops, results),
        results,
        steps=system.rate.steps,
        assumptions=system.rate.assumptions,
        sparsity={"hessian": pattern},
    )
    return with_values_read_soon(with_signs_outside(program, tape.prefix))


def _adjoint(system: System) -> Quantity:
    names = tuple(f"adjoint_{k}" for k in range(len(system.names)))
    return Quantity(
        "adjoint", names, (len(names),), "", "", None, None, "weights of the state after"
    )


def _places(system: System) -> StatePlaces:
    attitude, omega = system.quaternion, free_omega(system)
    if attitude is None or omega is None:
        raise ValueError("second derivatives are of a step that keeps the length of a quaternion")
    inside = range(attitude.start, attitude.stop)
    rest = tuple(k for k in range(len(system.names)) if k not in inside)
    found = closure(system, {system.names[k] for k in rest}) & set(system.names[attitude])
    if found:
        rule = "needs rates that do not rest on the attitude"
        raise ValueError(f"{rule}, and one rests on '{min(found)}'")
    first = rest.index(omega.start)
    return StatePlaces(attitude, rest, slice(first, first + 3))


def _blocks(tape: Tape, system: System, at: Stages, places: StatePlaces) -> tuple[Matrix, Matrix]:
    """Return the second derivatives by v twice, and by q and v."""
    weights = [tape.input(c) for c in _adjoint(system).components]
    local = [_local(system, places, k, at) for k in range(4)]
    tangents = _tangents(places, local)
    bent = _bent(system, at, places, weights[places.attitude], tangents)
    on = _on_rates(places, local, [weights[k] for k in places.rest], bent)
    total, quarter = bent.twice, at.time_step * Fraction(1, 2) * Fraction(1, 2)
    for k in range(4):
        curved = curvature(tape, system, places.rest, at.states[k], [x * quarter for x in on[k]])
        inner = plus(bent.between[k], product(curved, tangents[k]))
        total = plus(total, _with_transpose(tangents[k], inner))
    return total, bent.across


def _local(system: System, places: StatePlaces, stage: int, at: Stages) -> Matrix:
    """Return the Jacobian of the rates of z times h/2, by z and by the inputs."""
    by = pattern_of(system).columns[len(system.names) :]
    given = [c for q in system.inputs for c in q.components]
    rest = [by.index(c) if c in by else None for c in given]
    return [
        [
            *(at.slopes[stage][row][k] for k in places.rest),
            *(number(0) if k is None else at.by[stage][row][k] for k in rest),
        ]
        for row in places.rest
    ]


def _tangents(places: StatePlaces, local: Sequence[Matrix]) -> list[Matrix]:
    """Return the derivatives of (z, u) at each stage by v: (v, v), the inputs' own rows last."""
    n = len(places.rest)
    whole = identity(len(local[0][0]))
    found = [whole]
    for part, slopes in zip(NEXT_PART, local[:3], strict=False):
        gained = times(part, product(slopes, found[-1]))
        found.append([*plus(whole[:n], gained), *whole[n:]])
    return found


def _bent(
    system: System, at: Stages, places: StatePlaces, adjoint: NumberRow, tangents: Sequence[Matrix]
) -> Bent:
    """Return what the turn of q adds: nothing of it rests on q but c = conj(q) adjoint."""
    attitude, turn = turn_kept(system, at)
    whole = one_and(turn.increment)
    scale = 1 / sqrt(norm_squared(whole))
    d, c = [x * scale for x in whole], hamilton(conjugate(at.start[attitude]), adjoint)
    radial, *e = hamilton(conjugate(d), c)
    quarter = at.time_step * Fraction(1, 2) * Fraction(1, 2)
    third = scale * (quarter * THIRD)
    upright = [(x - radial * y) * third for x, y in zip(c, d, strict=True)]
    lefts = _lefts(turn.quarters)
    rights = turn.rights
    turned, grown = zeros(3, len(tangents[0])), zeros(1, len(tangents[0]))
    backward = [x * third for x in conjugate(d)]
    along = [x * third for x in d]
    on_omega = []
    for left, right, tangent in zip(lefts, rights, tangents, strict=True):
        moved = tangent[places.omega]
        turned = plus(turned, product(sandwich_matrix(hamilton(backward, left), right), moved))
        on_omega.append(_pulled(left, upright, right)[1:])
        grown = plus(grown, product([_pulled(left, along, right)[1:]], moved))
    twice = _of_the_length(turned, grown, e, radial)
    across = product(_by_attitude(adjoint, d), turned)
    meetings = _meetings(turn, lefts, upright, quarter)
    between = [zeros(len(tangents[0]), len(tangents[0])) for _ in tangents]
    for (i, k), meeting in meetings.items():
        met = product(meeting, tangents[k][places.omega])
        between[i][places.omega] = plus(between[i][places.omega], met)
    return Bent(twice, across, on_omega, between)


def _pulled(left: NumberRow, p: NumberRow, right: NumberRow) -> NumberRow:
    """Return conj(left) p conj(right): its product with a is that of p with left a right."""
    return hamilton(hamilton(conjugate(left), p), conjugate(right))


def _lefts(quarters: Sequence[NumberRow]) -> list[NumberRow]:
    """Return what multiplies each quarter-step vector from the left in 3 (P - 1)."""
    one = [number(1), *[number(0)] * 3]
    b1, b2, b3, _ = quarters
    second = one_and(b1)
    third = [x + x for x in one_and(hamilton(second, b2))]
    return [one, second, third, one_and(hamilton(third, b3))]


def _of_the_length(turned: Matrix, grown: Matrix, e: NumberRow, radial: Number) -> Matrix:
    """Return -(r' (e t) + (e t)' r + (c . d) t' t), r = ``grown``, t = ``turned``."""
    (r,) = grown
    weighed = times(Fraction(1, 2) * radial, turned)
    across = product([e], turned)[0]
    left = [r, *turned]
    right = [across, *weighed]
    return [[-x for x in row] for row in _with_transpose(left, right)]


def _by_attitude(adjoint: NumberRow, d: NumberRow) -> Matrix:
    """Return the matrix (4, 3) of t -> -adjoint t conj(d), the slopes by q of adjoint . q d t."""
    columns = [hamilton(list(x), conjugate(d)) for x in zip(*tangent_matrix(adjoint), strict=True)]
    return [[-x for x in row] for row in transposed(columns)]


def _meetings(
    turn: StageTurns, lefts: Sequence[NumberRow], p: NumberRow, quarter: Number
) -> dict[tuple[int, int], Matrix]:
    """Return S_ij (3, 3) of two stages i < j: a . S_ij b of changes a, b of their omega.

    In 3 (P - 1) they meet as f L_i b_i M_ij b_j R_j, with f = 2 but where R_2 has it already.
    """
    _, b2, b3, _ = turn.quarters
    one, twice = [number(1), *[number(0)] * 3], quarter + quarter
    middles = {
        (0, 1): (quarter, one),
        (0, 2): (twice, b2),
        (0, 3): (twice, hamilton(b2, b3)),
        (1, 2): (twice, one),
        (1, 3): (twice, b3),
        (2, 3): (quarter, one),
    }
    found = {}
    for (i, k), (factor, middle) in middles.items():
        pulled = [-(x * factor) for x in _pulled(lefts[i], p, turn.rights[k])]
        found[i, k] = sandwich_matrix(pulled, conjugate(middle))
    return found


def _on_rates(
    places: StatePlaces, local: Sequence[Matrix], weights: NumberRow, bent: Bent
) -> list[NumberRow]:
    """Return what the sum changes by with each stage's rates of z, times h/2: carried back."""
    n = len(places.rest)
    found, below = list[NumberRow](), [number(0)] * n
    for k in (3, 2, 1, 0):
        share = [w * SHARE[k] for w in weights]
        row = added(share, [x * NEXT_PART[k] for x in below])
        found.insert(0, row)
        below = product([row], [slopes[:n] for slopes in local[k]])[0]
        below[places.omega] = added(below[places.omega], bent.on_omega[k])
    return found


def _with_transpose(a: Matrix, b: Matrix) -> Matrix:
    """Return a' b + b' a."""
    left, right = transposed(a), transposed(b)
    size = len(left)
    found = zeros(size, size)
    for i in range(size):
        for k in range(i + 1):
            found[i][k] = _sum(left[i], right[k]) + _sum(right[i], left[k])
            found[k][i] = found[i][k]
    return found


def _sum(a: NumberRow, b: NumberRow) -> Number:
    return product([a], [[x] for x in b])[0][0]


def _whole(system: System, places: StatePlaces, twice: Matrix, across: Matrix) -> Matrix:
    """Return the matrix by the whole state and the inputs from its blocks."""
    n, more = len(system.names), len(twice) - len(places.rest)
    where = [*places.rest, *range(n, n + more)]
    found = zeros(n + more, n + more)
    for i, row in zip(where, twice, strict=True):
        for k, entry in zip(where, row, strict=True):
            found[i][k] = entry
    for i, row in enumerate(across, places.attitude.start):
        for k, entry in zip(where, row, strict=True):
            found[i][k] = found[k][i] = entry
    return found
