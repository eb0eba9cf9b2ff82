"""Sample bodies and motions: ordinary bodies, thin rods and bodies that are nearly spheres.

Every number is a double, so that the reference computes with exactly what the code is given.
"""

import math
import random
from collections.abc import Callable

from bench.problem import Problem
from derive.program.added import added

Row = tuple[float, ...]
Triple = tuple[float, float, float]

STEEP = {"heavy_top": (0.2, 2.9), "gyrostat": (-1.3, 1.3)}  # clear of the angles' singularity
SETS = ("ordinary", "rod 1e-6", "near sphere 1e-8")


def samples(problem: Problem, kind: str, count: int) -> list[Row]:
    """Return rows of parameters and inputs of a problem for one of ``SETS``."""
    dice = random.Random(f"{problem.name} {kind}")
    return [(*_parameters(problem, kind, dice), *_inputs(problem, dice)) for _ in range(count)]


def moments(kind: str, dice: random.Random) -> Triple:
    """Return principal moments that a body of this kind can have."""
    if kind == "rod 1e-6":
        thin = 1e-6 * dice.uniform(0.5, 2)
        return (thin, 1 + thin * dice.uniform(0, 1), 1.0)
    if kind == "near sphere 1e-8":
        return (1 + 1e-8 * dice.random(), 1 + 1e-8 * dice.random(), 1 + 1e-8 * dice.random())
    second = [dice.uniform(0.1, 2) for _ in range(3)]
    return (second[1] + second[2], second[2] + second[0], second[0] + second[1])


def tensor(principal: Triple, dice: random.Random) -> Row:
    """Return moments and products (+sum x y dm) of a body turned at random."""
    turn = _turn(_unit(dice, 4))
    entry = [
        [added(turn[i][n] * principal[n] * turn[j][n] for n in range(3)) for j in range(3)]
        for i in range(3)
    ]
    return (*(entry[i][i] for i in range(3)), -entry[0][1], -entry[0][2], -entry[1][2])


def _parameters(problem: Problem, kind: str, dice: random.Random) -> Row:
    principal = moments(kind, dice)
    mass = dice.uniform(0.5, 5)
    rows: dict[str, Callable[[], Row]] = {
        "free_body": lambda: tensor(principal, dice),
        "free_body_principal": lambda: principal,
        "heavy_top": lambda: (principal[1], principal[0], mass, 9.80665, dice.uniform(0.01, 0.1)),
        "gyrostat": lambda: (*tensor(principal, dice), *_wheels(principal, dice)),
        "rigid_body": lambda: (mass, *tensor(principal, dice)),
    }
    return rows[problem.scene]()


def _wheels(principal: Triple, dice: random.Random) -> Row:
    """Return axial moments small enough to leave the carrier's tensor positive."""
    return tuple(dice.uniform(0.1, 0.3) * min(principal) for _ in range(3))


def _inputs(problem: Problem, dice: random.Random) -> Row:
    values: dict[str, float] = dict.fromkeys(problem.inputs, 0.0)
    values = {name: dice.uniform(-1, 1) * _size(name) for name in values}
    if problem.name in STEEP:
        values["theta"] = dice.uniform(*STEEP[problem.name])
    names = [name for name in values if name.startswith("attitude_")]
    values.update(zip(names, _unit(dice, len(names)), strict=True))
    return tuple(values.values())


def _size(name: str) -> float:
    sizes = {"omega": 10, "moment": 1, "force": 10, "position": 100, "velocity": 20}
    return {**sizes, "s": 300, "u": 0.2}.get(name.partition("_")[0], math.pi)


def _unit(dice: random.Random, length: int) -> Row:
    raw = [dice.gauss(0, 1) for _ in range(length)]
    size = math.hypot(*raw)
    return tuple(value / size for value in raw)


def _turn(q: Row) -> list[list[float]]:
    w, x, y, z = q
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
