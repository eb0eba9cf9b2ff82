"""From a graph to binary operations, sharing what several values have in common."""

from collections.abc import Callable, Sequence

from derive.lower.graph import ONE, Graph, Value
from derive.lower.share import halve, orient, share_products, share_sums
from derive.lower.table import Signed, Table, enter
from derive.lower.write import Writer, shared_reciprocals
from derive.program.program import Op, Operand
from derive.program.tape import Tape


def schedule(
    graph: Graph,
    outputs: Sequence[Value],
    known: Callable[[int], bool],
    constant: Callable[[Value], Operand],
    prefix: str,
) -> tuple[tuple[Op, ...], tuple[Operand, ...]]:
    """Return operations that compute ``outputs``, and the operands that hold them.

    known    : tells which nodes are constants of this stage
    constant : gives the operand of a constant
    """
    table, results = _shared(graph, outputs, known)
    results = orient(table, results)
    return _written(table, outputs, results, constant, prefix)


def draft(graph: Graph, outputs: Sequence[Value], known: Callable[[int], bool]) -> tuple[Op, ...]:
    """Return the operations of ``schedule`` but for the signs: quicker, to judge a form by."""
    table, results = _shared(graph, outputs, known)
    return _written(table, outputs, results, _as_it_comes, "t")[0]


def _as_it_comes(value: Value) -> Operand:
    return value[0] if value[1] == ONE else f"constant{value}"


def _shared(
    graph: Graph, outputs: Sequence[Value], known: Callable[[int], bool]
) -> tuple[Table, list[Signed | None]]:
    table = Table(graph, known)
    results = [None if known(value[1]) else enter(table, value) for value in outputs]
    halve(table)
    share_products(table)
    share_sums(table)
    return table, results


def _written(
    table: Table,
    outputs: Sequence[Value],
    results: Sequence[Signed | None],
    constant: Callable[[Value], Operand],
    prefix: str,
) -> tuple[tuple[Op, ...], tuple[Operand, ...]]:
    writer = Writer(table, constant, Tape(prefix))
    shared_reciprocals(table, writer)
    operands = [
        constant(value) if result is None else writer.signed(result)
        for value, result in zip(outputs, results, strict=True)
    ]
    return tuple(op for op in writer.tape.ops if isinstance(op, Op)), tuple(operands)
