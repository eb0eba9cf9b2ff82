"""The Jacobian of any rate, forward through its operations: for bodies that no scene declares."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from derive.program.operations import cos, sin, sqrt
from derive.program.pattern import compressed
from derive.program.program import Op, Operand, Program, Quantity
from derive.program.recorded import called, needed
from derive.program.tape import Number, Tape, number

Rule = Callable[[Sequence[Number], Sequence[Number]], Number]  # of operands and of their slopes
RULES: dict[str, Rule] = {
    "add": lambda _, d: d[0] + d[1],
    "sub": lambda _, d: d[0] - d[1],
    "neg": lambda _, d: -d[0],
    "mul": lambda v, d: d[0] * v[1] + v[0] * d[1],
    "div": lambda v, d: d[0] / v[1] - v[0] * d[1] / (v[1] * v[1]),
    "sin": lambda v, d: cos(v[0]) * d[0],
    "cos": lambda v, d: -sin(v[0]) * d[0],
    "sqrt": lambda v, d: d[0] / (2 * sqrt(v[0])),
}


def with_slopes(rate: Program, columns: Sequence[str]) -> Program:
    """Return a rate with its Jacobian by ``columns``: inputs or constants."""
    tape = Tape("t")
    ops = [op for op in rate.ops if isinstance(op, Op)]
    names = [c for q in rate.inputs for c in q.components]
    given = {name: tape.input(name) for name in names}
    every = replace(rate, results=tuple(op.result for op in ops))
    known = given | dict(zip(every.results, called(tape, every, given), strict=True))

    def value(operand: Operand) -> Number:
        return known[operand] if isinstance(operand, str) else number(operand)

    def column(name: str) -> list[Number]:
        slopes = {name: number(1)}

        def slope(operand: Operand) -> Number:
            return slopes.get(operand, number(0)) if isinstance(operand, str) else number(0)

        for op in ops:
            values, inner = [value(o) for o in op.operands], [slope(o) for o in op.operands]
            slopes[op.result] = RULES[op.operator](values, inner)
        return [slope(result) for result in rate.results]

    matrix = [list(row) for row in zip(*(column(c) for c in columns), strict=True)]
    rows = [f"rate{k}" for k in range(len(matrix))]
    pattern, nonzeros = compressed(matrix, rows, columns, lambda n: n.exact == 0)
    results = (*(value(r).operand for r in rate.results), *(n.operand for n in nonzeros))
    entries = tuple(f"entry{k}" for k in range(len(nonzeros)))
    jacobian = Quantity("jacobian", entries, (len(entries),), "", "", None, None, "")
    return replace(
        rate,
        outputs=(*rate.outputs, jacobian),
        ops=needed(tape.ops, results),
        results=results,
        sparsity={"jacobian": pattern},
    )
