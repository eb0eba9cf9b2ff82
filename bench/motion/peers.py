"""Peers from packages: SciPy, CasADi's cvodes, heyoka, MuJoCo; each timed on whole motions.

Every peer is given the equations in the form its manual shows, and turns them into code before the
clock starts. A peer that is not installed raises ImportError; one that cannot take a case, or
refuses it, raises NotImplementedError or its own error with a sentence.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from bench.motion.case import Case
from derive.program.added import added

State = list[float]
Run = Callable[[], tuple[State, int]]
SCIPY_LEAST = 2.3e-14  # a smaller relative tolerance is refused with a warning
ROUNDS_BELOW = 0.05  # s; what takes longer is run once, the rest three times


@dataclass(frozen=True)
class Peer:
    """A package: its name in plots, what its setting is, and how a motion by it is prepared."""

    name: str
    package: str
    setting: str  # "tolerance" | "step"
    prepare: Callable[[Case, float], Run]


@dataclass(frozen=True)
class Timed:
    """An end state (q, omega), the steps taken and the seconds of the fastest run."""

    state: State
    passes: int
    seconds: float


def timed(prepared: Run) -> Timed:
    """Run a prepared motion, three times if it is quick."""
    found: list[Timed] = []
    while len(found) < 3 and (not found or found[0].seconds < ROUNDS_BELOW):
        before = time.perf_counter()
        state, passes = prepared()
        found.append(Timed(state, passes, time.perf_counter() - before))
    return min(found, key=lambda t: t.seconds)


def scipy_dop853(case: Case, tolerance: float) -> Run:
    """Prepare SciPy's solve_ivp with its DOP853."""
    import numpy as np
    from scipy.integrate import solve_ivp

    rate, start = _rate_numpy(case), np.array([*map(float, case.q0), *map(float, case.omega0)])
    relative = max(tolerance, SCIPY_LEAST)

    def go() -> tuple[State, int]:
        span = (0.0, float(case.time))
        done = solve_ivp(rate, span, start, "DOP853", rtol=relative, atol=tolerance)
        return [float(x) for x in done.y[:, -1]], int(done.nfev) // 12

    return go


def casadi_cvodes(case: Case, tolerance: float) -> Run:
    """Prepare CasADi's interface to cvodes, with the equations in SX."""
    import casadi as ca

    y = ca.SX.sym("y", 7)
    rate = ca.vertcat(*_rates(case, ca.vertsplit(y)))
    options = {"reltol": tolerance, "abstol": tolerance, "max_num_steps": 10_000_000}
    end = float(case.time)
    integrator = ca.integrator("motion", "cvodes", {"x": y, "ode": rate}, 0.0, end, options)
    start = ca.DM([*map(float, case.q0), *map(float, case.omega0)])

    def go() -> tuple[State, int]:
        state = [float(x) for x in ca.vertsplit(integrator(x0=start)["xf"])]
        return state, int(integrator.stats().get("nsteps", 0))

    return go


def heyoka_taylor(case: Case, tolerance: float) -> Run:
    """Prepare heyoka's adaptive Taylor integrator, compiled for this case and tolerance."""
    import heyoka as hy

    names = [*(f"q{n}" for n in range(4)), *(f"w{n}" for n in range(3))]
    y = hy.make_vars(*names)
    rates = _rates(case, list(y))
    start = [*map(float, case.q0), *map(float, case.omega0)]
    motion = hy.taylor_adaptive(list(zip(y, rates, strict=True)), state=start, tol=tolerance)

    def go() -> tuple[State, int]:
        motion.time = 0.0
        motion.state[:] = start
        steps = motion.propagate_until(float(case.time))[3]
        return [float(x) for x in motion.state], int(steps)

    return go


