"""A step that carries a remainder is the same step; long runs of small ones keep their digits."""

from typing import Any

import numpy as np
import pytest

from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.system import System
from derive.program.arithmetic import working
from derive.program.program import Program
from derive.program.run import run
from tests.motion.systems import CONTEXT, EVERY, Values, at, mpf, start, system
from tests.motion.test_step_jacobian import EXACTLY, case

pytestmark = pytest.mark.long

COUNTS = {"rk4": 1500, "lie": 400}  # numpy takes a second for either


def pair(given: System, kind: str) -> tuple[Program, Program]:
    """Return a step, and the one that carries a remainder."""
    return step(given, f"step_{kind}"), step(given, f"step_{kind}_compensated")


def with_remainder(values: Values) -> dict[str, Any]:
    """Return values with remainders of zero."""
    return dict(values) | {f"remainder_{c}": values[c] * 0 for c in values if c != "time_step"}


@pytest.mark.parametrize("name", [*EVERY, "hung"])
@pytest.mark.parametrize("kind", COUNTS)
def test_it_is_the_same_step(kind: str, name: str) -> None:
    given, values = case(name)
    if kind == "lie" and given.quaternion is None:
        pytest.skip("no quaternion, no such step")
    plain, carrying = pair(given, kind)
    after = at(carrying, with_remainder(values))
    count = len(given.names)
    pairs = zip(at(plain, values), after[:count], after[count:], strict=True)
    assert max(abs(a - b) + abs(rest) for a, b, rest in pairs) < EXACTLY


def errors(program: Program, count: int, values: Values) -> list[float]:
    """Return how far a run in float ends from the same run in double, in units of u."""
    names = [c for q in program.inputs for c in q.components]
    ends = []
    for kind in (np.float32, np.float64):
        now = {c: kind(np.float32(float(v))) for c, v in with_remainder(values).items()}
        outputs = [c.removesuffix("_next") for q in program.outputs for c in q.components]
        for _ in range(count):
            found = run(program, working(kind), [now[c] for c in names])
            now |= dict(zip(outputs, found, strict=True))
        ends.append([float(now[c]) for c in system("principal").names])
    pairs = zip(*ends, strict=True)
    return [abs(a - b) / 2.0**-24 for a, b in pairs]


@pytest.mark.parametrize("kind", COUNTS)
def test_a_long_run_of_small_steps_keeps_its_digits(kind: str) -> None:
    values = dict(start("principal")) | {f"moment_{axis}": mpf(0) for axis in "xyz"}
    values |= {"omega_x": mpf("0.45"), "omega_y": mpf(1), "omega_z": mpf("0.45")}
    values |= {"time_step": CONTEXT.mpf(1) / 1024}
    plain, carrying = pair(system("principal"), kind)
    kept, lost = (max(errors(made, COUNTS[kind], values)) for made in (carrying, plain))
    # each sum that carries errs by one rounding at the end; the rest is in the small increments
    assert kept <= 4
    assert lost > 2.5 * kept


def test_an_attitude_off_the_sphere_is_brought_back() -> None:
    given, values = case("principal")
    off = with_remainder(values)
    off |= {c: v * mpf("1.01") for c, v in off.items() if c.startswith("attitude_")}
    for kind in COUNTS:
        after = at(pair(given, kind)[1], off)
        assert abs(sum(x * x for x in after[:4]) - 1) < mpf(10) ** -50
