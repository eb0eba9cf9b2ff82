"""The attitude stays on the sphere by one normalisation a step, not by a term in its kinematics."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.system import System
from derive.program.arithmetic import working
from derive.program.program import Program, Quantity
from derive.program.recorded import called, needed
from derive.program.run import run
from derive.program.tape import Tape
from tests.motion.systems import Values, at, mpf, start, system, without_slopes

U = {np.float32: 2.0**-24, np.float64: 2.0**-53}
FREE = without_slopes(system("principal"))
GAIN = Fraction(10)  # 1/s; ten times more is unstable at h = 0.1 s


def unnormalised(gain: Fraction) -> System:
    """Return the motion with gain (1 - |q|^2) q added to the rate of q (Baumgarte).

    Its attitude has no role of one, so no step takes it for one.
    """
    tape = Tape("t")
    given = {c: tape.input(c) for q in (*FREE.states, *FREE.inputs) for c in q.components}
    rates = called(tape, FREE.rate, given)
    q = [given[c] for c in FREE.names[:4]]
    excess = 1 - (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    pulled = [k + excess * gain * x for k, x in zip(rates[:4], q, strict=True)]
    results = tuple(n.operand for n in (*pulled, *rates[4:]))

    def of_no_role(q: Quantity) -> Quantity:
        return replace(q, role="value") if q.is_quaternion else q

    inputs = tuple(map(of_no_role, FREE.rate.inputs))
    rate = replace(FREE.rate, ops=needed(tape.ops, results), results=results, inputs=inputs)
    return System(tuple(map(of_no_role, FREE.states)), rate)


def tumbling(h: float) -> Values:
    """Return a torque-free body near its intermediate axis, and a length of step."""
    values = dict(start("principal")) | {f"moment_{axis}": mpf(0) for axis in "xyz"}
    values |= {"omega_x": mpf("0.45"), "omega_y": mpf(1), "omega_z": mpf("0.45")}
    return values | {"time_step": mpf(h)}


def run_of(program: Program, values: Values, dtype: type, count: int) -> tuple[np.ndarray, float]:
    """Return the attitude after ``count`` steps, and how far its length ever was from one."""
    now, drift = {c: dtype(float(v)) for c, v in values.items()}, 0.0
    for _ in range(count):
        given = [now[c] for q in program.inputs for c in q.components]
        now |= dict(zip(FREE.names, run(program, working(dtype), given), strict=False))
        q = np.array([float(now[c]) for c in FREE.names[:4]])
        drift = max(drift, abs(float(np.sqrt(q @ q)) - 1))
    return q, drift


@pytest.mark.long
@pytest.mark.parametrize("dtype", U)
@pytest.mark.parametrize("name", ["step_rk4", "step_lie"])
def test_a_normalised_attitude_never_leaves_the_sphere(name: str, dtype: type) -> None:
    _, drift = run_of(step(FREE, name), tumbling(0.01), dtype, 300)
    # a rounding of the scale and one of each component; 2.8 u was met in a million steps
    assert drift <= 3 * U[dtype]


def test_a_term_in_the_kinematics_costs_more_and_does_less() -> None:
    by_term, by_length = step(unnormalised(GAIN), "step_rk4"), step(FREE, "step_rk4")
    assert by_term.flops() >= 1.25 * by_length.flops()  # 284 against 217
    _, drift = run_of(by_term, tumbling(0.1), np.float64, 100)
    assert drift > 1e-6
    _, kept = run_of(by_length, tumbling(0.1), np.float64, 100)
    assert kept <= 3 * U[np.float64]


def test_the_length_says_nothing_of_the_error() -> None:
    true, _ = run_of(step(FREE, "step_rk4"), tumbling(0.0125), np.float64, 400)
    errors = []
    for program in (step(FREE, "step_rk4"), step(unnormalised(Fraction(0)), "step_rk4")):
        q, _ = run_of(program, tumbling(0.1), np.float64, 50)
        errors.append(2 * float(np.linalg.norm(q / np.linalg.norm(q) - true)))
    # what the normalisation takes away is no error of direction
    assert errors[0] == pytest.approx(errors[1], rel=1e-3)


@pytest.mark.long
def test_an_attitude_that_was_not_of_length_one_is_after_a_step() -> None:
    given = without_slopes(system("rigid_body"))
    values = dict(start("rigid_body"))
    values |= {c: values[c] * mpf("1.01") for c in given.names if c.startswith("attitude")}
    after = dict(zip(given.names, at(step(given, "step_rk4"), values), strict=True))
    squared = sum(v**2 for c, v in after.items() if c.startswith("attitude"))
    assert abs(squared - 1) < mpf(10) ** -55
