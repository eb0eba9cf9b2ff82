"""Chains of rods beside SymPy: operations of their accelerations, and CPU seconds to derive them.

``python -m bench.links`` prints the table of ``docs/links.md``. SymPy's KanesMethod gives the mass
matrix and the right side; ``cse`` shares what their entries have in common, and then what L D L^T
on entries that are symbols has. The least known is by hand: see ``docs/links.md``.
"""

import argparse
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from time import process_time

from rich.table import Table
from sympy import Expr, Matrix, Symbol, cse, preorder_traversal, symbols
from sympy.physics.mechanics import (
    KanesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

from bench.chains import chain
from derive.command.terminal import console
from derive.library.library import library
from derive.scene import parse_scene
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


def ours(own: ChainOfRods) -> tuple[int, int, float]:
    """Return operations, divisions among them, and seconds to derive and prove a chain."""
    start = process_time()
    made = library(parse_scene(chain(own.axes, on_a_cart=own.on_a_cart), "chain"))
    prove(made)
    program = made["accelerations"]
    return program.flops(), program.count.get("div", 0), process_time() - start


def by_kane(own: ChainOfRods) -> tuple[int, float]:
    """Return operations by KanesMethod and cse, and seconds."""
    start = process_time()
    mass, right = equations(own)
    n = mass.rows
    entries = [mass[i, j] for i in range(n) for j in range(i, n)]
    A = Matrix(n, n, lambda i, j: Symbol(f"a_{min(i, j)}_{max(i, j)}"))
    solution = A.LDLsolve(Matrix([Symbol(f"b_{i}") for i in range(n)]))
    total = counted(*cse([*entries, *right])) + counted(*cse([*solution]))
    return total, process_time() - start


def equations(own: ChainOfRods) -> tuple[Matrix, Matrix]:
    """Return the mass matrix and the right side by Kane's method."""
    m, length, g = symbols("m l g")
    n = len(own.axes)
    q, u = dynamicsymbols(f"q:{n}"), dynamicsymbols(f"u:{n}")
    N, hinge = ReferenceFrame("N"), Point("O")
    hinge.set_vel(N, 0)
    frame, bodies, loads = N, [], []
    if own.on_a_cart:
        x, v = dynamicsymbols("x v")
        hinge.set_vel(N, v * N.x)
        bodies.append(RigidBody("cart", hinge, N, 3 * m, (inertia(N, 0, 0, 0), hinge)))
        q, u = [*q, x], [*u, v]
    for k, axis in enumerate(own.axes):
        e = getattr(frame, axis)
        link = frame.orientnew(f"B{k}", "Axis", (q[k], e))
        link.set_ang_vel(frame, u[k] * e)
        centre, end = (
            hinge.locatenew(f"{s}{k}", -r * link.z) for s, r in (("G", length / 2), ("P", length))
        )
        for point in (centre, end):
            point.v2pt_theory(hinge, N, link)
        about = inertia(link, m * length**2 / 12, m * length**2 / 12, 0)
        bodies.append(RigidBody(f"rod{k}", centre, link, m, (about, centre)))
        loads.append((centre, -m * g * N.z))
        frame, hinge = link, end
    rates = [a.diff() - b for a, b in zip(q, u, strict=True)]
    kane = KanesMethod(N, list(q), list(u), kd_eqs=rates)
    kane.kanes_equations(bodies, loads)
    return kane.mass_matrix, kane.forcing


def counted(shared: Iterable[tuple[Symbol, Expr]], left: Iterable[Expr]) -> int:
    """Return the number of ``+ - * /`` in formulas; signs are free.

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


def table(chains: Iterable[ChainOfRods]) -> Table:
    """Return what chains take, ours beside others."""
    found = Table("machine", "ours", "of these /", "seconds", "SymPy", "seconds", "known")
    for own in chains:
        flops, divisions, seconds = ours(own)
        theirs = by_kane(own) if len(own.axes) <= MOST_OF_SYMPY else None
        beside = (str(theirs[0]), f"{theirs[1]:.1f}") if theirs else ("", "")
        known = str(own.known or "")
        found.add_row(own.name, str(flops), str(divisions), f"{seconds:.1f}", *beside, known)
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.links", description=__doc__)
    parser.add_argument("--most", type=int, default=6, metavar="RODS", help="rods of a chain")
    most = parser.parse_args(arguments).most
    console.print(table(own for own in CHAINS if len(own.axes) <= most))
    return 0


if __name__ == "__main__":
    sys.exit(main())
