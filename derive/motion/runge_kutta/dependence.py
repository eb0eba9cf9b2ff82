"""What the rates of a state rest on: read off their program, or tried in exact numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from derive.motion.attitude.quaternion import product
from derive.motion.runge_kutta.system import System
from derive.program.arithmetic import EXACT
from derive.program.program import Op, Operand, Program, placed
from derive.program.recorded import needed
from derive.program.run import run

TRIALS = 3  # each in exact numbers: two bilinear forms that differ do not agree by chance


def free_omega(system: System) -> slice | None:
    """Return where the angular velocity stands that turns the attitude and never rests on it.

    None if it rests on the attitude, or if no quaternion of the state follows it.
    """
    places = attitude_and_omega(system)
    if places is None:
        return None
    attitude, omega = places
    names = system.names
    return omega if closure(system, set(names[omega])).isdisjoint(names[attitude]) else None


def closure(system: System, wanted: set[str]) -> set[str]:
    """Return the states that the motion of the ``wanted`` ones rests on, these included."""
    own = dict(zip(system.names, rests_on(system.rate), strict=True))
    found = set(wanted)
    while more := (set[str]().union(*(own[name] for name in found)) & own.keys()) - found:
        found |= more
    return found


def rests_on(program: Program) -> list[set[str]]:
    """Return the inputs that each result rests on."""
    known: dict[str, set[str]] = {}

    def below(operand: Operand) -> set[str]:
        return known.get(operand, {operand}) if isinstance(operand, str) else set()

    for line in program.ops:
        if isinstance(line, Op):
            known[line.result] = set[str]().union(*map(below, line.operands))
    return [below(result) for result in program.results]


def attitude_and_omega(system: System) -> tuple[slice, slice] | None:
    """Return where the attitude q stands and the omega by which its rate is q (0, omega) / 2.

    None if the state has no single attitude, or no three components that turn it so.
    """
    attitude = system.quaternion
    if attitude is None:
        return None
    results = system.rate.results[attitude]
    program = replace(system.rate, ops=needed(system.rate.ops, results), results=results)
    vectors = (place for q, place in placed(system.states) if q.shape == (3,))
    turns = (v for v in vectors if _turns(program, system.names[attitude], system.names[v]))
    return next(((attitude, omega) for omega in turns), None)


def _turns(program: Program, attitude: Sequence[str], omega: Sequence[str]) -> bool:
    return all(_agrees(program, attitude, omega, trial) for trial in range(1, TRIALS + 1))


def _agrees(program: Program, attitude: Sequence[str], omega: Sequence[str], trial: int) -> bool:
    names = [c for q in program.inputs for c in q.components]
    values: dict[str, Any] = {
        n: Fraction(7 * k * k + 5 * trial, 3 * k + trial + 1) for k, n in enumerate(names)
    }
    if not values.keys() >= {*attitude, *omega}:
        return False
    try:
        found = run(program, EXACT, list(values.values()))
    except KeyError:  # a sine or a root: no such kinematics
        return False
    turns: list[Any] = [0, *(values[c] for c in omega)]
    return found == product([values[c] / 2 for c in attitude], turns)
