"""``python -m bench.horizon``: derivatives of multiple shooting by seven ways, in one run.

A body with a full tensor and three moments, N = 100 steps of a fourth-order Runge-Kutta step. A
way's figures are the least CPU times of many calls, in microseconds, of the constraint with its
Jacobian and of the Hessian of the Lagrangian, all ways in turn, several times over, so that what
else the machine does falls on all; the floor is a compiled horizon whose step computes nothing.
"""

import argparse
import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
from rich.table import Table

from derive.command.terminal import console
from derive.emit.casadi_module import imported
from derive.emit.files import scene_files
from derive.library.external import derivatives_of_step
from derive.library.library import Library, library
from derive.scene import parse_scene

SCENE = """
title  = "Body with a full tensor and three moments"
wanted = ["step_rk4_unit", "step_rk4_unit_jacobian"]

[parameters]
I_xx = { unit = "kg m^2", range = [1.2, 1.6], meaning = "moment of inertia about x" }
I_yy = { unit = "kg m^2", range = [1.4, 1.8], meaning = "moment of inertia about y" }
I_zz = { unit = "kg m^2", range = [1.6, 2.0], meaning = "moment of inertia about z" }
I_xy = { unit = "kg m^2", range = [-0.2, 0.2], meaning = "product of inertia" }
I_xz = { unit = "kg m^2", range = [-0.2, 0.2], meaning = "product of inertia" }
I_yz = { unit = "kg m^2", range = [-0.2, 0.2], meaning = "product of inertia" }

[axes]
attitude = "quaternion"

[body]
kind     = "general"
moments  = ["I_xx", "I_yy", "I_zz"]
products = ["I_xy", "I_xz", "I_yz"]

[known]
angular_velocity = { range = [-1, 1] }
moment           = { range = [-3, 3] }
"""
N, LENGTH = 100, 0.05
PARAMETERS = (1.4, 1.6, 1.8, 0.1, -0.05, 0.03)
ROUNDS, CALLS = 30, 20  # of all ways; of each in a round
CALLED = 7  # the step, its derivatives by states and inputs, by its length, by parameters, twice
PLAIN, WHOLE = "plain, rate in an MX loop", "plain RK4 as one SX function"
OURS = "emitted step as SX"
Steps = Callable[[Any, Any], Any]  # of x (7, N) and u (3, N), the states after


@dataclass(frozen=True)
class Way:
    """A way to state the steps, and how its functions are made; all else is the same.

    ours : the step is the emitted one, and its derivatives are exact
    """

    name: str
    steps: Steps
    ours: bool = False
    expanded: bool = False


@dataclass(frozen=True)
class Timing:
    """What a way takes: s to build, us for the constraint with its Jacobian, us for the Hessian.

    gap : of derivatives from those of the emitted step, which has meaning if the step is ``ours``
    """

    name: str
    build: float
    jacobian: float
    hessian: float
    gap: float
    ours: bool


def rate(x: Any, u: Any) -> Any:
    """Return the rate of the state as a user writes it."""
    a, b, c, d, e, f = PARAMETERS  # I_xy = + sum x y dm
    tensor = ca.DM([[a, -d, -e], [-d, b, -f], [-e, -f, c]])
    q, w = x[:4], x[4:]
    turned = ca.vertcat(-ca.dot(q[1:], w), q[0] * w + ca.cross(q[1:], w))
    return ca.vertcat(turned / 2, ca.solve(tensor, u - ca.cross(w, tensor @ w)))


def runge_kutta(slope: Callable[[Any, Any], Any], x: Any, u: Any) -> Any:
    """Return the classic step, its quaternion brought back to length one."""
    k1 = slope(x, u)
    k2 = slope(x + LENGTH / 2 * k1, u)
    k3 = slope(x + LENGTH / 2 * k2, u)
    k4 = slope(x + LENGTH * k3, u)
    after = x + LENGTH / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return ca.vertcat(after[:4] / ca.norm_2(after[:4]), after[4:])


def ways(module: ModuleType, count: int) -> list[Way]:
    """Return all ways to state so many steps."""
    x, u = ca.SX.sym("x", 7), ca.SX.sym("u", 3)
    slope = ca.Function("rate", [x, u], [rate(x, u)])
    whole = ca.Function("step", [x, u], [runge_kutta(rate, x, u)])
    own, single, horizon = module.step_rk4_unit_hot(), module.external(1), module.external(count)
    constants = module.setup()(PARAMETERS)

    def inlined(x: Any, u: Any) -> Any:
        return ca.vertcat(*own(constants, x[:4], x[4:], u, LENGTH))

    return [
        Way(PLAIN, by_column(lambda x, u: runge_kutta(slope, x, u))),
        Way(WHOLE, by_column(whole)),
        Way("plain, expanded", by_column(whole), expanded=True),
        Way(OURS, by_column(inlined), ours=True),
        Way(
            "external, a step a call",
            by_column(lambda x, u: single(x, u, LENGTH, PARAMETERS)),
            ours=True,
        ),
        Way("external of the horizon", lambda x, u: horizon(x, u, LENGTH, PARAMETERS), ours=True),
    ]


def by_column(step: Callable[[Any, Any], Any]) -> Steps:
    """Return the steps of all columns, each by a call of its own."""
    return lambda x, u: ca.horzcat(*(step(x[:, k], u[:, k]) for k in range(u.shape[1])))


def timed(every: Sequence[Way], reference: Way) -> list[Timing]:
    """Return what ways take, and how far derivatives are from those of the emitted step."""
    built, values = list[float](), sample()
    made = list[tuple[Any, Any]]()
    for way in every:
        begin = process_time()
        made.append(functions(way))
        built.append(process_time() - begin)
    took = least([f for pair in made for f in pair], values)
    exact = functions(reference)
    each = zip(every, made, built, took[::2], took[1::2], strict=True)
    return [
        Timing(way.name, spent, first, second, apart(pair, exact, values), way.ours)
        for way, pair, spent, first, second in each
    ]


