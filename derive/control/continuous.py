"""Finite problems of arcs, solved to the last digits: by IPOPT, and arcs without jumps by steps."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import casadi
import numpy as np

from derive.control.direct import QUIET, quietly, why_not
from derive.control.plant import NDFloat

TOLERANCE = 1e-11
DELTA = 1e-4  # of the time: by so much a part is changed to see what follows
EVEN = 1e-9  # of an input's size: a jump that is none
BROYDEN = 20  # steps at most
OPTIONS = {
    "print_level": 0, "sb": "yes", "max_iter": 150, "tol": TOLERANCE, "mu_init": 1e-5,
    "max_cpu_time": 20.0,  # s: where it does not converge, it can search long
    "constr_viol_tol": TOLERANCE, "acceptable_tol": 1e-8, "bound_relax_factor": 0.0,
}  # fmt: skip

Found = tuple[NDFloat, NDFloat, int, str]  # the unknowns, multipliers, turns, why there are none


def solver(problem: Mapping[str, Any]) -> Callable[..., Found]:
    """Return what solves a problem between limits of its unknowns, and of its constraints."""
    options: dict[str, Any] = {**QUIET, "expand": True, "ipopt": OPTIONS}
    made = casadi.nlpsol("arcs", "ipopt", dict(problem), options)

    def solved(box: Sequence[NDFloat], kept: Sequence[Any], parts: Any = ()) -> Found:
        first, least, most = box
        found = quietly(made, x0=first, lbx=least, ubx=most, lbg=kept[0], ubg=kept[1], p=parts)
        told = made.stats()
        why = "" if told["success"] else why_not(told)
        at, multipliers = (np.array(found[key]).ravel() for key in ("x", "lam_g"))
        return at, multipliers, told["iter_count"], why

    return solved


def continuous(
    problem: Mapping[str, Any], box: Sequence[NDFloat], lengths: Any, jumps: Any
) -> Found:
    """Return what is cheapest where inputs come to their limits without a jump.

    The cost hardly changes with the times at which they do. So these are given, as parts of the
    whole, inputs that move have no limits, and Broyden's steps find the parts at which none jumps.
    """
    first, least, most = box
    count = lengths.numel()
    parts = casadi.MX.sym("p", count - 1)
    whole = casadi.sum1(lengths)
    shares = [lengths[k] - parts[k] * whole for k in range(count - 1)]
    solved = solver({**problem, "g": casadi.vertcat(problem["g"], *shares), "p": parts})
    endless = np.full(len(first), np.inf)
    ends = [
        np.where(least == most, side, far) for side, far in ((least, -endless), (most, endless))
    ]
    jump = casadi.Function("jump", [problem["x"]], [jumps])
    at = first[: count - 1] / first[:count].sum()
    found = solved((first, *ends), (0, 0), at)
    left, slope = np.array(jump(found[0])).ravel(), np.empty((count - 1, count - 1))
    for k in range(count - 1):
        beside = solved((found[0], *ends), (0, 0), at + DELTA * np.eye(count - 1)[k])
        slope[:, k] = (np.array(jump(beside[0])).ravel() - left) / DELTA
    for _ in range(BROYDEN):
        if found[3] or np.abs(left).max(initial=0) < EVEN:
            return found
        step = -np.linalg.lstsq(slope, left, rcond=None)[0]
        at, before = at + step, left
        found = solved((found[0], *ends), (0, 0), at)
        left = np.array(jump(found[0])).ravel()
        slope += np.outer(left - before - slope @ step, step) / (step @ step)
    return *found[:3], "no convergence"