def mujoco_rk4(case: Case, step: float) -> Run:
    """Prepare MuJoCo's RK4: a free body, a constant moment through qfrc_applied."""
    import mujoco

    if any(case.wheel):
        raise NotImplementedError("a wheel of constant momentum is no part of its models")
    if any(case.weight):
        raise NotImplementedError("only the free body was modelled")
    mujoco.set_mju_user_warning(lambda _: None)  # else it leaves a file of warnings behind
    model = mujoco.MjModel.from_xml_string(_mujoco_xml(case, step))
    data = mujoco.MjData(model)
    steps = round(float(case.time) / step)

    def go() -> tuple[State, int]:
        mujoco.mj_resetData(model, data)
        data.qpos[3:7] = [float(x) for x in case.q0]
        data.qvel[3:6] = [float(x) for x in case.omega0]
        data.qfrc_applied[3:6] = [float(x) for x in case.moment]
        mujoco.mj_step(model, data, steps)
        return [*map(float, data.qpos[3:7]), *map(float, data.qvel[3:6])], steps

    return go


def _mujoco_xml(case: Case, step: float) -> str:
    tensor = " ".join(repr(float(x)) for x in case.inertia)
    return f"""<mujoco>
  <option timestep="{step!r}" gravity="0 0 0" integrator="RK4"/>
  <worldbody><body><freejoint/>
    <inertial pos="0 0 0" mass="1" fullinertia="{tensor}"/>
  </body></worldbody>
</mujoco>"""


def _rate_numpy(case: Case) -> Callable[[float, Any], Any]:
    import numpy as np

    xx, yy, zz, xy, xz, yz = (float(x) for x in case.inertia)
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    inverse = np.linalg.inv(inertia)
    moment, wheel, weight = (_floats(x) for x in (case.moment, case.wheel, case.weight))

    def rate(_: float, y: Any) -> Any:
        q, w = y[:4], y[4:]
        load = _cross([a + b for a, b in zip(inertia @ w, wheel, strict=True)], w)
        down = _cross(_third_row(q), weight)
        omega_dot = inverse @ [a + b + c for a, b, c in zip(load, moment, down, strict=True)]
        return [*_attitude_rate(q, w), *omega_dot]

    return rate


def _rates(case: Case, y: Sequence[Any]) -> list[Any]:
    """Return the rates of attitude and omega as expressions of any package."""
    q, w = list(y[:4]), list(y[4:])
    xx, yy, zz, xy, xz, yz = _floats(case.inertia)
    wheel, weight = _floats(case.wheel), _floats(case.weight)
    if case.principal:
        load = [(yy - zz) * w[1] * w[2], (zz - xx) * w[2] * w[0], (xx - yy) * w[0] * w[1]]
    else:
        rows = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
        load = _cross([added(a * b for a, b in zip(r, w, strict=True)) for r in rows], w)
    load = [a + b for a, b in zip(load, _floats(case.moment), strict=True)]
    if any(wheel):
        load = [a + b for a, b in zip(load, _cross(wheel, w), strict=True)]
    if any(weight):
        load = [a + b for a, b in zip(load, _cross(_third_row(q), weight), strict=True)]
    if case.principal:
        return [*_attitude_rate(q, w), load[0] / xx, load[1] / yy, load[2] / zz]
    inverse = _inverse(xx, yy, zz, xy, xz, yz)
    omega_dot = [added(a * b for a, b in zip(r, load, strict=True)) for r in inverse]
    return [*_attitude_rate(q, w), *omega_dot]


def _attitude_rate(q: Sequence[Any], w: Sequence[Any]) -> list[Any]:
    return [
        (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) * -0.5,
        (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) * 0.5,
        (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) * 0.5,
        (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) * 0.5,
    ]


def _third_row(q: Sequence[Any]) -> list[Any]:
    """Return the inertial z axis along body axes."""
    a, b, c, d = q
    return [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d]


def _inverse(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> list[list[float]]:
    rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    adjugate = [_cross(rows[1], rows[2]), _cross(rows[2], rows[0]), _cross(rows[0], rows[1])]
    determinant = added(a * b for a, b in zip(rows[0], adjugate[0], strict=True))
    return [[x / determinant for x in row] for row in adjugate]


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def _floats(values: Sequence[Any]) -> list[float]:
    return [float(x) for x in values]


PEERS = (
    Peer("heyoka (Taylor)", "heyoka", "tolerance", heyoka_taylor),
    Peer("CasADi cvodes", "casadi", "tolerance", casadi_cvodes),
    Peer("SciPy DOP853", "scipy", "tolerance", scipy_dop853),
    Peer("MuJoCo RK4", "mujoco", "step", mujoco_rk4),
)
