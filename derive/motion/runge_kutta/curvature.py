"""Second derivatives of a state's rates, forward through the program of their Jacobian."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from derive.motion.runge_kutta.matrices import Matrix, NumberRow, product, zeros
from derive.motion.runge_kutta.system import System, pattern_of, slopes_of
from derive.program.program import Op, Operand
from derive.program.recorded import called
from derive.program.slopes import partials
from derive.program.tape import Number, Tape, number


def curvature(
    tape: Tape, system: System, rest: Sequence[int], state: NumberRow, weights: NumberRow
) -> Matrix:
    """Return the second derivatives, by some states and the inputs, of a weighed sum of rates.

    rest : where these states stand, whose rates have the ``weights``
    """
    names = [system.names[k] for k in rest]
    names += [c for q in system.inputs for c in q.components]
    values = {c: tape.input(c) for q in system.inputs for c in q.components}
    values |= dict(zip(system.names, state, strict=True))
    found = zeros(len(names), len(names))
    for row, column, by, entry in _slopes_of_slopes(tape, system, values, names):
        if row in rest:
            i, k = names.index(column), names.index(by)
            found[i][k] = found[i][k] + weights[rest.index(row)] * entry
            found[k][i] = found[i][k]
    return found


def _slopes_of_slopes(
    tape: Tape, system: System, values: Mapping[str, Number], names: Sequence[str]
) -> Iterator[tuple[int, str, str, Number]]:
    """Yield the rates' second derivatives: the rate's place, two names, the value; no zeros."""
    program, pattern = slopes_of(system), pattern_of(system)
    ops = [op for op in program.ops if isinstance(op, Op)]
    every = replace(program, results=tuple(op.result for op in ops))
    known = dict(zip(every.results, called(tape, every, values), strict=True))

    def value(operand: Operand) -> Number:
        if isinstance(operand, Fraction):
            return number(operand)
        return known.get(operand) or values.get(operand) or Number(tape, operand)

    for place, by in enumerate(names):
        slopes = {by: number(1)}
        for op in ops:
            inner = [
                slopes.get(o, number(0)) if isinstance(o, str) else number(0) for o in op.operands
            ]
            if any(x.exact != 0 for x in inner):
                by_each = partials(op, [value(o) for o in op.operands], value(op.result))
                slopes[op.result] = product([list(by_each)], [[x] for x in inner])[0][0]
        for (row, column), result in zip(
            pattern.places(), program.results[len(system.names) :], strict=True
        ):
            found = slopes.get(result) if isinstance(result, str) else None
            name = pattern.columns[column]
            if found is not None and found.exact != 0 and name in names[: place + 1]:
                yield row, name, by, found
