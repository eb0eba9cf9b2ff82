"""What errors are counted in is what docs/code.md says: worked out here from the equations alone.

The equations are multiplied out by SymPy and solved as one system by mpmath, so nothing is shared
with how the program takes them apart.
"""

from types import SimpleNamespace
from typing import Any

import pytest
from mpmath import matrix, mp, mpf
from sympy import Add, Expr, S, Symbol, cos, expand, symbols

from derive.mechanics.problem import Problem
from derive.program.precision import F64
from derive.verify.equations import equations
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


def unit(fact: Any, known: dict[Symbol, Any], parameters: set[Symbol]) -> list[float]:
    """Return the largest product in the equations of each unknown, as docs/code.md defines it."""
    unknowns = list(fact.unknowns)
    rows = [list(Add.make_args(expand(row))) for row in fact.residuals]
    a = [[sum((p / u for p in row if p.has(u)), S.Zero) for u in unknowns] for row in rows]
    loads = [[p for p in row if not p.has(*unknowns)] for row in rows]
    numbers = matrix([[_number(entry, known) for entry in row] for row in a])
    given = matrix([-sum(_number(p, known) for p in row) for row in loads])
    solved = mp.lu_solve(numbers, given)
    values = known | dict(zip(unknowns, solved, strict=True))
    varies = any(entry.free_symbols - parameters for row in a for entry in row)
    order = range(len(rows))
    largest = [max(abs(_number(p, known)) for p in (*own, sum(own))) for own in loads]
    if varies:
        each = [[p for p in row if p.has(*unknowns)] for row in rows]
        each = [[*own, *(a[k][j] * unknowns[j] for j in order)] for k, own in enumerate(each)]
        largest = [max(largest[k], *(abs(_number(p, values)) for p in each[k])) for k in order]
    inverse = mp.inverse(numbers)
    return [
        float(max(abs(solved[i]), *(abs(inverse[i, k]) * largest[k] for k in order))) for i in order
    ]


def _number(e: Expr, known: dict[Symbol, Any]) -> mpf:
    return mpf(e.evalf(30, subs=known))


@pytest.mark.parametrize(("scene", "answer"), ANSWERS)
def test_errors_are_counted_in_the_largest_product_of_the_equation(scene: str, answer: str) -> None:
    library = library_of(scene)
    fact, words = library.truths[answer], library.known.words
    parameters = {words.symbols[c] for q in words.parameters for c in q.components}
    names = {symbol: name for name, symbol in words.symbols.items()}
    for sample in samples(library.known, F64, 3, 0).each:
        true = reference(equations(library.known, fact), sample.values, ())
        known = {s: sample.values[c] for c, s in words.symbols.items() if c in sample.values}
        with mp.workdps(30):
            sizes = unit(fact, known, parameters)
        found = [true[names[u]].scale for u in fact.unknowns]
        assert found == pytest.approx(sizes, rel=1e-12)


def test_products_of_a_matrix_that_varies_count_too() -> None:
    u, v, q, s, p = symbols("u v q s p")
    rows = ((2 + cos(q)) * u + cos(q) * v - s, cos(q) * u + v - p * s + p)
    fact = Problem("both", "", (), (u, v), rows, ())
    words = SimpleNamespace(parameters=(), symbols={x.name: x for x in (u, v, q, s, p)})
    given = {"q": 0.25, "s": 1.0, "p": 1.5}
    true = reference(equations(SimpleNamespace(words=words), fact), given, ())
    with mp.workdps(30):
        sizes = unit(fact, {words.symbols[c]: x for c, x in given.items()}, set())
    assert [true["u"].scale, true["v"].scale] == pytest.approx(sizes, rel=1e-12)