def apart(ours: tuple[Any, Any], theirs: tuple[Any, Any], values: list[Any]) -> float:
    """Return how far Jacobian and Hessian differ, over the largest entry."""
    pairs = [(a(*values[:2])[1], b(*values[:2])[1]) for a, b in [(ours[0], theirs[0])]]
    pairs += [(ours[1](*values), theirs[1](*values))]
    return max(float(ca.norm_inf(ca.vec(a - b)) / ca.norm_inf(ca.vec(b))) for a, b in pairs)


def functions(way: Way) -> tuple[Any, Any]:
    """Return the constraint with its Jacobian, and the Hessian of the Lagrangian."""
    x: Any = ca.MX.sym("x", 7, N + 1)
    u: Any = ca.MX.sym("u", 3, N)
    weights: Any = ca.MX.sym("l", 7, N)
    left = ca.vec(x[:, 1:] - way.steps(x[:, :-1], u))
    both = ca.veccat(x, u)
    options = {"record_time": True}
    if way.expanded:
        xs, us, ls = ca.SX.sym("x", 7, N + 1), ca.SX.sym("u", 3, N), ca.SX.sym("l", 7, N)
        left = ca.Function("left", [x, u], [left]).expand()(xs, us)
        x, u, weights, both = xs, us, ls, ca.veccat(xs, us)
    hessian, _ = ca.hessian(ca.dot(ca.vec(weights), left), both)
    first = ca.Function("first", [x, u], [left, ca.jacobian(left, both)], options)
    return first, ca.Function("second", [x, u, weights], [hessian], options)


def sample() -> list[Any]:
    """Return states on the sphere, inputs and weights, drawn once."""
    dice = np.random.default_rng(1)
    x = dice.normal(size=(7, N + 1))
    x[:4] /= np.linalg.norm(x[:4], axis=0)
    return [ca.DM(x), ca.DM(dice.normal(size=(3, N))), ca.DM(dice.normal(size=(7, N)))]


def least(every: Sequence[Any], values: list[Any]) -> list[float]:
    """Return the shortest CPU times of calls in microseconds, by CasADi's own clock."""
    found = [inf] * len(every)
    for _ in range(ROUNDS):
        for place, function in enumerate(every):
            for _ in range(CALLS):
                function(*values[: function.n_in()])
                found[place] = min(found[place], function.stats()["t_proc_total"] * 1e6)
    return found


def written(made: Library, folder: Path) -> ModuleType:
    """Return the scene's module, its C beside it."""
    every = scene_files(made, (), of=derivatives_of_step(made))
    texts = {path.partition("/")[2]: text for path, text in every.items()}
    module = imported("body_casadi", texts["body_casadi.py"], folder)
    for name, text in texts.items():
        (Path(str(module.__file__)).parent / name).write_text(text, encoding="utf-8")
    return module


def emptied(module: ModuleType) -> Steps:
    """Return the horizon of C from which what computes a step is taken out."""
    source = Path(str(module.__file__)).parent / "body_external.c"
    text = source.read_text(encoding="utf-8")
    call = r"^ +body_step_rk4_unit\w*\((&constants|made->).*;$"
    empty, count = re.subn(call, "", text, flags=re.M)
    if count != CALLED:
        raise ValueError(f"{source.name} has {count} calls of a step, not {CALLED}")
    source.write_text(empty, encoding="utf-8")
    try:
        found = module.external(N)
    finally:
        source.write_text(text, encoding="utf-8")
    return lambda x, u: found(x, u, LENGTH, PARAMETERS)


def shown(found: list[Timing]) -> Table:
    """Return the table: times, and how often they go into those of the plain loop."""
    table = Table("way", "build s", "g + J us", "Hessian us", "times", "times ", "apart", box=None)
    plain = found[0]
    for one in found:
        ratios = (plain.jacobian / one.jacobian, plain.hessian / one.hessian)
        table.add_row(
            one.name, f"{one.build:.2f}", f"{one.jacobian:.0f}", f"{one.hessian:.0f}",
            *(f"{ratio:.1f}" for ratio in ratios), f"{one.gap:.1g}" if one.ours else "",
        )  # fmt: skip
    return table


def main() -> int:
    """Print the table; return the exit code."""
    argparse.ArgumentParser(prog="python -m bench.horizon", description=__doc__).parse_args()
    made = library(parse_scene(SCENE, "body"))
    with TemporaryDirectory(prefix="derive-") as place:
        kept: Mapping[str, str] = {"XDG_CACHE_HOME": place}
        os.environ.update(kept)
        module = written(made, Path(place))
        empty = emptied(module)
        begin = perf_counter(), os.times().children_user
        module.external(N)
        cold = perf_counter() - begin[0], os.times().children_user - begin[1]
        start = perf_counter()
        module.external(N)
        warm = perf_counter() - start
        every = [*ways(module, N), Way("floor: it computes nothing", empty)]
        found = timed(every, reference=every[3])
    console.print(f"CasADi {ca.CasadiMeta.version()}, N = {N}, full tensor")
    console.print(shown(found))
    named = {one.name: one for one in found}
    ratios = (getattr(named[OURS], n) / getattr(named[WHOLE], n) for n in ("jacobian", "hessian"))
    console.print(f"{OURS} over {WHOLE}: {', '.join(f'{ratio:.2f}' for ratio in ratios)} times")
    console.print(f"compiled in {cold[1]:.2f} s of CPU; found again in {warm:.3f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
