"""The classic step with its quaternion multiplied by one of length one, whatever its own length.

Where nothing that turns the body knows the attitude, the classic step takes it from q0 to q0 P
(``classic``), and here to q0 P / |P|. The increment P / |P| is made of angular velocities, inputs
and the step's length alone, so the step is linear in q0: its second derivatives by two components
of q0 vanish, and at q0 = 0, where a solver may start, no root of zero is taken. At rest P = 1.
"""

from __future__ import annotations

from derive.motion.attitude.quaternion import norm_squared, product
from derive.motion.runge_kutta import sensitivity
from derive.motion.runge_kutta.classic import Stages, StageTurns, added, gains_of, one_and, stages
from derive.motion.runge_kutta.matrices import (
    Matrix,
    NumberRow,
    beside,
    right_matrix,
    tangent_matrix,
)
from derive.motion.runge_kutta.matrices import product as matrix_product
from derive.motion.runge_kutta.system import System
from derive.program.operations import sqrt
from derive.program.tape import Tape


def turn_kept(system: System, at: Stages) -> tuple[slice, StageTurns]:
    """Return where the attitude stands, and how it turns.

    Raises ValueError where a rate that turns the attitude rests on it, or there is none.
    """
    if system.quaternion is None or at.turn is None:
        rule = "needs one quaternion with its angular velocity, which does not rest on it"
        raise ValueError(f"a step that keeps the length of a quaternion {rule}")
    return system.quaternion, at.turn


def unit_increment(turn: StageTurns) -> NumberRow:
    """Return P / |P| (4)."""
    whole = one_and(turn.increment)
    scale = 1 / sqrt(norm_squared(whole))
    return [x * scale for x in whole]


def after(tape: Tape, system: System) -> NumberRow:
    """Return the state after the step, the quaternion as long as it was."""
    at = stages(tape, system)
    attitude, turn = turn_kept(system, at)
    found = added(at.start, gains_of(system, at))
    found[attitude] = product(at.start[attitude], unit_increment(turn))
    return found


def step_slopes(tape: Tape, system: System) -> tuple[NumberRow, Matrix]:
    """Return the state after the step and its derivatives (n, n + m) by the state and the rest."""
    at, found = stages(tape, system), after(tape, system)
    attitude, turn = turn_kept(system, at)
    made, turned = sensitivity.unconstrained(at), sensitivity.turn_carried_back(system, at, turn)
    bent = tangent_matrix(found[attitude])
    made.rest[attitude] = matrix_product(bent, turned.rest)
    made.state[attitude] = matrix_product(bent, turned.state)
    sensitivity.put(made.state[attitude], attitude, right_matrix(unit_increment(turn)))
    return found, beside(made.state, made.rest)


def by_errors(tape: Tape, system: System) -> tuple[NumberRow, Matrix]:
    """Return the same with three errors of attitude, before and after, for its four parts.

    An error is an angle, so its derivatives are those of the step that normalises.
    """
    return after(tape, system), sensitivity.by_errors(tape, system)[1]
