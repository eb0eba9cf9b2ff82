"""Scenes whose steps are tested, values to step from, and sixty digits to step in."""

from __future__ import annotations

import operator
import random
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath

from derive.library.library import Library, library
from derive.motion.runge_kutta.system import System
from derive.program.program import Program
from derive.program.run import run
from derive.scene import parse_scene
from tests.made import library_of

CONTEXT = mpmath.MPContext()
CONTEXT.dps = 60
mpf = CONTEXT.mpf

PRINCIPAL = """
title  = "Body along its principal axes, attitude by a quaternion"
wanted = ["state_rate", "state_rate_jacobian"]

[parameters]
I_xx = { unit = "kg m^2", range = [1.2, 1.6], meaning = "principal moment of inertia about x" }
I_yy = { unit = "kg m^2", range = [1.4, 1.8], meaning = "principal moment of inertia about y" }
I_zz = { unit = "kg m^2", range = [1.6, 2.0], meaning = "principal moment of inertia about z" }

[axes]
fixed_in = "body"
attitude = "quaternion"

[body]
kind    = "principal"
moments = ["I_xx", "I_yy", "I_zz"]

[known]
angular_velocity = { range = [-10, 10] }
moment           = { range = [-10, 10] }
"""
CATALOGUE = ("rigid_body", "gyrostat", "heavy_top")
EVERY = ("principal", *CATALOGUE)

SIXTY_DIGITS: Mapping[str, Any] = {
    "number": lambda q: mpf(q.numerator) / q.denominator,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "abs": abs,
    "sqrt": CONTEXT.sqrt,
    "sin": CONTEXT.sin,
    "cos": CONTEXT.cos,
    "less": operator.lt,
    "at_most": operator.le,
    "select": lambda condition, yes, no: yes if condition else no,
    "both": lambda a, b: a and b,
    "either": lambda a, b: a or b,
    "splitter": lambda: mpf(2) ** 100 + 1,
    "power_of_two": lambda x: mpf(2) ** int(CONTEXT.floor(CONTEXT.log(x, 2))),
}
Values = Mapping[str, Any]


def made(name: str) -> Library:
    """Return the programs of a scene."""
    return _principal() if name == "principal" else library_of(name)


@cache
def _principal() -> Library:
    return library(parse_scene(PRINCIPAL, "principal"))


@cache
def system(name: str) -> System:
    """Return the motion of a scene with its Jacobian."""
    found = made(name)
    return System(found.vocabulary.states, found["state_rate"], found["state_rate_jacobian"])


def without_slopes(given: System) -> System:
    """Return a motion of which no derivatives are wanted."""
    return replace(given, slopes=None)


@cache
def start(name: str, seed: int = 1) -> Values:
    """Return constants, a state and inputs within their ranges, and a step of 0.05 s."""
    found, rest = made(name), random.Random(seed)
    drawn = {
        c: mpf(rest.uniform(float(q.low or 0), float(q.high or 0)))
        for q in (*found.vocabulary.parameters, *system(name).states, *system(name).inputs)
        for c in q.components
    }
    given = [drawn[c] for q in found.setup.inputs for c in q.components]
    constants = run(found.setup, SIXTY_DIGITS, given)
    names = [c for q in found.setup.outputs for c in q.components]
    return unit(drawn) | dict(zip(names, constants, strict=True)) | {"time_step": mpf("0.05")}


def unit(values: Values) -> dict[str, Any]:
    """Return values with an attitude quaternion, if there is one, of length one."""
    parts = [c for c in values if c.startswith("attitude_")]
    length = CONTEXT.sqrt(sum(values[c] ** 2 for c in parts)) if parts else 1
    return dict(values) | {c: values[c] / length for c in parts}


def at(program: Program, values: Values) -> list[Any]:
    """Return the results of a program in sixty digits."""
    return run(program, SIXTY_DIGITS, [values[c] for q in program.inputs for c in q.components])


def stepped(program: Program, names: Sequence[str], values: Values, count: int) -> Values:
    """Return the values after ``count`` steps."""
    now = dict(values)
    for _ in range(count):
        now |= dict(zip(names, at(program, now), strict=False))
    return now


def flowed(given: System, values: Values, time: Any, rows: int = 14) -> list[Any]:
    """Return the state after ``time`` by midpoint steps, extrapolated (Gragg; Bulirsch, Stoer)."""
    table: list[list[Any]] = []
    for row in range(rows):
        line = [_midpoint(given, values, time, 2 * row + 2)]
        for k, before in enumerate(table[-1] if table else []):
            ratio = (
                mpf(Fraction(row + 1, row - k).numerator) / Fraction(row + 1, row - k).denominator
            )
            line.append(
                [a + (a - b) / (ratio**2 - 1) for a, b in zip(line[k], before, strict=True)]
            )
        table.append(line)
    return table[-1][-1]


def _midpoint(given: System, values: Values, time: Any, count: int) -> list[Any]:
    def rate(state: Sequence[Any]) -> list[Any]:
        return at(given.rate, dict(values) | dict(zip(given.names, state, strict=True)))

    step = time / count
    old = [values[c] for c in given.names]
    new = [y + step * k for y, k in zip(old, rate(old), strict=True)]
    for _ in range(count - 1):
        old, new = new, [y + 2 * step * k for y, k in zip(old, rate(new), strict=True)]
    return [(y + z + step * k) / 2 for y, z, k in zip(old, new, rate(new), strict=True)]
