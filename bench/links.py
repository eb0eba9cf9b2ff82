"""Machines beside SymPy: operations of their accelerations, and CPU seconds to derive them.

``python -m bench.links`` prints the tables of ``docs/links.md``. SymPy's KanesMethod gives the mass
matrix and the right side; ``cse`` shares what their entries have in common, and then what L D L^T
on entries that are symbols has. The least known of chains is by hand: see ``docs/links.md``.
"""

import argparse
import re
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np
from mpmath import mp
from rich.table import Table
from sympy import Expr, Matrix, Pow, Symbol, cse, preorder_traversal

import derive
from bench.chains import chain
from bench.kane import KaneEquations, equations
from bench.peers.pinocchio import GRAVITY, LENGTH, MASS, Chain, chains, operations
from derive.command.terminal import console
from derive.library.library import library
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.mechanics.probe import DIGITS, NOTHING, random_probe, solved
from derive.mechanics.problem import answered
from derive.scene import Scene, SceneError, parse_scene
from derive.scene.machine import SOUGHT
from derive.verify.prove import prove

PLANAR, IN_TURN = "planar chain of {} rods", "axes in turn, {} rods"
BY_HAND = {2: 25, 3: 68, 4: 133, 5: 222, 6: 337}
PLAIN = {2: 46, 3: 171, 4: 343, 5: 555, 6: 802}
MOST_OF_SYMPY = 5  # rods: beyond, its expressions take minutes


@dataclass(frozen=True)
class ChainOfRods:
    """A chain by the axes of its joints, and the figure that others reach with it."""

    name: str
    axes: str
    known: int | None = None
    on_a_cart: bool = False


CHAINS = (
    *(ChainOfRods(PLANAR.format(n), "y" * n, known) for n, known in BY_HAND.items()),
    *(ChainOfRods(IN_TURN.format(n), ("yx" * n)[:n], k) for n, k in PLAIN.items()),
    ChainOfRods("two rods on a cart", "yy", on_a_cart=True),
)


FOLDERS = ("derive/scene/catalogue", "tests/mechanics/scenes", "bench/machines")
WANTED = re.compile(r"^wanted\s*=\s*\[.*?\]", re.MULTILINE | re.DOTALL)
ACCELERATIONS = SOUGHT[:2]


@dataclass(frozen=True)
class Cost:
    """Operations, divisions among them, and CPU seconds to derive them."""

    flops: int
    divisions: int
    seconds: float

    def __str__(self) -> str:
        """Return divisions apart."""
        return f"{self.flops - self.divisions} + {self.divisions}"


def machines(folders: Iterable[str] = FOLDERS) -> dict[str, Scene]:
    """Return the scenes of folders that can be asked for accelerations, asked for these alone.

    Those with constraints are left out: they are not told to KanesMethod.
    """
    found = {}
    for path in (p for folder in folders for p in sorted(Path(folder).glob("*.toml"))):
        asked = asking(path.read_text(encoding="utf-8"), path.stem)
        if asked is not None and not asked.constraints:
            found[path.stem] = asked
    return found


def asking(text: str, name: str) -> Scene | None:
    """Return a scene asked for its accelerations alone, None if it has none."""
    for function in ACCELERATIONS:
        try:
            scene = parse_scene(WANTED.sub(f'wanted = ["{function}"]', text), name)
            mechanism(scene).problem(function)
        except SceneError:
            continue
        return scene
    return None


def ours(scene: Scene) -> Cost:
    """Return what the accelerations of a scene take, and seconds to derive and prove them."""
    start = process_time()
    made = library(scene)
    prove(made)
    program = made[next(name for name in ACCELERATIONS if name in scene.wanted)]
    return Cost(program.flops(), program.count.get("div", 0), process_time() - start)


def by_kane(scene: Scene) -> Cost:
    """Return what KanesMethod, cse and L D L^T take, of a scene without constraints.

    Raises NoPeerError where the scene cannot be told to KanesMethod.
    """
    start = process_time()
    found = equations(mechanism(scene))
    matrix, right = found.whole
    n = matrix.rows
    entries = [matrix[i, j] for i in range(n) for j in range(i, n)]
    A = Matrix(n, n, lambda i, j: _entry(matrix, min(i, j), max(i, j)))
    solution = A.LDLsolve(Matrix([Symbol(f"b_{i}") for i in range(n)]))
    return staged([*entries, *right], solution, start)


def staged(entries: Sequence[Expr], solution: Iterable[Expr], start: float) -> Cost:
    """Return what entries of equations take, and then their solution, each after ``cse``."""
    stages = cse([*entries]), cse([*solution])
    divisions = sum(_divides(e) for shared, left in stages for e in (*dict(shared).values(), *left))
    return Cost(sum(counted(*stage) for stage in stages), divisions, process_time() - start)


def _entry(mass: Matrix, i: int, j: int) -> Expr:
    return mass[i, j] if mass[i, j] == 0 else Symbol(f"a_{i}_{j}")


def _divides(e: Expr) -> int:
    return sum(1 for p in preorder_traversal(e) if isinstance(p, Pow) and p.exp.is_negative)


