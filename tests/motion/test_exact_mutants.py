"""The states that judge the exact motion notice every operation of it that is not what it is."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from derive.program.arithmetic import working
from derive.program.program import Op, Program
from derive.program.run import run
from tests.motion.free import Rows, flow

pytestmark = pytest.mark.long

FLIPPED = {"add": "sub", "sub": "add", "mul": "div", "div": "mul", "sin": "cos", "cos": "sin"}
FLOATS = working(np.float64) | {"sin": np.sin, "cos": np.cos}  # of numpy: many, and soon done
SEEN = 1e-11  # a thousand times what rounding adds to the states below


# Left alone are: a sign divided by instead of multiplied with (5); the choice between two ways to
# one rate (1), of what to scale by (6), and two guards (2), which matter to rounding and to traps
# only; and factors of the last rungs, where means that start 2^-536 apart have become equal but
# for 1e-11 (24).
KNOWN = 38
ANY = 20
SPECIAL = (  # moments, rates, time
    ((3, 4, 6), (2, 1, 1), 3),  # on the separatrix
    ((3, 4, 6), (2, 1, 1), 300),  # and there long after the motion is over, or before it began
    ((3, 4, 6), (2, -1, 1), -300),
    ((2, 2, 2), (0.5, -1, 2), 7),
    ((1, 1, 2), (1, 1, 0), 3),
    ((1, 2, 2), (0, 1, 0), 3),
    ((2, 1, 1), (1, 2, 3), -5),
    ((3, 1, 2), (-1, 0, 0), 5),
    ((3, 1, 2), (0, -1, 0), 5),
    ((3, 1, 2), (0, 0, -1), 5),
    ((1, 2, 3), (0, 0, 0), 5),
    ((1, 2, 3), (1e160, -2e160, 3e160), 2e-160),
    ((1, 2, 3), (1e-160, -2e-160, 3e-160), 2e160),
    ((1, 2, 3), (2.0**-20, -1, 0), 30),
    ((1, 2, 3), (2.0**-20, 1, 0), 41),
    ((1, 2, 3), (2.0**-60, 1, 0), 131),
    ((1, 2, 3), (2.0**-150, 1, 0), 317),
    ((1, 2, 3), (2.0**-250, 1, 0), 530),
    ((1, 2, 3), (2.0**-400, 1, 0), 840),
    ((1, 2, 3), (2.0**-536, 1, 0), 200),
    ((1, 2, 3), (2.0**-536, 1, 0), 500),
    ((1, 2, 3), (2.0**-536, 1, 0), 900),
)
COUNT = ANY + len(SPECIAL)


def judges() -> tuple[Rows, Rows]:
    """Return bodies and states of every branch, and of no branch in particular."""
    dice = np.random.default_rng(5)
    tensors, states = np.zeros((COUNT, 6)), dice.normal(size=(COUNT, 8))
    tensors[:ANY, :3] = dice.uniform(1, 3, (ANY, 3))
    for n, (moments, rates, time) in enumerate(SPECIAL, start=ANY):
        tensors[n, :3], states[n, 4:7], states[n, 7] = moments, rates, time
    return tensors, states


def mutants_of(op: Op) -> Iterator[Op]:
    """Yield an operation flipped, without a term or factor, and with its operands exchanged."""
    if op.operator in FLIPPED:
        yield replace(op, operator=FLIPPED[op.operator])
    if len(op.operands) == 2 and op.operator in FLIPPED:
        first, second = op.operands
        neutral = Fraction(op.operator in ("mul", "div"))
        yield replace(op, operands=(first, neutral))
        yield replace(op, operands=(neutral, second))
    if op.operator in ("less", "at_most"):
        yield replace(op, operands=op.operands[::-1])
    if op.operator == "select":
        yield replace(op, operands=(op.operands[0], op.operands[2], op.operands[1]))
        yield replace(op, operands=(op.operands[0], op.operands[1], op.operands[1]))
        yield replace(op, operands=(op.operands[0], op.operands[2], op.operands[2]))
    if op.operator in ("abs", "sqrt", "neg"):
        yield Op(op.result, "add", (op.operands[0], Fraction(0)))


def mutants(program: Program) -> Iterator[Program]:
    """Yield the program with each operation changed in every way."""
    for place, op in enumerate(program.ops):
        for other in mutants_of(op) if isinstance(op, Op) else ():
            if other != op:
                yield replace(program, ops=(*program.ops[:place], other, *program.ops[place + 1 :]))


def ends(program: Program, given: list[Any]) -> Rows:
    with np.errstate(all="ignore"):
        return np.stack([np.broadcast_to(x, COUNT) for x in run(program, FLOATS, given)])


def test_every_operation_but_a_few_known_ones_matters() -> None:
    tensors, states = judges()
    motion = flow("principal")
    given = [*motion.constants(np.float64, tensors), *states.T]
    true = ends(motion.function, given)
    seen = np.full_like(true, SEEN)
    seen[4:] *= np.maximum(np.max(np.abs(true[4:]), axis=0), 2.0**-1000)
    every = list(mutants(motion.function))
    with np.errstate(all="ignore"):
        left = [m for m in every if np.all(np.abs(ends(m, given) - true) < seen)]
    assert len(every) > 2000
    assert len(left) <= KNOWN
