"""A trajectory on a grid of time: multiple shooting by the scene's step, or collocation; by IPOPT.

Inputs are held over each step. Where the time at the end is free it is a state of its own, equal at
all stages, so that every constraint is of neighbouring stages: the order that fatrop asks for.
"""

import signal
import threading
from collections.abc import Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from io import StringIO
from typing import Any

import casadi
import numpy as np

from derive.control.plant import NDFloat, Plant
from derive.control.slew import conjugate, product
from derive.control.task import Task

TOLERANCE = 1e-9
MOST_TURNS = 500  # of the solver
QUIET = {"print_time": False, "record_time": False}
SOLVERS = {
    "ipopt": {"print_level": 0, "sb": "yes", "max_iter": MOST_TURNS, "tol": TOLERANCE},
    "fatrop": {"print_level": 0, "max_iter": MOST_TURNS, "tol": TOLERANCE},
}
TRANSCRIPTIONS = ("shooting", "collocation")
NEAREST, FARTHEST = 2e-3, 500  # of the guess: a time at the end beyond them is none
PERTURBED = 0.3  # of what a component ranges over, or of a unit quaternion


def quietly(solver: Any, **values: Any) -> Any:
    """Return what a solver finds, its own warnings unprinted: what they say is told by its status.

    CasADi takes Ctrl-C for a failure of the function that it calls; here it stops the program.
    """
    stopped = list[int]()
    main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, lambda n, _: stopped.append(n)) if main else None
    try:
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            found = solver(**values)
    finally:
        if main:
            signal.signal(signal.SIGINT, before)
    if stopped:
        raise KeyboardInterrupt
    return found


def why_not(told: Mapping[str, Any]) -> str:
    """Return in words how a solver ended that found nothing; fatrop gives a number."""
    says = str(told["return_status"]).replace("_", " ").lower()
    return "no convergence" if says.lstrip("-").isdecimal() else says


@dataclass(frozen=True)
class Grid:
    """A trajectory at equal steps: x (states, N + 1), u (inputs, N), time in s, its cost."""

    x: NDFloat
    u: NDFloat
    until: float
    cost: float
    turns: int
    why: str

    @property
    def is_found(self) -> bool:
        """Tell whether the solver says that it has converged."""
        return not self.why

    def finer(self, count: int) -> "Grid":
        """Return the same trajectory at another number of steps, to start from."""
        old, new = (np.linspace(0, 1, n + 1) for n in (self.u.shape[1], count))
        x = np.array([np.interp(new, old, row) for row in self.x])
        held = np.minimum((new[:-1] * self.u.shape[1]).astype(int), self.u.shape[1] - 1)
        return Grid(x, self.u[:, held], self.until, self.cost, self.turns, self.why)


@dataclass(frozen=True)
class Direct:
    """A finite problem, ready to be solved from several starts."""

    own: Plant
    asked: Task
    count: int
    solver: Any
    scale: NDFloat
    unit: float
    ends: tuple[Any, ...]

    def solved(self, start: Grid) -> Grid:
        """Return the trajectory that is found from a start."""
        low, high, least, most = self.ends
        free = [[start.until]] if self.asked.is_free else []
        tall = np.vstack([start.x, *(np.full((1, self.count + 1), t) for (t,) in free)])
        first = np.vstack([tall[:, :-1], start.u]).T.ravel()
        guess = np.concatenate([first, tall[:, -1]]) / self.scale
        try:
            found = quietly(self.solver, x0=guess, lbx=low, ubx=high, lbg=least, ubg=most)
        except RuntimeError:  # of fatrop, where a step of its own fails
            return replace(start, why="an error of the solver")
        told = self.solver.stats()
        w = np.array(found["x"]).ravel() * self.scale
        n, states = len(tall) + len(start.u), len(start.x)
        body = w[: n * self.count].reshape(self.count, n).T
        x = np.column_stack([body[:states], w[n * self.count :][:states]])
        until = float(w[n * self.count :][states]) if free else self.asked.until
        why = "" if told["success"] else why_not(told)
        if free and not NEAREST * self.asked.until < until < FARTHEST * self.asked.until:
            why = why or f"a time of {until:.3g} s"
        within = (side[states:, None] for side in (self.asked.low, self.asked.high))
        return Grid(
            x,
            np.clip(body[len(tall) :], *within),
            until,
            float(found["f"]) * self.unit,
            told["iter_count"],
            why,
        )


