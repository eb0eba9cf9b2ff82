"""An extended Kalman filter: attitude and angular velocity from a gyro and a star tracker."""

import numpy as np
from matplotlib.figure import Figure

import derive

COUNT, STEP, EVERY = 5000, 1e-3, 100  # cycles, s; every hundredth cycle has a star tracker
GYRO, STARS, PUSH = 1e-3, 1e-4, 0.01  # rad/s and rad of a reading; N m that nobody knows
inertia, moment = {"I_xx": 1.4, "I_yy": 1.6, "I_zz": 1.8}, np.array([0.02, -0.01, 0.015])
names = ("quaternion_product", "quaternion_exp", "quaternion_error")
product, exp, apart = map(derive.load({"wanted": names}, name="attitudes").function, names)
satellite, noise = derive.load("satellite"), np.random.default_rng(1).standard_normal
step, slopes = (satellite.function(f"step_rk4{s}", inertia) for s in ("", "_tangent_dense"))

true, spin = np.array([1.0, 0, 0, 0]), np.array([0.2, -0.1, 0.3])
q, w, P = exp([0.008, -0.006, 0.004]), np.zeros(3), np.diag([1e-4] * 3 + [0.1] * 3)
errors, sigmas = np.empty((2, COUNT, 3))
for k in range(COUNT):
    true, spin = step(true, spin, moment + PUSH * noise(3), STEP)
    q, w, J = slopes(q, w, moment, STEP)  # J: by small turns of q, by w, by the moment
    P = J[:, :6] @ P @ J[:, :6].T + PUSH**2 * J[:, 6:] @ J[:, 6:].T
    stars = product(true, exp(STARS * noise(3)))
    left = np.array([*apart(q, stars), *(spin + GYRO * noise(3) - w)])
    read = slice(0 if k % EVERY == EVERY - 1 else 3, 6)
    R = np.diag([STARS**2] * 3 + [GYRO**2] * 3)[read, read]
    gain = P[:, read] @ np.linalg.inv(P[read, read] + R)
    error = gain @ left[read]
    q, w, P = product(q, exp(error[:3])), w + error[3:], P - gain @ P[read]
    errors[k], sigmas[k] = 1e6 * apart(true, q), 1e6 * np.sqrt(np.diag(P)[:3])
found, told = (np.sqrt(3 * (each[COUNT // 2 :] ** 2).mean()) for each in (errors, sigmas))
print(f"attitude: {found:.0f} µrad off, {told:.0f} by the covariance")

axes = (figure := Figure(figsize=(6, 3), layout="constrained")).subplots()
times, few = np.arange(COUNT) * STEP, slice(None, None, 20)
axes.plot(times[few], errors[few], label=["about x", "about y", "about z"])
axes.plot(times[few], 3 * sigmas[few, :1] * [1, -1], "k--", label=["3 sigma", None])
axes.set(xlabel="s", ylabel="attitude, µrad off", ylim=(-300, 300))
axes.legend(loc="lower right", ncols=2)
figure.savefig("ekf.svg", metadata={"Date": None})
