"""``python -m bench.references``: known optima, found by `derive.steer` and by a plain model.

The plain model is what a user writes by hand in CasADi: the rate as a function of SX, RK4 in an MX
loop, IPOPT, inputs and the time scaled, by `nlpsol`, and the same with its option "expand". It has
the steps, the tolerance and the starts of the direct part of `derive.steer`, and its end condition.
CPU times are of one process; costs of starts that differ by less than 1e-4 of them are one local
minimum. Iterations are those of all starts; of `derive.steer`, of the last grid and of the arcs.
"""

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import log10
from pathlib import Path
from time import process_time
from typing import Any

import casadi as ca
import numpy as np

import derive
from derive.control.direct import (
    FARTHEST,
    NEAREST,
    SOLVERS,
    Grid,
    direct,
    first_guesses,
    why_not,
)
from derive.control.plant import plant
from derive.control.task import Task, task
from derive.control.trajectory import minima

KNOWN = Path(__file__).parents[1] / "tests" / "data" / "optimal_control.json"
STEPS, STARTS = 100, 16
MOST = 15  # digits of a double
Solve = Callable[[Grid], Grid]
MOMENTS = ("I_x", "I_y", "I_z")
SCENE: Mapping[str, Any] = {
    "wanted": ["step_rk4_unit"],
    "parameters": {n: {"unit": "kg m^2", "range": [0.5, 9000]} for n in MOMENTS},
    "axes": {"attitude": "quaternion"},
    "body": {"kind": "principal", "moments": MOMENTS},
    "known": {"angular_velocity": {"range": [-3, 3]}, "moment": {"range": [-60, 60]}},
}
HEAD = (
    "reference",
    "way",
    "known",
    "found",
    "digits",
    "iterations",
    "set-up s",
    "solved in s",
    "starts led to",
)


@dataclass(frozen=True)
class Case:
    """A turn from rest to rest; ``most`` of each moment, None for any; ``until``, None if free."""

    name: str
    inertia: tuple[float, ...]
    turn: str
    most: float | None
    until: float | None
    known: float

    @property
    def values(self) -> dict[str, float]:
        """Return the scene's parameters."""
        return dict(zip(MOMENTS, self.inertia, strict=True))

    @property
    def limits(self) -> dict[str, float]:
        """Return the limits of inputs."""
        return {} if self.most is None else {"moment": self.most}

    @property
    def cost(self) -> dict[str, float]:
        """Return the weights of the cost."""
        return {"time": 1} if self.until is None else {"energy": 1}

    def scene(self) -> derive.Handle:
        """Return the scene, under a name of its own, so that nothing is kept of another case."""
        return derive.load(SCENE, name=self.name)


@dataclass(frozen=True)
class Row:
    """What a way found, with s of CPU to set up and to solve, and the cost from each start."""

    case: Case
    way: str
    cost: float
    turns: int
    set_up: float
    solved: float
    found: tuple[float | None, ...]

    def cells(self) -> Iterator[str]:
        """Yield what the table says of it."""
        digits = min(MOST, -log10(abs(self.cost / self.case.known - 1) or 10.0**-MOST))
        known, found = (f"{cost:.12g}" for cost in (self.case.known, self.cost))
        yield from (self.case.name, self.way, known, found, f"{digits:.1f}")
        yield from (f"{self.turns}", f"{self.set_up:.2f}", f"{self.solved:.2f}")
        led = [f"{cost:.6g}: {count}" for cost, count in minima(self.found)]
        lost = self.found.count(None)
        yield ", ".join(led + [f"none: {lost}"] * bool(lost))


def cases() -> list[Case]:
    """Return the references."""
    known = json.loads(KNOWN.read_text("utf-8"))
    found = [(n, c, c["umax"], None, c["t_f"]) for n, c in known["min_time"].items()]
    found += [(n, c, None, c["T"], c["integral_u2"]) for n, c in known["min_energy"].items()]
    return [
        Case(name, tuple(c["inertia"]), f"{c['axis']} {c['degrees']}deg", most, until, cost)
        for name, c, most, until, cost in found
    ]


def rows(case: Case) -> Iterator[Row]:
    """Yield what each way finds."""
    yield whole(case)
    begin = process_time()
    own, given = plant(case.scene().scene, case.values)
    asked = task(own, given, case.turn, {}, case.limits, (), case.cost, case.until)
    ours = direct(own, asked, STEPS, "shooting", "ipopt")
    built = process_time() - begin
    first = first_guesses(own, asked, STEPS, STARTS)
    yield led(case, "its direct part", built, ours.solved, first)
    for way, expanded in (("plain", False), ("plain, expanded", True)):
        begin = process_time()
        solved = plain(case, asked, {"expand": expanded})
        yield led(case, way, process_time() - begin, solved, first)


