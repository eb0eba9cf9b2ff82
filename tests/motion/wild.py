"""Bodies and states of every make: moments and rates of any size, equal, nearly equal and none."""

from collections.abc import Sequence
from typing import Any

import flint
import numpy as np

from derive.program.arithmetic import MANTISSA
from derive.program.run import run
from derive.verify.operators import LONG_FLOATS
from tests.motion.free import FACTOR, LEAST, Flow, Rows, apart, errors

BITS = 500  # of motions without rounding
STEP = 2.0**-60  # relative, of the differences that conditions are made of
PHASES = (0.0, 1e-3, 1.0, 30.0, 1e3)  # rad by the largest rate, about
EXPONENTS = {np.float32: 30, np.float64: 270}  # a body's moments are 2^-e to 2^e of one another


def wild(dice: np.random.Generator, count: int, dtype: type) -> tuple[Rows, Rows]:
    """Return tensors (n, 6) and states (n, 8), floats of ``dtype``, of every make at random."""
    tensors, states = np.zeros((count, 6)), np.zeros((count, 8))
    for n in range(count):
        tensors[n, :3] = dice.permutation(_moments(dice, dtype))
        states[n, :4] = 1, 0, 0, 0
        states[n, 4:7] = rates = _rates(dice, dtype)
        fast = max(map(abs, rates))
        turn = dice.choice(PHASES) * dice.uniform(0.5, 1) * dice.choice((-1, 1))
        limit = float(np.finfo(dtype).max)
        states[n, 7] = turn / fast if abs(turn) < limit * fast else turn
    return tensors.astype(dtype).astype(float), states.astype(dtype).astype(float)


def _moments(dice: np.random.Generator, dtype: type) -> tuple[float, float, float]:
    """Return moments from squares of distances along three axes, each of which may be nearly none.

    One body in eight is none that exists: its largest moment exceeds the sum of the others.
    """
    ends = (0.0, 1.0, 0.5, float(dice.uniform()), _small(dice, dtype), 1 - _small(dice, dtype))
    share, less = float(dice.choice(ends)), float(dice.choice((0.0, *ends[4:], ends[3])))
    a, b, c = max(share, 2.0 ** -EXPONENTS[dtype]), 1.0, less
    scale = 2.0 ** float(dice.integers(-20, 20))
    longer = 2.0 ** -float(dice.integers(1, 12)) if dice.random() < 0.125 else 1.0
    return scale * (b + c) / longer, scale * (c + a) * longer, scale * (a + b)


def _rates(dice: np.random.Generator, dtype: type) -> list[float]:
    least = -float(np.log2(float(np.finfo(dtype).smallest_subnormal)))
    sizes = (0.0, 1.0, float(dice.uniform()), 2.0 ** -dice.uniform(0, least), _small(dice, dtype))
    signs = dice.choice((-1, 1), 3)
    scale = float(dice.choice((1.0, 1.0, 2.0 ** dice.uniform(-least / 3, least / 3))))
    return [float(dice.choice(sizes) * s * scale * dice.uniform(0.5, 1)) for s in signs]


def _small(dice: np.random.Generator, dtype: type) -> float:
    return 2.0 ** -float(dice.integers(1, EXPONENTS[dtype])) * dice.uniform(0.5, 1)


def share_of_error(motion: Flow, dtype: type, tensor: Any, state: Any, found: Any) -> float:
    """Return how much of the error that rounding of the inputs excuses an end uses up.

    A body that breaks the triangle inequality may turn little while its phase runs far: there
    the phase counts as well, |l| (1 / I_1 - 1 / I_3) |t| rad at most.
    """
    u, factor = 2.0 ** -MANTISSA[dtype], FACTOR[dtype]
    with flint.ctx.workprec(BITS):
        true = without_rounding(motion, tensor, state)
        kappas = _conditions(motion, dtype, tensor, state, true)
    least, middle, most = sorted(tensor[:3])
    unreal = most > (least + middle) * (1 + 8 * u)
    turn = np.linalg.norm(tensor[:3] / most * (state[4:7] * state[7]))  # no square of a tiny rate
    phase = 2 * turn * (most / least - 1) if unreal else 0  # a constant and three products, halved
    allowed = [max(factor * (kappa + phase), LEAST) * u for kappa in kappas]
    if not np.all(np.isfinite(np.asarray(found, float))):
        return float("inf")
    return max(e / a for e, a in zip(errors(found, true), allowed, strict=True))


def without_lost_rates(dtype: type, tensors: Rows, states: Rows) -> Rows:
    """Return the states without rates that the type cannot hold beside the largest of them."""
    least = float(np.finfo(dtype).smallest_normal) * 2.0 ** MANTISSA[dtype]
    spread = np.max(tensors[:, :3], axis=1) / np.min(tensors[:, :3], axis=1)
    fast = np.maximum(1, np.max(np.abs(states[:, 4:7]), axis=1))
    kept, lost = states.copy(), np.abs(states[:, 4:7]) < (least * spread * fast)[:, None]
    kept[:, 4:7][lost] = 0
    return kept


def without_rounding(motion: Flow, tensor: Sequence[Any], state: Sequence[Any]) -> list[Any]:
    """Return the end (7,) by the programs in ``BITS`` bits."""
    with flint.ctx.workprec(BITS):
        body, given = ([flint.arb(x) for x in values] for values in (tensor, state))
        return run(motion.function, LONG_FLOATS, [*run(motion.setup, LONG_FLOATS, body), *given])


def _conditions(
    motion: Flow, dtype: type, tensor: Any, state: Any, true: Sequence[Any]
) -> list[float]:
    """Return the errors of attitude and rates over those of the inputs, each by its spacing.

    Rates are worked with as momentum over the largest, so one may be spaced as the smallest
    numbers are, times the largest rate and the ratio of two moments.
    """
    least = float(np.finfo(dtype).smallest_subnormal) * 2.0 ** MANTISSA[dtype]
    floor = flint.arb(least) * max(1.0, *(abs(float(x)) for x in state[4:7]))
    floor *= float(max(tensor[:3]) / min(tensor[:3]))
    found = [0.0, 0.0]
    for place in (0, 1, 2, 10, 11, 12, 13):  # the moments, the rates and the time
        given = [flint.arb(float(x)) for x in (*tensor, *state)]
        size = abs(given[place])
        unit = flint.arb.max(size, floor) if 9 < place < 13 else size
        given[place] += unit * STEP
        changed = without_rounding(motion, given[:6], given[6:])
        for n, error in enumerate(apart(changed, true)):
            found[n] += error / STEP
    return found
