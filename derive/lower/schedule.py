"""From a graph to binary operations, sharing what several values have in common."""

from collections.abc import Callable, Sequence

from derive.lower.graph import ONE, Graph, Value
from derive.lower.numbering import Numbering, SignedKey, enter
from derive.lower.share import halve, orient, share_products, share_sums
from derive.lower.write import Writer, shared_reciprocals
from derive.program.program import Op, Operand
from derive.program.tape import Tape


def schedule(
    graph: Graph,
    outputs: Sequence[Value],
    fixed: Callable[[int], bool],
    constant: Callable[[Value], Operand],
    prefix: str,
) -> tuple[tuple[Op, ...], tuple[Operand, ...]]:
    """Return operations that compute ``outputs``, and the operands that hold them.

    fixed    : tells which nodes are constants here
    constant : gives the operand of a constant
    """
    numbering, results = _shared(graph, outputs, fixed)
    results = orient(numbering, results)
    return _written(numbering, outputs, results, constant, prefix)


def unoriented(
    graph: Graph, outputs: Sequence[Value], fixed: Callable[[int], bool]
) -> tuple[Op, ...]:
    """Return the operations of ``schedule`` but for the signs: quicker, to judge a form by."""
    numbering, results = _shared(graph, outputs, fixed)
    return _written(numbering, outputs, results, _as_it_comes, "t")[0]


def _as_it_comes(value: Value) -> Operand:
    return value[0] if value[1] == ONE else f"constant{value}"


def _shared(
    graph: Graph, outputs: Sequence[Value], fixed: Callable[[int], bool]
) -> tuple[Numbering, list[SignedKey | None]]:
    numbering = Numbering(graph, fixed)
    results = [None if fixed(value[1]) else enter(numbering, value) for value in outputs]
    halve(numbering)
    share_products(numbering)
    share_sums(numbering)
    return numbering, results


def _written(
    numbering: Numbering,
    outputs: Sequence[Value],
    results: Sequence[SignedKey | None],
    constant: Callable[[Value], Operand],
    prefix: str,
) -> tuple[tuple[Op, ...], tuple[Operand, ...]]:
    writer = Writer(numbering, constant, Tape(prefix))
    shared_reciprocals(numbering, writer)
    operands = [
        constant(value) if result is None else writer.signed(result)
        for value, result in zip(outputs, results, strict=True)
    ]
    return tuple(op for op in writer.tape.ops if isinstance(op, Op)), tuple(operands)
