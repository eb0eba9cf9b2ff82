"""Nonlinear model predictive control: a tumbling satellite, 40 steps ahead, ten times a second."""

import sys
import tomllib

import casadi as ca
import numpy as np
from matplotlib.figure import Figure

import derive

N, STEP, COUNT, LIMIT, inertia = 40, 0.1, 80, 0.4, [1.4, 1.6, 1.8]  # steps, s, cycles, N m, kg m^2
wanted = {"wanted": ["step_rk4_unit", "step_rk4_unit_jacobian"]}
scene = derive.load(tomllib.loads(derive.load("satellite").scene.text) | wanted, name="satellite")
scene.generate("generated", samples=256, parts="casadi-external")
sys.path.append("generated/satellite")
model = __import__("satellite_casadi")
x, u, now = ca.MX.sym("x", 7, N + 1), ca.MX.sym("u", 3, N), ca.MX.sym("now", 7)
target, most = [1, 0, 0, 0, 0, 0, 0], np.repeat([np.inf, LIMIT], [7 * (N + 1), 3 * N])
error = model.error().map(N + 1)(x, ca.repmat(target, 1, N + 1))
cost = STEP * (ca.sumsqr(error) + 0.1 * ca.sumsqr(u)) + 10 * ca.sumsqr(error[:, N])
gaps = x - ca.horzcat(now, model.external(N)(x[:, :-1], u, STEP, inertia))
warm = {"print_level": 0, "sb": "yes", "warm_start_init_point": "yes", "mu_init": 1e-4}
problem = {"x": ca.veccat(x, u), "p": now, "f": cost, "g": ca.vec(gaps)}
solver = ca.nlpsol("solver", "ipopt", problem, {"print_time": False, "ipopt": warm})
at, plan = [0.6, 0.64, 0, 0.48, 0.2, -0.4, 0], {"x0": np.r_[target * (N + 1), [0] * 3 * N]}
turns, told, noise = [], [], np.random.default_rng(1).standard_normal
for _ in range(COUNT):
    found = solver(**plan, p=at, lbx=-most, ubx=most, lbg=0, ubg=0)
    plan = {"x0": found["x"], "lam_x0": found["lam_x"], "lam_g0": found["lam_g"]}
    moment, turns = found["x"][7 * (N + 1) :][:3], [*turns, solver.stats()["iter_count"]]
    told.append([np.degrees(model.error()(at, target).full()[:3, 0]), moment.full().ravel()])
    at = model.step()(at, moment + 0.02 * noise(3), STEP, 1.05 * np.array(inertia))  # none knows it
print(f"{abs(told[-1][0]).max():.1f} degrees off; {np.mean(turns[1:]):.0f} iterations a cycle")
axes = (figure := Figure(figsize=(6, 4), layout="constrained")).subplots(2, sharex=True)
for own, lines, label in zip(axes, np.swapaxes(told, 0, 1), ("degrees off", "N m"), strict=True):
    own.step(np.arange(COUNT) * STEP, lines, where="post", label=["x", "y", "z"])
    own.set(xlabel="s", ylabel=label)
axes[0].legend()
figure.savefig("nmpc.svg", metadata={"Date": None})