def whole(case: Case) -> Row:
    """Return what `derive.steer` finds, from deriving to the refined trajectory."""
    said = dict[str, float]()

    def hears(now: str) -> None:
        said.setdefault(now, process_time())

    begin = process_time()
    found = derive.steer(
        case.scene(), case.values, case.turn, limits=case.limits, cost=case.cost,
        until=case.until, steps=STEPS, starts=STARTS,
        told=hears,
    )  # fmt: skip
    first = said[f"start 1 of {STARTS}"]
    turns = found.grid.turns + (found.refined.turns if found.refined else 0)
    solved = process_time() - first
    return Row(case, "derive.steer", found.cost, turns, first - begin, solved, found.found)


def led(case: Case, way: str, built: float, solved: Solve, first: Sequence[Grid]) -> Row:
    """Return where all starts lead to."""
    begin = process_time()
    found = [solved(start) for start in first]
    took = process_time() - begin
    costs = tuple(g.cost if g.is_found else None for g in found)
    turns = int(np.sum([g.turns for g in found]))
    return Row(case, way, min(c for c in costs if c is not None), turns, built, took, costs)


def plain(case: Case, asked: Task, options: Mapping[str, object]) -> Solve:
    """Return what solves the case as a user sets it up, from a start."""
    x = [ca.MX.sym(f"x{k}", 7) for k in range(STEPS + 1)]
    u = [ca.MX.sym(f"u{k}", 3) for k in range(STEPS)]
    last: Any = ca.MX(1) if case.until else ca.MX.sym("T")  # of the first guess
    size, slope = case.most or 1.0, rate(case.inertia)
    h = last * asked.until / STEPS
    left, spent = [x[0] - asked.start], ca.MX(0)
    for k in range(STEPS):
        left.append(x[k + 1] - runge_kutta(slope, x[k], size * u[k], h))
        spent += h * ca.sumsqr(size * u[k])
    variables = [part for pair in zip(x[:-1], u, strict=True) for part in pair] + [x[-1]]
    moves, free = 1.0 if case.most else np.inf, [] if case.until else [1.0]
    most = np.concatenate([np.tile([np.inf] * 7 + [moves] * 3, STEPS), np.full(7, np.inf)])
    nlp: dict[str, Any] = {"x": ca.vertcat(*variables, *([last] if free else []))}
    nlp |= {"f": last * asked.until if free else spent, "g": ca.vertcat(*left, asked.ends(x[-1]))}
    given: dict[str, Any] = {"print_time": False, "ipopt": SOLVERS["ipopt"], **options}
    solver = ca.nlpsol("plain", "ipopt", nlp, given)
    low, high = (
        [*side, *(t * end for t in free)] for side, end in ((-most, NEAREST), (most, FARTHEST))
    )

    def solved(start: Grid) -> Grid:
        first = np.vstack([start.x[:, :-1], start.u / size]).T.ravel()
        guess = np.concatenate([first, start.x[:, -1], free])
        found = solver(x0=guess, lbx=low, ubx=high, lbg=0, ubg=0)
        told = solver.stats()
        why = "" if told["success"] else why_not(told)
        return replace(start, cost=float(found["f"]), turns=told["iter_count"], why=why)

    return solved


def rate(inertia: Sequence[float]) -> Any:
    """Return the rate of the state as a user writes it."""
    x, u, moments = ca.SX.sym("x", 7), ca.SX.sym("u", 3), ca.DM(inertia)
    q, w = x[:4], x[4:]
    turned = ca.vertcat(-ca.dot(q[1:], w), q[0] * w + ca.cross(q[1:], w))
    faster = (u - ca.cross(w, moments * w)) / moments
    return ca.Function("rate", [x, u], [ca.vertcat(turned / 2, faster)])


def runge_kutta(slope: Any, x: Any, u: Any, h: Any) -> Any:
    """Return the classic step."""
    k1 = slope(x, u)
    k2 = slope(x + h / 2 * k1, u)
    k3 = slope(x + h / 2 * k2, u)
    return x + h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(x + h * k3, u))


def table(found: Sequence[Row]) -> str:
    """Return the rows as a table of Markdown."""
    head = [HEAD, ["---"] * len(HEAD)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in [*head, *(r.cells() for r in found)])


def main() -> int:
    """Print the table; return the exit code."""
    argparse.ArgumentParser(prog="python -m bench.references", description=__doc__).parse_args()
    print(table([row for case in cases() for row in rows(case)]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