def same(own: Mechanism, found: KaneEquations) -> bool:
    """Tell whether equations yield at a trial point the accelerations that balances do."""
    problem, probe = own.whole(own.scene.wanted[0]), random_probe(own.words, 0)
    probe.define(problem.definitions)
    true, probe = answered(problem, probe), random_probe(own.words, 0)
    with mp.workdps(DIGITS):
        matrix, right = found.whole
        rows = [[probe.value(e) for e in matrix.row(k)] for k in range(matrix.rows)]
        values = solved(rows, [probe.value(e) for e in right])
    by = dict(zip(found.unknowns, values, strict=False))  # multipliers are last
    each = zip((by[s] for s in problem.answers), true, strict=True)
    return all(abs(x - y) <= NOTHING * max(1, abs(x)) for x, y in each)


def counted(shared: Iterable[tuple[Symbol, Expr]], left: Iterable[Expr]) -> int:
    """Return the number of ``+ - * /`` in formulas; signs are free.

    >>> from sympy import symbols
    >>> x, y = symbols("x y")
    >>> counted([], [-x * y + 1 / x, x**2])
    4
    """
    total = 0
    for whole in (*(e for _, e in shared), *left):
        for e in preorder_traversal(whole):
            total += _operations(e)
    return total


def _operations(e: Expr) -> int:
    """Return the operations of an expression on what it is made of."""
    if e.is_Add:
        return len(e.args) - 1
    if e.is_Mul:
        return max(len([a for a in e.args if a != -1]) - 1, 0)
    if e.is_Pow and e.exp.is_Integer:
        power = int(e.exp)
        return abs(power) - (power > 0)
    return 0


def chains_beside(chains: Iterable[ChainOfRods], pinocchios: Chain | None) -> Table:
    """Return what chains take, ours beside others; of these Pinocchio's where it is installed."""
    names = ("machine", "ours", "of these /", "seconds", "SymPy", "seconds", "Pinocchio", "known")
    found = Table(*names)
    for own in chains:
        scene = parse_scene(chain(own.axes, on_a_cart=own.on_a_cart), "chain")
        cost = ours(scene)
        theirs = by_kane(scene) if len(own.axes) <= MOST_OF_SYMPY else None
        beside = (str(theirs.flops), f"{theirs.seconds:.1f}") if theirs else ("", "")
        figures = str(cost.flops), str(cost.divisions), f"{cost.seconds:.1f}"
        peer = pinocchios(own.axes) if pinocchios and not own.on_a_cart else None
        told = str(operations(peer)) if peer and alike(own.axes, peer) else ""
        found.add_row(own.name, *figures, *beside, told, str(own.known or ""))
    return found


def alike(axes: str, theirs: Any) -> bool:
    """Tell whether a chain of Pinocchio's accelerates as ours does. Raises ArithmeticError if not.

    theirs : CasADi's function of angles and rates
    """
    angles = {f"q_{k}": 0.3 * k - 0.7 for k in range(1, len(axes) + 1)}
    rates = {f"{name}_dot": 0.9 - 0.4 * x for name, x in angles.items()}
    with TemporaryDirectory() as folder:
        file = Path(folder) / "chain.toml"
        file.write_text(chain(axes), encoding="utf-8")
        own = derive.load(file).function("accelerations")
        given = {"m": MASS, "l": LENGTH, "g": GRAVITY, **angles, **rates}
        found = own(**{q.name: given[q.name] for q in (*own.inputs, *own.parameters)})
    other = np.array(theirs(list(angles.values()), list(rates.values()))).ravel()
    if not np.allclose(np.ravel(found), other, rtol=1e-10, atol=1e-10):
        raise ArithmeticError(f"{axes}: {found} here, {other} by Pinocchio")
    return True


def machines_beside(scenes: dict[str, Scene]) -> Table:
    """Return what the accelerations of scenes take, ours beside SymPy's, and where ours are dearer.

    A scene in which a load does work that Kane's method leaves out is marked: its equations differ.
    """
    found = Table("machine", "unknowns", "ours", "seconds", "SymPy", "seconds", "")
    for name, scene in scenes.items():
        cost = ours(scene)
        own = mechanism(scene)
        theirs, other = by_kane(scene), not same(own, equations(own))
        says = ["other equations"] * other + ["dearer"] * (cost.flops > theirs.flops)
        unknowns = str(sum(len(q.components) for q in own.whole(scene.wanted[0]).outputs))
        each = str(cost), f"{cost.seconds:.1f}", str(theirs), f"{theirs.seconds:.1f}"
        found.add_row(name, unknowns, *each, ", ".join(says))
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.links", description=__doc__)
    parser.add_argument("--most", type=int, default=6, metavar="RODS", help="rods of a chain")
    parser.add_argument("--only", nargs="*", metavar="FOLDER", help="machines of these alone")
    given = parser.parse_args(arguments)
    if given.only is None:
        with TemporaryDirectory() as folder:
            try:
                peer = chains(Path(folder))
            except ImportError as absent:
                peer = None
                console.print(f"Pinocchio is not run: {absent}")
            own = [own for own in CHAINS if len(own.axes) <= given.most]
            console.print(chains_beside(own, peer))
    console.print(machines_beside(machines(given.only or FOLDERS)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
