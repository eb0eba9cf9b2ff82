"""From a graph to binary operations, sharing what several values have in common."""

from collections.abc import Callable, Sequence

from derive.graph import Graph, Value
from derive.program import Op, Operand
from derive.share import halve, orient, share_products, share_sums
from derive.table import Table, enter
from derive.write import Writer, shared_reciprocals


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
    table = Table(graph, known)
    results = [None if known(value[1]) else enter(table, value) for value in outputs]
    halve(table)
    share_products(table)
    share_sums(table)
    results = orient(table, results)
    writer = Writer(table, constant, prefix)
    shared_reciprocals(table, writer)
    operands = [
        constant(value) if result is None else writer.signed(result)
        for value, result in zip(outputs, results, strict=True)
    ]
    return tuple(writer.ops), tuple(operands)
