"""A body on wheels flown in the inertial frame, by its angular momentum: no algebra of a scene.

The state is the attitude, the whole angular momentum along inertial axes and, along its axis, that
of each wheel, of which only the motor on it changes it. Axes of wheels are those of the body.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import derive

Array = NDArray[np.float64]
SUBSTEPS = 100  # of an element


@dataclass(frozen=True)
class Body:
    """Its inertia with wheels locked, that of each wheel about its axis, and what acts on it.

    moment : (time, rotation, inputs) -> along inertial axes
    motors : inputs -> on the wheels
    """

    inertia: Array
    wheels: Array
    moment: Callable[[float, Array, Array], Array]
    motors: Callable[[Array], Array]

    def state(self, omega: Array, spins: Array) -> Array:
        """Return the state of an unturned body, from spins relative to it."""
        own = self.wheels * (omega + spins)
        return np.array([1, 0, 0, 0, *(self.inertia @ omega + self.wheels * spins), *own])

    def rates(self, state: Array) -> tuple[Array, Array, Array]:
        """Return the rotation, the angular velocity along the body, and spins relative to it."""
        turned = rotation(state[:4])
        hub = self.inertia - np.diag(self.wheels)
        omega = np.linalg.solve(hub, turned.T @ state[4:7] - state[7:])
        with np.errstate(divide="ignore", invalid="ignore"):
            return turned, omega, np.where(self.wheels > 0, state[7:] / self.wheels, omega) - omega

    def slope(self, time: float, state: Array, u: Array) -> Array:
        """Return the rate of the state."""
        turned, omega, _ = self.rates(state)
        w, v = state[0], state[1:4]
        attitude = [-v @ omega / 2, *(w * omega + np.cross(v, omega)) / 2]
        return np.array([*attitude, *self.moment(time, turned, u), *self.motors(u)])

    def flown(self, state: Array, found: derive.Trajectory) -> Array:
        """Return the state at the end of the inputs of a trajectory, by classic steps."""
        for begin, lasts in zip(found.times, np.diff(found.times), strict=False):
            step, last = lasts / SUBSTEPS, (begin + lasts) * (1 - 1e-12)
            for t in begin + step * np.arange(SUBSTEPS):
                u, m, n = (found._inputs_at(min(t + part * step, last)) for part in (0, 0.5, 1))
                a = self.slope(t, state, u)
                b = self.slope(t + step / 2, state + step / 2 * a, m)
                c = self.slope(t + step / 2, state + step / 2 * b, m)
                d = self.slope(t + step, state + step * c, n)
                state = state + step / 6 * (a + 2 * b + 2 * c + d)
        return state


def rotation(q: Array) -> Array:
    """Return the matrix from body to inertial axes of a quaternion, whatever its length."""
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
