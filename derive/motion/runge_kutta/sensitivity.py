"""Derivatives of a Runge-Kutta step, carried back through its stages.

The rates times h/2 are g_i, their Jacobians A_i by the state and B_i by the rest. A row of
derivatives that rests on the stages' states with C_i and on their g_i with w_i is carried back,

    m_i = w_i + (1, 1, 2, 0)_i n_(i+1),    n_i = C_i + m_i A_i,

to sum n_i by the state and sum m_i B_i by the rest: whether these are inputs or parameters, they
cost little beside the states. The step's length may be one of the rest, as h/2: by it
g_i changes with the rates themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from derive.motion.attitude.quaternion import conjugate, norm_squared
from derive.motion.runge_kutta.classic import (
    THIRD,
    Stages,
    StageTurns,
    normalised,
    one_and,
    stages,
    turn_slopes,
)
from derive.motion.runge_kutta.dependence import free_omega
from derive.motion.runge_kutta.matrices import (
    Matrix,
    NumberRow,
    beside,
    identity,
    lifted,
    minus,
    plus,
    product,
    right_matrix,
    sandwich_matrix,
    tangent_matrix,
    times,
    transposed,
    zeros,
)
from derive.motion.runge_kutta.system import System
from derive.program.operations import sqrt
from derive.program.program import Operand
from derive.program.tape import Number, Tape, number


@dataclass(frozen=True)
class Back:
    """Derivatives carried back to the start of a step: by its state, and by what else there is."""

    state: Matrix
    rest: Matrix


def carried_back(stages: Stages, on_states: Sequence[Matrix], on_rates: Sequence[Matrix]) -> Back:
    """Return derivatives by what a step starts from and by what it is given.

    on_states, on_rates : (4, r, n) by the states and by the (scaled) rates of the stages
    """
    nu = zeros(len(on_rates[3]), len(stages.start))
    state, weights = nu, list[Matrix]()
    for stage, part in ((3, 0), (2, 2), (1, 1), (0, 1)):
        mu = plus(on_rates[stage], times(part, nu))
        nu = plus(on_states[stage], product(mu, stages.slopes[stage]))
        state = plus(state, nu)
        weights.insert(0, mu)
    return Back(state, _collected(weights, stages.by))


def _collected(weights: Sequence[Matrix], by: Sequence[Matrix]) -> Matrix:
    """Return the sum of the products, weights of equal factors summed first."""
    columns = len(by[0][0]) if by[0] else 0
    return [
        [_sum_of_products(rows, [[b[k] for b in each] for each in by]) for k in range(columns)]
        for rows in zip(*weights, strict=True)
    ]


def _sum_of_products(rows: Sequence[NumberRow], columns: Sequence[NumberRow]) -> Number:
    pairs = [
        pair
        for row, column in zip(rows, columns, strict=True)
        for pair in zip(row, column, strict=True)
    ]
    by_factor = _grouped([(f, w) for w, f in pairs])
    by_weight = _grouped([(w, f) for f, w in by_factor])
    total = number(0)
    for weight, factor in by_weight:
        total = total + weight * factor
    return total


def _grouped(pairs: Sequence[tuple[Number, Number]]) -> list[tuple[Number, Number]]:
    """Return products a b with those of equal ``a`` made one: a, and the sum of the b."""
    found: dict[Operand, tuple[Number, Number]] = {}
    for a, b in pairs:
        if a.exact != 0 and b.exact != 0:
            _, before = found.get(a.operand, (a, number(0)))
            found[a.operand] = (a, before + b)
    return list(found.values())


def step_slopes(tape: Tape, system: System) -> tuple[NumberRow, Matrix]:
    """Return the state after a step and its derivatives (n, n + m) by the state and the rest."""
    at = stages(tape, system)
    after, squares = normalised(system, at)
    made, scales = unconstrained(at), [1 / sqrt(squared) for squared in squares]
    if at.turn is None:
        for place, scale in zip(system.quaternions, scales, strict=True):
            for part in (made.state, made.rest):
                part[place] = _on_the_sphere(after[place], times(scale, part[place]))
        return after, beside(made.state, made.rest)
    (attitude,), (scale,) = system.quaternions, scales
    q, turn = after[attitude], turn_carried_back(system, at, at.turn)
    made.rest[attitude] = product(tangent_matrix(q), turn.rest)
    made.state[attitude] = product(tangent_matrix(q), turn.state)
    own = _attitude_by_itself(one_and(at.turn.increment), scale, at.start[attitude], q)
    put(made.state[attitude], attitude, own)
    return after, beside(made.state, made.rest)


def by_errors(tape: Tape, system: System) -> tuple[NumberRow, Matrix]:
    """Return the same with three errors of attitude, before and after, for its four parts."""
    attitude = system.quaternion
    if attitude is None:
        raise ValueError("a tangent space needs one attitude quaternion among the states")
    at = stages(tape, system)
    after, squares = normalised(system, at)
    made = unconstrained(at)
    if at.turn is None:
        drop = times(2 / sqrt(squares[0]), transposed(tangent_matrix(after[attitude])))
        rows = Back(product(drop, made.state[attitude]), product(drop, made.rest[attitude]))
    else:
        turn = turn_carried_back(system, at, at.turn)
        rows = Back(times(2, turn.state), times(2, turn.rest))
    made.state[attitude] = rows.state
    made.rest[attitude] = rows.rest
    state = lifted(at.start[attitude], attitude, made.state)
    if at.turn is not None:
        whole = one_and(at.turn.increment)
        inverse = [x / norm_squared(whole) for x in conjugate(whole)]
        errors = slice(attitude.start, attitude.start + 3)
        put(state[errors], errors, sandwich_matrix(inverse, whole))
    return after, beside(state, made.rest)


def unconstrained(stages: Stages) -> Back:
    """Return the derivatives of start + (k1 + 2 k2 + 2 k3 + k4) h / 6."""
    unit = identity(len(stages.start))
    rest = zeros(*(len(unit),) * 2)
    back = carried_back(stages, [rest] * 4, [times(part * THIRD, unit) for part in (1, 2, 2, 1)])
    return Back(plus(unit, back.state), back.rest)


def _on_the_sphere(q: NumberRow, rows: Matrix) -> Matrix:
    """Return derivatives of four components without the part that changes their length."""
    return minus(rows, product([[x] for x in q], product([q], rows)))


def turn_carried_back(system: System, stages: Stages, turn: StageTurns) -> Back:
    """Return the derivatives (3, n) and (3, m) of v, if the attitude q changes by q (0, v)."""
    n, omega = len(stages.start), free_omega(system) or slice(0)
    on_states = [zeros(3, n) for _ in turn.quarters]
    parts, by_length = _on_omegas(system, stages, turn)
    for rows, part in zip(on_states, parts, strict=True):
        put(rows, omega, part)
    found = carried_back(stages, on_states, [zeros(3, n)] * 4)
    if not by_length:
        return found
    last = [[*row[:-1], row[-1] + x] for row, x in zip(found.rest, by_length, strict=True)]
    return Back(found.state, last)


def _on_omegas(system: System, stages: Stages, turn: StageTurns) -> tuple[list[Matrix], NumberRow]:
    """Return the derivatives of v by the angular velocities of the stages, and by h/2 if asked."""
    if not system.column:
        scale = stages.time_step * Fraction(1, 12) / norm_squared(one_and(turn.increment))
        return turn_slopes(turn, scale), []
    parts = turn_slopes(turn, Fraction(1, 6) / norm_squared(one_and(turn.increment)))
    omega = free_omega(system) or slice(0)
    rates = [[w] for state in stages.states for w in state[omega]]
    by_length = [x for (x,) in product(beside(*parts), rates)]
    half = stages.time_step * Fraction(1, 2)
    return [times(half, part) for part in parts], by_length


def _attitude_by_itself(
    whole: NumberRow, scale: Number, start: NumberRow, after: NumberRow
) -> Matrix:
    """Return the derivative (4, 4) of q0 P / |q0 P| by q0."""
    own = right_matrix([x * scale for x in whole])
    inverse = scale * scale * norm_squared(whole)  # 1 / |q0|^2
    radial = [x * inverse for x in start]
    return minus(own, product([[x] for x in after], [radial]))


def put(rows: Matrix, place: slice, parts: Matrix) -> None:
    for row, entries in zip(rows, parts, strict=True):
        row[place] = entries
