"""What the cheapest trajectory must satisfy, Pontryagin's conditions; and where inputs lead to."""

from dataclasses import dataclass

import casadi
import numpy as np

from derive.control.arcs import DEGREE, Refined, lagrange
from derive.control.direct import Grid
from derive.control.plant import NDFloat, Plant
from derive.control.task import Task

LEAST = 1e-6  # of the running cost: a slope that moves it by less, over all its range, is none
SUBSTEPS = 24  # of RK4 in an element, or a step of a grid


@dataclass(frozen=True)
class Conditions:
    """How well Pontryagin's conditions hold at the nodes; each figure is 0 where they do.

    hamiltonian : how far H is from its mean, and where the time is free from 0, as a part of the
                  mean running cost
    switching   : (inputs, nodes) the slope of H by each input, which has the sign that keeps the
                  input at its limit, and vanishes where it moves
    against     : the largest part of that slope with the wrong sign, or where the input moves, as a
                  part of the largest slope by that input, or of the slope of its own cost
    """

    hamiltonian: float
    switching: NDFloat
    against: float

    @property
    def worst(self) -> float:
        """Return the larger of the two parts."""
        return max(self.hamiltonian, self.against)


def conditions(own: Plant, asked: Task, trajectory: Refined) -> Conditions:
    """Return how well a refined trajectory satisfies what is necessary of one that costs least."""
    x, u = casadi.SX.sym("x", len(own.x)), casadi.SX.sym("u", len(own.u))
    p = casadi.SX.sym("p", len(own.x))
    running = asked.cost["time"] + asked.cost["energy"] * casadi.sumsqr(u)
    H = running + casadi.dot(p, own.rate(x, u))
    at = casadi.Function("H", [x, u, p], [H, casadi.gradient(H, u)])
    stays = np.repeat([a.stays for a in trajectory.arcs], trajectory.elements, axis=0).T
    values, slopes = list[float](), list[NDFloat]()
    for k in range(len(trajectory.lasts)):
        found = at(trajectory.x[:, k + 1], trajectory.at_end(k), trajectory.adjoint[:, k])
        values.append(float(found[0]))
        slopes.append(np.array(found[1]).ravel())
    switching = np.array(slopes).T
    mean = 0.0 if asked.is_free else float(np.mean(values))
    scale = trajectory.cost / trajectory.until
    spent = 2 * asked.cost["energy"] * np.abs(trajectory.u).max(axis=(1, 2))[:, None]
    floor = LEAST * scale / asked.sizes[len(own.x) :, None]
    largest = np.maximum(np.maximum(np.abs(switching).max(axis=1, keepdims=True), spent), floor)
    wrong = np.where(stays == 0, np.abs(switching), np.maximum(switching * stays, 0)) / largest
    return Conditions(
        float(np.abs(np.array(values) - mean).max() / scale), switching, float(wrong.max())
    )


def missed(own: Plant, asked: Task, trajectory: Refined | Grid) -> float:
    """Return the largest component of what should vanish at the end, where the inputs are flown.

    By RK4 in steps so short that they do not count, from the start, by the inputs alone.
    """
    x, h = casadi.SX.sym("x", len(own.x)), casadi.SX.sym("h")
    v = casadi.SX.sym("v", len(own.u), DEGREE)
    after, step = x, h / SUBSTEPS
    for k in range(SUBSTEPS):
        u, m, w = (casadi.mtimes(v, lagrange((k + part) / SUBSTEPS)) for part in (0, 0.5, 1))
        a = own.rate(after, u)
        b = own.rate(after + step / 2 * a, m)
        c = own.rate(after + step / 2 * b, m)
        after += step / 6 * (a + 2 * b + 2 * c + own.rate(after + step * c, w))
    move = casadi.Function("move", [x, v, h], [after])
    at = asked.start
    if isinstance(trajectory, Grid):
        count = trajectory.u.shape[1]
        each = [
            (np.repeat(trajectory.u[:, [k]], DEGREE, axis=1), trajectory.until / count)
            for k in range(count)
        ]
    else:
        each = [(trajectory.u[:, :, k], lasts) for k, lasts in enumerate(trajectory.lasts)]
    for values, lasts in each:
        at = move(at, values, lasts)
    return float(np.abs(np.array(asked.ends(at))).max())
