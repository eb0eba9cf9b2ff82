"""What the rates of a state rest on: read off their program, or tried in exact numbers."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from derive.motion.attitude.quaternion import product
from derive.motion.runge_kutta.system import System
from derive.program.arithmetic import EXACT
from derive.program.program import Op, Operand, Program
from derive.program.recorded import needed
from derive.program.run import run

TRIALS = 3  # each in exact numbers: two bilinear forms that differ do not agree by chance


def free_omega(system: System) -> slice | None:
    """Return where the angular velocity stands that turns the attitude and never rests on it.

    None if it rests on the attitude, or if no quaternion of the state follows it.
    """
    attitude, omega = system.place("attitude"), system.place("omega")
    if attitude is None or omega is None:
        return None
    names = system.names
    below = closure(system, set(names[omega]))
    free = below.isdisjoint(names[attitude]) and attitude_turns(system)
    return omega if free else None


def closure(system: System, wanted: set[str]) -> set[str]:
    """Return the states that the motion of the ``wanted`` ones rests on, these included."""
    own = dict(zip(system.names, _rests_on(system.rate), strict=True))
    found = set(wanted)
    while more := (set[str]().union(*(own[name] for name in found)) & own.keys()) - found:
        found |= more
    return found


def _rests_on(rate: Program) -> list[set[str]]:
    known: dict[str, set[str]] = {}

    def below(operand: Operand) -> set[str]:
        return known.get(operand, {operand}) if isinstance(operand, str) else set()

    for line in rate.ops:
        if isinstance(line, Op):
            known[line.result] = set[str]().union(*map(below, line.operands))
    return [below(result) for result in rate.results]


def attitude_turns(system: System) -> bool:
    """Tell whether the rate of the attitude q is q (0, omega) / 2, omega among the states."""
    attitude = system.place("attitude")
    if attitude is None:
        return False
    results = system.rate.results[attitude]
    program = replace(system.rate, ops=needed(system.rate.ops, results), results=results)
    return all(_agrees(program, trial) for trial in range(1, TRIALS + 1))


def _agrees(program: Program, trial: int) -> bool:
    names = [c for q in program.inputs for c in q.components]
    values: dict[str, Any] = {
        n: Fraction(7 * k * k + 5 * trial, 3 * k + trial + 1) for k, n in enumerate(names)
    }
    parts = {q.name: [values[c] for c in q.components] for q in program.inputs}
    if not {"attitude", "omega"} <= parts.keys():
        return False
    try:
        found = run(program, EXACT, list(values.values()))
    except KeyError:  # a sine or a root: no such kinematics
        return False
    turns: list[Any] = [0, *parts["omega"]]
    return found == product([q / 2 for q in parts["attitude"]], turns)
