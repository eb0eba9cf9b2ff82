"""Machines held by constraints beside SymPy: operations of accelerations, and how exact they are.

``python -m bench.loops`` prints the table of ``docs/constraints.md``. SymPy's KanesMethod gives the
equations of the tree of bodies, and differentiates places and formulas that it is told anew; as it
does where speeds are dependent, multipliers are taken out, and ``cse`` shares what entries have in
common, and then what LU on entries that are symbols has. Errors are those of our double functions
beside these equations, multipliers in them, solved in many digits at the same numbers.
"""

import argparse
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray
from rich.table import Table
from sympy import Expr, Integer, Matrix, Symbol

from bench.kane import KaneEquations, equations
from bench.links import Cost, asking, staged
from derive.command.terminal import console, progress
from derive.library.library import Library, library
from derive.mechanics.box import ranges
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.probe import DIGITS, Probe, solved
from derive.program.arithmetic import working
from derive.program.precision import F64
from derive.verify.measure import replayed
from derive.verify.prove import prove
from derive.verify.sample import Sample

SCENES, MACHINES = Path("tests/mechanics/scenes"), Path("bench/machines")
LOOPS = (
    ("four bars, a parallelogram", SCENES / "four_bar_closed.toml"),
    ("slider-crank, its rod in an angle of its own", SCENES / "slider_crank_guided.toml"),
    ("parallelogram of five bars, a row redundant", SCENES / "five_bars.toml"),
    ("spatial slider-crank", SCENES / "spatial_slider_crank.toml"),
    ("Bennett's linkage, three rows redundant", MACHINES / "bennett.toml"),
    ("Bricard's mechanism, a row redundant", SCENES / "bricard.toml"),
    ("squeezing mechanism of Andrews, numbers for parameters", SCENES / "squeezer.toml"),
    ("Peaucellier and Lipkin", SCENES / "peaucellier.toml"),
    ("governor of Watt, two loops", MACHINES / "flyball_governor.toml"),
    ("Chaplygin's sleigh", SCENES / "sleigh.toml"),
    ("snakeboard", SCENES / "snakeboard.toml"),
    ("robot on two wheels", MACHINES / "robot_on_two_wheels.toml"),
    ("disc that rolls, six coordinates", MACHINES / "disc_on_floor.toml"),
)
STATES = 24
"""At which errors are looked at: states of the declared ranges on the constraints."""


@dataclass(frozen=True)
class Loop:
    """What a machine takes: ours, SymPy's, and the largest error as a part of the largest."""

    ours: Cost
    sympy: Cost
    error: float


def beside(path: Path) -> Loop:
    """Return what the accelerations of a scene take, ours beside SymPy's."""
    scene = asking(path.read_text(encoding="utf-8"), path.stem)
    if scene is None:
        raise SystemExit(f"{path} has no accelerations")
    start = process_time()
    made = library(scene)
    prove(made)
    program = made[scene.wanted[0]]
    own = Cost(program.flops(), program.count.get("div", 0), process_time() - start)
    start = process_time()
    found = equations(made.mechanism)
    return Loop(own, by_lu(made.mechanism, found, start), error(made, found))


def by_lu(own: Mechanism, found: KaneEquations, start: float) -> Cost:
    """Return what SymPy's equations take, those rates dependent that do best at a state."""
    state = states(own)[0]
    with mp.workdps(DIGITS):
        slopes = [[float(probe_at(own, state).value(e)) for e in found.slopes.row(k)]
                  for k in range(found.slopes.rows)]  # fmt: skip
    matrix, right = found.following(pivots(np.array(slopes)))
    n = matrix.rows
    entries = [e for e in (*matrix, *right) if e != 0]
    A = Matrix(n, n, lambda i, j: _symbol("a", i * n + j, matrix[i, j]))
    solution = A.LUsolve(Matrix([_symbol("b", i, right[i]) for i in range(n)]))
    return staged(entries, solution, start)


def _symbol(name: str, place: int, entry: Expr) -> Expr:
    return Symbol(f"{name}_{place}") if entry != 0 else Integer(0)


def pivots(slopes: NDArray[Any]) -> list[int]:
    """Return the columns of the largest pivots, one after another.

    >>> pivots(np.array([[1.0, 3.0, 0.0], [1.0, 3.0, 2.0]]))
    [1, 2]
    """
    left, found = slopes.copy(), list[int]()
    for k in range(len(left)):
        column = int(np.argmax(np.abs(left[k])))
        found.append(column)
        for other in range(k + 1, len(left)):
            left[other] -= left[k] * (left[other, column] / left[k, column])
    return found


def states(own: Mechanism) -> NDArray[Any]:
    """Return states of the declared ranges on the constraints."""
    box = ranges(own.words)
    return box.brought(box.trials())[:STATES]


def probe_at(own: Mechanism, state: Iterable[float]) -> Probe:
    """Return the values of all that is given."""
    box = ranges(own.words)
    return Probe({s: mpf(float(x)) for s, x in zip(box.symbols, state, strict=True)})


def error(made: Library, found: KaneEquations) -> float:
    """Return the largest error of an acceleration in doubles, as a part of the largest."""
    own, program = made.mechanism, made[made.scene.wanted[0]]
    matrix, right = found.whole
    points = states(own)
    given = ranges(own.words).names
    each = [Sample(n, "ordinary", dict(zip(given, map(float, point), strict=True)))
            for n, point in enumerate(points)]  # fmt: skip
    ours = np.array(replayed(made, each, F64, working(F64.dtype))[program.name])
    names = [c for q in program.outputs for c in q.components]
    order = [names.index(own.words.sheet.label(s)) for s in found.unknowns]
    worst = 0.0
    for point, column in zip(points, ours[order].T, strict=True):
        probe = probe_at(own, point)
        with mp.workdps(DIGITS):
            rows = [[probe.value(e) for e in matrix.row(k)] for k in range(matrix.rows)]
            true = solved(rows, [probe.value(e) for e in right])[: len(order)]
            most = max(map(abs, true)) or mpf(1)
            worst = max(worst, *(float(abs(x - y) / most)
                                 for x, y in zip(map(mpf, column), true, strict=True)))  # fmt: skip
    return worst


def table(only: Sequence[str]) -> Table:
    """Return the table of loops, or of some of them by their files' names."""
    found = Table("machine", "ours", "of these /", "SymPy", "of these /", "seconds", "error")
    chosen = [(name, path) for name, path in LOOPS if not only or path.stem in only]
    with progress() as shown:
        for name, path in shown.track(chosen, description="loops"):
            one = beside(path)
            costs = (str(n) for cost in (one.ours, one.sympy) for n in (cost.flops, cost.divisions))
            found.add_row(name, *costs, f"{one.ours.seconds:.1f}", f"{one.error:.0e}")
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.loops", description=__doc__)
    parser.add_argument("--only", nargs="*", default=(), metavar="NAME", help="these files alone")
    console.print(table(parser.parse_args(arguments).only))
    return 0


if __name__ == "__main__":
    sys.exit(main())
