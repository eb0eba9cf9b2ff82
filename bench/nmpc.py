"""``python -m bench.nmpc``: predictive control 40 steps ahead by IPOPT and fatrop, in one run.

A body with a full tensor is turned to rest by three limited moments that are noisy. Each cycle
starts from the one before, its multipliers too. A way's figures are means of all cycles but the
first: CPU time of a solution, the part of it in the functions of the problem, and iterations.
"""

import argparse
import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
from rich.table import Table

from bench.horizon import LENGTH, PARAMETERS, SCENE, Way, ways, written
from derive.command.terminal import console
from derive.library.library import library
from derive.scene import parse_scene

AHEAD, CYCLES, LIMIT, NOISE = 40, 60, 1.0, 0.02  # steps, cycles, N m of a moment, and on it
START, REST = [0.6, 0.64, 0, 0.48, 0.2, -0.4, 0], [1, 0, 0, 0, 0, 0, 0]
WIDE = len(START) + 3
SOLVERS: Mapping[str, Mapping[str, object]] = {
    "ipopt": {"print_level": 0, "sb": "yes", "warm_start_init_point": "yes", "mu_init": 1e-4},
    "fatrop": {"print_level": 0, "mu_init": 1e-4, "bound_push": 1e-4},
}
PARTS = ("nlp_f", "nlp_g", "nlp_grad_f", "nlp_jac_g", "nlp_hess_l")


@dataclass(frozen=True)
class Flight:
    """What a way takes, s to build and ms of CPU a cycle, and where it leads.

    inside : ms of it in the functions of the problem       turns : iterations a cycle
    """

    solver: str
    way: str
    build: float
    cycle: float
    inside: float
    turns: float
    end: Any


def problem(way: Way, solver: str) -> Any:
    """Return the solver of one cycle; stages are in the order that fatrop asks for."""
    x = [ca.MX.sym(f"x{k}", len(START)) for k in range(AHEAD + 1)]
    u = [ca.MX.sym(f"u{k}", 3) for k in range(AHEAD)]
    now: Any = ca.MX.sym("now", len(START))
    states, moments = ca.horzcat(*x), ca.horzcat(*u)
    gaps = ca.horzsplit(states[:, 1:] - way.steps(states[:, :-1], moments))
    off = ca.vertcat(2 * states[1:4, :], states[4:, :])
    spent = LENGTH * (ca.sumsqr(off) + 0.1 * ca.sumsqr(moments)) + 10 * ca.sumsqr(off[:, -1])
    stages = [part for pair in zip(x[:-1], u, strict=True) for part in pair]
    left = ca.vertcat(gaps[0], x[0] - now, *gaps[1:])
    options: dict[str, Any] = {"print_time": False, "record_time": True, "expand": way.expanded}
    options |= {solver: SOLVERS[solver]}
    if solver == "fatrop":
        options |= {"structure_detection": "auto", "equality": [True] * left.numel()}
    nlp = {"x": ca.vertcat(*stages, x[-1]), "p": now, "f": spent, "g": left}
    return ca.nlpsol("cycle", solver, nlp, options)


def flown(way: Way, solver: str, plant: Any) -> Flight:
    """Return what the cycles of a flight take, each begun from the one before."""
    begin = process_time()
    solve = problem(way, solver)
    built = process_time() - begin
    free = np.full(len(START), np.inf)
    most = np.concatenate([np.tile([*free, LIMIT, LIMIT, LIMIT], AHEAD), free])
    plan: dict[str, Any] = {"x0": np.concatenate([np.tile([*REST, 0, 0, 0], AHEAD), REST])}
    at, dice, told = ca.DM(START), np.random.default_rng(1), list[tuple[float, float, int]]()
    for _ in range(CYCLES):
        begin = process_time()
        found = solve(**plan, p=at, lbx=-most, ubx=most, lbg=0, ubg=0)
        took, said = process_time() - begin, solve.stats()
        if not said["success"]:
            raise ValueError(f"{solver}, {way.name}: {said['return_status']}")
        told.append((took, sum(said[f"t_proc_{part}"] for part in PARTS), said["iter_count"]))
        plan = {"x0": found["x"], "lam_x0": found["lam_x"], "lam_g0": found["lam_g"]}
        moment = found["x"][len(START) : WIDE] + NOISE * dice.standard_normal(3)
        at = plant(at, moment, LENGTH, PARAMETERS)
    cycle, inside, turns = np.mean(told[1:], axis=0)
    return Flight(solver, way.name, built, 1e3 * cycle, 1e3 * inside, turns, at)


def shown(found: list[Flight]) -> Table:
    """Return the table: times, and how often they go into those of IPOPT on the plain loop."""
    table = Table("solver", "way", "build s", "ms a cycle", "inside", "turns", "times", box=None)
    for one in found:
        table.add_row(
            one.solver, one.way, f"{one.build:.2f}", f"{one.cycle:.1f}", f"{one.inside:.1f}",
            f"{one.turns:.1f}", f"{found[0].cycle / one.cycle:.1f}",
        )  # fmt: skip
    return table


def flights(module: ModuleType) -> list[Flight]:
    """Return the flights by all ways and solvers; they must end at one state."""
    every, plant = ways(module, AHEAD), module.external(1)
    found = [flown(way, solver, plant) for solver in SOLVERS for way in every]
    apart = max(float(ca.norm_inf(one.end - found[0].end)) for one in found)
    console.print(f"CasADi {ca.CasadiMeta.version()}, N = {AHEAD}, ends {apart:.1g} apart")
    return found


def main() -> int:
    """Print the table; return the exit code."""
    argparse.ArgumentParser(prog="python -m bench.nmpc", description=__doc__).parse_args()
    with TemporaryDirectory(prefix="derive-") as place:
        os.environ["XDG_CACHE_HOME"] = place
        module = written(library(parse_scene(SCENE, "body")), Path(place))
        console.print(shown(flights(module)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
