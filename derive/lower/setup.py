"""A scene's functions as programs: what depends on parameters only is computed once, in set-up.

All functions of a scene share one graph, one set-up and one struct of named constants. Set-up runs
in twice the working precision and rounds each constant once.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import islice
from math import prod

from derive.lower.graph import ONE, Graph, Value
from derive.lower.schedule import schedule
from derive.lower.wording import spelling
from derive.program.arithmetic import EXACT
from derive.program.program import (
    Line,
    Op,
    Operand,
    Precondition,
    Program,
    Quantity,
    every_op,
    operands_of,
)
from derive.program.recorded import needed, renamed
from derive.program.tape import free_prefix


@dataclass
class Constants:
    """The constants that a scene's hot functions need, in the order they were asked for."""

    graph: Graph
    names: dict[Value, str] = field(default_factory=dict)

    def operand(self, value: Value) -> Operand:
        """Return the number or the name that stands for a parameter-only value."""
        number = exact_number(self.graph, value)
        if number is not None:
            return number
        if value not in self.names:
            self.names[value] = self._fresh(value)
        return self.names[value]

    def _fresh(self, value: Value) -> str:
        coefficient, node = value
        kind, *rest = self.graph.nodes[node]
        taken = set(self.names.values())
        own = rest[0] if kind == "input" else self.graph.names.get(node, "")
        if coefficient == 1 and own.isidentifier() and own not in taken:
            return own
        taken |= self.graph.leaf_names()
        spelled = spelling(self.graph, value)
        if spelled and spelled not in taken:
            return spelled
        return next(name for n in range(1, len(taken) + 2) if (name := f"k{n}") not in taken)


def exact_number(graph: Graph, value: Value) -> Fraction | None:
    """Return what a value without parameters is, None if it has some or is irrational."""
    coefficient, node = value
    known: dict[int, Fraction] = {}
    for n in graph.within([value]):
        made = _exact_node(graph, n, known)
        if made is None:
            return None
        known[n] = made
    return coefficient * known[node]


def _exact_node(graph: Graph, node: int, known: Mapping[int, Fraction]) -> Fraction | None:
    """Return what a node is, by what it is made of."""
    kind, *rest = graph.nodes[node]
    if kind == "one":
        return Fraction(1)
    made: Fraction | None = None
    if kind in ("let", "cut"):
        made = rest[0][0] * known[rest[0][1]]
    elif kind == "sum":
        made = sum((c * known[n] for c, n in rest[0]), Fraction(0))
    elif kind == "product":
        made = prod((known[n] ** p for n, p in rest[0]), start=Fraction(1))
    elif kind == "call" and rest[0] in EXACT:
        made = EXACT[rest[0]](*(c * known[n] for c, n in rest[1]))
    return made


@dataclass(frozen=True)
class SetupPart:
    """A part of set-up that was recorded on a tape of its own.

    given : the graph's value of each input of the tape
    names : the constants that functions read, by operand
    rules : what is found out about the parameters
    """

    ops: tuple[Line, ...]
    given: Mapping[str, Value]
    names: Mapping[str, str] = field(default_factory=dict)
    rules: tuple[Precondition, ...] = ()


def hot(
    graph: Graph, constants: Constants, values: Sequence[Value], taken: Iterable[str]
) -> tuple[tuple[Op, ...], tuple[Operand, ...]]:
    """Return the operations that every call runs, and the operands of the results.

    taken : names of the scene, which no operation may have
    """
    prefix = free_prefix("t", graph.leaf_names() | set(constants.names.values()) | set(taken))
    return schedule(graph, values, lambda node: graph.fixed[node], constants.operand, prefix)


def in_pairs(program: Program, constants: set[str]) -> Program:
    """Return ``program`` for pairs of floats: each constant comes with what its rounding left."""
    used = operands_of(program.ops, program.results) & constants
    ordered = [c for q in program.inputs for c in q.components if c in used]
    every = {n for q in (*program.inputs, *program.outputs) for n in (q.name, *q.components)}
    prefix = free_prefix("w", operands_of(program.ops, program.results) | every)
    whole = {c: f"{prefix}{place}" for place, c in enumerate(ordered)}
    joined = tuple(Op(sum_, "add", (c, f"{c}_low")) for c, sum_ in whole.items())
    ops, results = renamed(program.ops, whole), renamed(program.results, whole)
    return replace(program, ops=joined + ops, results=results, arithmetic="pairs")


def with_low_parts(made: Program) -> Program:
    """Return set-up that also gives what rounding each constant left."""
    (constants,) = made.outputs
    computed = {op.result for op in every_op(made.ops)}
    rounded = [r for r in dict.fromkeys(made.results) if isinstance(r, str) and r in computed]
    lows = tuple(Op(f"{r}low", "low", (r,)) for r in rounded)
    low_of: dict[Operand, str] = {r: op.result for r, op in zip(rounded, lows, strict=True)}
    names = tuple(n for c in constants.components for n in (c, f"{c}_low"))
    zero = Fraction(0)
    results = tuple(x for r in made.results for x in (r, low_of.get(r, zero)))
    both = replace(constants, components=names, shape=(len(names),))
    return replace(made, outputs=(both,), ops=made.ops + lows, results=results)


def setup(
    graph: Graph, constants: Constants, parameters: Sequence[Quantity], parts: Sequence[SetupPart]
) -> Program:
    """Return the program that makes the constants from the parameters.

    parts : what is worked out after the graph's constants, in this order
    """
    values = [*constants.names, *(v for part in parts for v in part.given.values())]
    prefix = free_prefix("s", graph.leaf_names())
    first, found = schedule(graph, values, lambda n: n == ONE, lambda value: value[0], prefix)
    left = iter(found)
    made = list(islice(left, len(constants.names)))
    ops, given, rules = list[Line](first), list(made), list[Precondition]()
    for part in parts:
        at = dict(zip(part.given, left, strict=False))
        made += [at.get(o, o) for o in part.names]
        rules += [replace(r, value=at.get(str(r.value), r.value)) for r in part.rules]
        ops += renamed(part.ops, at)
        given += at.values()
    # a tape may hold what no constant rests on
    whole = needed(ops, (*made, *given, *(rule.value for rule in rules)))
    names = (*constants.names.values(), *(n for part in parts for n in part.names.values()))
    says = "constants of this scene, made of parameters only, each in its own unit"
    output = Quantity("constants", names, (len(names),), "", "", None, None, says, "constants")
    return Program(
        "setup",
        "Make the constants of this scene from its parameters; call it once.",
        used_inputs(parameters, whole, given),
        (output,) if names else (),
        whole,
        tuple(made),
        rules=tuple(rules),
        arithmetic="pairs",
    )


def used_inputs(
    quantities: Sequence[Quantity], ops: Sequence[Line], results: Sequence[Operand]
) -> tuple[Quantity, ...]:
    """Return the quantities of which some component is used: inputs follow from use."""
    used = operands_of(ops, results)
    return tuple(q for q in quantities if used & set(q.components))
