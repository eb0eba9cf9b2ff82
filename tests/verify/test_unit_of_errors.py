"""What errors are counted in is what docs/code.md says: worked out here from the equations alone.

The equations are multiplied out by SymPy and solved as one system by mpmath, so nothing is shared
with how the program takes them apart.
"""

from types import SimpleNamespace
from typing import Any

import pytest
from mpmath import matrix, mp, mpf
from sympy import Add, Expr, Mul, S, Symbol, cos, expand, symbols

from derive.mechanics.problem import Problem
from derive.program.precision import F64
from derive.verify.equations import equations_of
from derive.verify.reference import reference
from derive.verify.sample import samples
from tests.made import library_of

ANSWERS = [
    ("free_body", "acceleration"),
    ("free_body", "moment"),
    ("free_body", "kinetic_energy"),
    ("rigid_body", "moment"),
    ("heavy_top", "angular_momentum"),
]


def unit(problem: Any, known: dict[Symbol, Any], parameters: set[Symbol]) -> dict[Symbol, float]:
    """Return the largest product in the equations of each unknown, as docs/code.md defines it."""
    values, sizes = dict(known), {s: abs(x) for s, x in known.items()}
    fixed = set(parameters)
    for s, e in problem.definitions.items():
        values[s] = _number(e, values)
        sizes[s] = max(abs(values[s]), *(_size(p, values, sizes) for p in _products(e)))
        fixed |= {s} if e.free_symbols <= fixed else set()
    if problem.rows:
        sizes |= _solved(problem, values, sizes, fixed)
    for s, e in problem.answers.items():
        if s not in problem.unknowns:
            values[s] = _number(e, values)
            sizes[s] = max(abs(values[s]), *(_size(p, values, sizes) for p in _products(e)))
    return {s: float(sizes[s]) for s in problem.answers}


def _solved(
    problem: Any, values: dict[Symbol, Any], sizes: dict[Symbol, Any], fixed: set[Symbol]
) -> dict[Symbol, Any]:
    unknowns = list(problem.unknowns)
    rows = [_products(row) for row in problem.rows]
    a = [[sum((p / u for p in row if p.has(u)), S.Zero) for u in unknowns] for row in rows]
    loads = [[p for p in row if not p.has(*unknowns)] for row in rows]
    numbers = matrix([[_number(entry, values) for entry in row] for row in a])
    given = matrix([-sum(_number(p, values) for p in row) for row in loads])
    solved = mp.lu_solve(numbers, given)
    values |= dict(zip(unknowns, solved, strict=True))
    varies = any(entry.free_symbols - fixed for row in a for entry in row)
    order = range(len(rows))
    most = [
        max([abs(x) for x in [given[k]]] + [_size(p, values, sizes) for p in loads[k]])
        for k in order
    ]
    if varies:
        for k in order:
            own = [_size(p, values, sizes | {u: abs(values[u]) for u in unknowns})
                   for p in rows[k] if p.has(*unknowns)]  # fmt: skip
            whole = [abs(numbers[k, j] * values[u]) for j, u in enumerate(unknowns)]
            most[k] = max([most[k], *own, *whole])
    inverse = mp.inverse(numbers)
    return {
        u: max(abs(solved[i]), *(abs(inverse[i, k]) * most[k] for k in order))
        for i, u in enumerate(unknowns)
    }


def _products(e: Expr) -> list[Expr]:
    return list(Add.make_args(expand(e)))


def _size(product: Expr, values: dict[Symbol, Any], sizes: dict[Symbol, Any]) -> Any:
    """Return the size of a product: that of its factors, which may be sums of larger terms."""
    found = mpf(1)
    for factor in Mul.make_args(product):
        base, power = factor.as_base_exp()
        size = sizes[base] if base in sizes else abs(_number(base, values))
        found *= size**power
    return found


def _number(e: Expr, known: dict[Symbol, Any]) -> mpf:
    return mpf(e.evalf(30, subs=known))


@pytest.mark.parametrize(("scene", "answer"), ANSWERS)
def test_errors_are_counted_in_the_largest_product_of_the_equation(scene: str, answer: str) -> None:
    library = library_of(scene)
    problem, words = library.problems[answer], library.mechanism.posed(answer).vocabulary
    parameters = {words.symbols[c] for q in words.parameters for c in q.components}
    names = {symbol: name for name, symbol in words.symbols.items()}
    for sample in samples(library.mechanism, F64, 3, 0).each:
        true = reference(equations_of(library.mechanism, problem), sample.values, ())
        known = {s: sample.values[c] for c, s in words.symbols.items() if c in sample.values}
        with mp.workdps(30):
            sizes = unit(problem, known, parameters)
        found = {u: true[names[u]].scale for u in problem.answers}
        assert found == pytest.approx(sizes, rel=1e-12)


def test_products_of_a_matrix_that_varies_count_too() -> None:
    u, v, q, s, p = symbols("u v q s p")
    rows = ((2 + cos(q)) * u + cos(q) * v - s, cos(q) * u + v - p * s + p)
    answers = {x: x for x in (u, v)}
    problem = Problem("both", "", (), answers, {}, rows, (u, v), (), ())
    words = SimpleNamespace(fixed=frozenset, symbols={x.name: x for x in (u, v, q, s, p)})
    posed = SimpleNamespace(vocabulary=words)
    given = {"q": 0.25, "s": 1.0, "p": 1.5}
    true = reference(equations_of(SimpleNamespace(posed=lambda _: posed), problem), given, ())
    with mp.workdps(30):
        sizes = unit(problem, {words.symbols[c]: x for c, x in given.items()}, set())
    assert {u: true["u"].scale, v: true["v"].scale} == pytest.approx(sizes, rel=1e-12)