def direct(own: Plant, asked: Task, count: int, method: str, solver: str) -> Direct:
    """Return the finite problem of so many steps."""
    states, free = len(own.x), int(asked.is_free)
    size = np.concatenate([asked.sizes[:states], [asked.until] * free])
    inputs = asked.sizes[states:]
    names = [(k, casadi.MX.sym(f"x{k}", states + free)) for k in range(count + 1)]
    x = [s for _, s in names]
    u = [casadi.MX.sym(f"u{k}", len(own.u)) for k in range(count)]
    between = _between(own, asked, count, method, size, inputs)
    constraints, least, most = list[Any](), list[Any](), list[Any]()
    cost: Any = 0
    keeps = asked.keeps.at
    kept = [(-np.inf, 0.0)] * len(asked.keeps)
    for k in range(count):
        gap, spent = between(x[k], u[k], x[k + 1])
        cost += spent
        constraints.append(gap)
        bounds = [(0.0, 0.0)] * (states + free)
        if not k:
            constraints.append(x[0][:states] - asked.start / size[:states])
            bounds += [(0.0, 0.0)] * states
        if kept and (k or asked.keeps.takes_inputs):
            constraints.append(keeps(x[k][:states] * size[:states], u[k] * inputs))
            bounds += kept
        least += [low for low, _ in bounds]
        most += [high for _, high in bounds]
    last = x[count]
    if free:
        cost += asked.cost["time"] * last[states] * asked.until
    at_end = last[:states] * size[:states]
    still = keeps(at_end, casadi.DM(len(own.u), 1))[[*asked.keeps.last]]
    for values, below in ((asked.ends(at_end), 0.0), (still, -np.inf)):
        constraints.append(values)
        least += [below] * values.numel()
        most += [0.0] * values.numel()
    unit = _cost_scale(asked, inputs)
    stages = [part for pair in zip(x[:-1], u, strict=True) for part in pair]
    problem = {
        "x": casadi.vertcat(*stages, last),
        "f": cost / unit,
        "g": casadi.vertcat(*constraints),
    }
    low, high = _bounds(own, asked, count)
    options: dict[str, Any] = {**QUIET, "expand": True, solver: SOLVERS[solver]}
    if solver == "fatrop":
        options |= {
            "structure_detection": "auto",
            "equality": [a == b for a, b in zip(least, most, strict=True)],
        }
    scale = np.concatenate([np.tile(np.concatenate([size, inputs]), count), size])
    made = casadi.nlpsol("trajectory", solver, problem, options)
    return Direct(own, asked, count, made, scale, unit, (low / scale, high / scale, least, most))


def _cost_scale(asked: Task, inputs: NDFloat) -> float:
    with np.errstate(over="ignore"):
        energy = asked.cost["energy"] * float(inputs @ inputs)
    return asked.until * (asked.cost["time"] + energy) or 1.0


def _between(
    own: Plant, asked: Task, count: int, method: str, size: NDFloat, inputs: NDFloat
) -> Any:
    """Return what vanishes between two stages, and what the step between them costs."""
    states, free = len(own.x), asked.is_free
    a, b = (casadi.SX.sym(n, len(size)) for n in "ab")
    v = casadi.SX.sym("v", len(own.u))
    first, then, u = a * size, b * size, v * inputs
    h = (first[states] if free else asked.until) / count
    x, y = first[:states], then[:states]
    if method == "collocation":  # Hermite and Simpson; u is held
        f, g = own.rate(x, u), own.rate(y, u)
        middle = own.rate((x + y) / 2 + h / 8 * (f - g), u)
        after = x + h / 6 * (f + 4 * middle + g)
    else:
        after = own.step(x, u, h)
    # the next stage has the factor 1, to the last bit: fatrop asks for it
    whole = b - casadi.vertcat(after / size[:states], *([a[states]] if free else []))
    spent = asked.cost["energy"] * h * casadi.sumsqr(u)
    return casadi.Function("between", [a, v, b], [whole, spent])


def _bounds(own: Plant, asked: Task, count: int) -> tuple[NDFloat, NDFloat]:
    """Return the least and largest values of all variables; the first state has none."""
    states = len(own.x)
    ends = []
    sides = ((asked.low, NEAREST / 2, -np.inf), (asked.high, FARTHEST * 2, np.inf))
    for side, until, until_start in sides:
        tall = np.concatenate([side[:states], [asked.until * until] * int(asked.is_free)])
        every = np.tile(np.concatenate([tall, side[states:]]), count)
        whole = np.concatenate([every, tall])
        whole[:states] = until_start
        ends.append(whole)
    return ends[0], ends[1]


def first_guesses(own: Plant, asked: Task, count: int, many: int) -> Sequence[Grid]:
    """Return first guesses: straight from start to goal, and others perturbed beside it."""
    s = np.linspace(0, 1, count + 1)
    straight = asked.start[:, None] * (1 - s) + asked.goal[:, None] * s
    if own.attitude:
        straight[list(own.attitude)] = _slerp(asked, list(own.attitude), s)
    inputs = asked.sizes[len(own.x) :]
    found = [Grid(straight, np.zeros((len(own.u), count)), asked.until, 0.0, 0, "")]
    for number in range(1, many):
        draw = np.random.default_rng(number)
        bump = PERTURBED * draw.standard_normal((len(own.x), 1)) * np.sin(np.pi * s)
        x = straight + bump * asked.sizes[: len(own.x), None]
        u = inputs[:, None] * draw.uniform(-1, 1, (len(own.u), 1)) * np.ones(count)
        found.append(Grid(x, u, asked.until, 0.0, 0, ""))
    return found


def _slerp(asked: Task, place: list[int], s: NDFloat) -> NDFloat:
    """Return the steady turn about one axis, from the start's attitude to the goal's."""
    first, last = asked.start[place], asked.goal[place]
    turned = np.array(product(conjugate(first), last))
    length = np.linalg.norm(turned[1:])
    half = np.arctan2(length, turned[0])
    axis = turned[1:] / (length or 1.0)
    return np.array([product(first, [np.cos(half * t), *(np.sin(half * t) * axis)]) for t in s]).T
