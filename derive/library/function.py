"""A function that the lecture states, from its truth to its program, with or without a Jacobian."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice

from sympy import Symbol

from derive.lecture.chapters import LECTURE
from derive.lower.apart import apart
from derive.lower.arrange import plan
from derive.lower.arrange.draft import Arrangement
from derive.lower.expand import families
from derive.lower.forms import Block, best_values, best_with_jacobian, cost
from derive.lower.graph import Graph, Value
from derive.lower.lower import lower
from derive.lower.stage import Constants, hot, used_inputs
from derive.mechanics.mechanism import Mechanism, problem
from derive.mechanics.problem import Problem
from derive.program.pattern import compressed
from derive.program.program import Program, Quantity, Sparsity
from derive.scene import SceneError
from derive.scene.wanted import JACOBIAN, SENSITIVITY, base_of


@dataclass(frozen=True)
class Graphed:
    """A scene in a graph: its components' values, and the constants its functions asked for.

    best : the cheapest values of outputs, where they were looked for already
    """

    known: Mechanism
    graph: Graph
    leaves: Mapping[str, Value]
    constants: Constants
    best: dict[tuple[tuple[Value, ...], ...], list[Value]] = field(default_factory=dict)

    def taken(self) -> frozenset[str]:
        """Return the names that no operation may have: those of all quantities and components."""
        words = self.known.words
        return frozenset(n for q in words.every() for n in (q.name, *q.components))

    def by_symbol(self) -> dict[Symbol, Value]:
        """Return the value of every component by its symbol."""
        return {self.known.words.symbols[c]: value for c, value in self.leaves.items()}


@dataclass(frozen=True)
class Arranged:
    """A wanted function in the graph: its truth, and its output components by quantity."""

    fact: Problem
    outputs: tuple[tuple[Value, ...], ...]


def graphed(known: Mechanism) -> Graphed:
    """Return a scene in a graph that holds its parameters, states and inputs, and nothing else."""
    graph, words = Graph(), known.words
    leaves = {c: graph.parameter(c) for q in words.parameters for c in q.components}
    varying = [c for q in (*words.states, *words.inputs) for c in q.components]
    leaves |= {c: graph.variable(c) for c in varying}
    return Graphed(known, graph, leaves, Constants(graph))


def arranged(scene: Graphed, base: str) -> Arranged:
    """Return what the lecture says of a function, in the cheapest way to compute it."""
    fact = problem(scene.known, base)
    found = [_lowered(scene, fact, way) for way in plan.arrange(scene.known, fact)]
    if len(found) == 1:
        return found[0]
    return min(found, key=lambda way: cost(scene.graph, _best(scene, way)))


def function(scene: Graphed, wanted: Arranged, name: str) -> Program:
    """Return the program of a wanted function by its name, which says if a Jacobian is with it."""
    if name == base_of(name):
        return _program(scene, wanted.fact, _best(scene, wanted))
    return _with_jacobian(scene, wanted, name)


def _lowered(scene: Graphed, fact: Problem, way: Arrangement) -> Arranged:
    values = iter(lower(scene.graph, way, scene.by_symbol()))
    return Arranged(fact, tuple(tuple(islice(values, len(q.components))) for q in fact.outputs))


def _best(scene: Graphed, wanted: Arranged) -> list[Value]:
    if wanted.outputs not in scene.best:
        found = best_values(scene.graph, [Block(output, ()) for output in wanted.outputs])
        stands = [value for output in wanted.outputs for value in output]
        each = (found, stands)
        scene.best[wanted.outputs] = min(each, key=lambda values: cost(scene.graph, values))
    return scene.best[wanted.outputs]


def _with_jacobian(scene: Graphed, wanted: Arranged, name: str) -> Program:
    fact, columns = wanted.fact, _columns(scene, wanted, name)
    values, rows = _differentiated(scene, wanted, columns)
    row_names = [c for q in fact.outputs for c in q.components]
    column_names = [c for q in columns for c in q.components]
    pattern, nonzeros = compressed(rows, row_names, column_names, lambda v: not v[0])
    if not nonzeros:
        rule = "must have entries, but nothing that varies changes it"
        raise SceneError(f"wanted '{fact.name}{JACOBIAN}' {rule}")
    program = _program(scene, fact, [*values, *nonzeros])
    return replace(
        program,
        name=name,
        says=fact.says.rstrip(".") + ", with its Jacobian.",
        outputs=(*program.outputs, _jacobian_quantity(pattern)),
        sparsity={"jacobian": pattern},
    )


def _differentiated(
    scene: Graphed, wanted: Arranged, columns: Sequence[Quantity]
) -> tuple[list[Value], list[list[Value]]]:
    """Return the outputs' values and the rows of their Jacobian, sharing all that they can.

    Outputs are looked at one by one, and those together that vary by components of one vector.
    """
    inputs = tuple(tuple(scene.leaves[c] for c in q.components) for q in columns)
    ways = dict.fromkeys((_one_by_one(wanted), _together(scene.graph, wanted)))
    found = [_in_groups(scene.graph, wanted, groups, inputs) for groups in ways]
    return min(found, key=lambda one: cost(scene.graph, [*one[0], *(e for r in one[1] for e in r)]))


Groups = tuple[tuple[int, ...], ...]


def _one_by_one(wanted: Arranged) -> Groups:
    return tuple((n,) for n in range(len(wanted.outputs)))


def _together(graph: Graph, wanted: Arranged) -> Groups:
    """Return the places of outputs in groups that share a vector which they vary by."""
    every = ({f for v in output for f in families(graph, v)} for output in wanted.outputs)
    return tuple(apart([{f for f in own if isinstance(f, str)} for own in every]))


def _in_groups(
    graph: Graph, wanted: Arranged, groups: Groups, inputs: tuple[tuple[Value, ...], ...]
) -> tuple[list[Value], list[list[Value]]]:
    """Return values and rows in the order of the outputs, each group looked at as one block."""
    values: dict[int, list[Value]] = {}
    rows: dict[int, list[list[Value]]] = {}
    for group in groups:
        block = Block(tuple(v for n in group for v in wanted.outputs[n]), inputs)
        before = [v for each in values.values() for v in each]
        before += [entry for each in rows.values() for row in each for entry in row]
        found, slopes = best_with_jacobian(graph, block, before)
        own, own_rows = iter(found), iter(slopes)
        for n in group:
            size = len(wanted.outputs[n])
            values[n], rows[n] = list(islice(own, size)), list(islice(own_rows, size))
    order = sorted(values)
    return [v for n in order for v in values[n]], [row for n in order for row in rows[n]]


def _jacobian_quantity(pattern: Sparsity) -> Quantity:
    parts = tuple(f"d({pattern.rows[i]})/d({pattern.columns[k]})" for i, k in pattern.places())
    says = "nonzeros of the Jacobian, in compressed-column order, each in its own unit"
    return Quantity("jacobian", parts, (len(parts),), "", "", None, None, says)


def _columns(scene: Graphed, wanted: Arranged, name: str) -> tuple[Quantity, ...]:
    """Return what the Jacobian is taken by: every state of a state rate, and all that is used."""
    words = scene.known.words
    if name.endswith(SENSITIVITY):
        return (*words.states, *words.parameters)
    graph, values = scene.graph, (v for output in wanted.outputs for v in output)
    below = (graph.nodes[n] for n in graph.within(values))
    used = {node[1] for node in below if node[0] == "input"}
    every = (*words.states, *words.inputs)
    whole = words.states if wanted.fact.name == "state_rate" else ()
    return tuple(q for q in every if q in whole or used & set(q.components))


def _program(scene: Graphed, fact: Problem, values: Sequence[Value]) -> Program:
    words = scene.known.words
    ops, results = hot(scene.graph, scene.constants, values, scene.taken())
    inputs = used_inputs((*words.states, *words.inputs), ops, results)
    assumptions = sorted({a for step in fact.steps for a in LECTURE.assumptions(step)})
    return Program(
        fact.name,
        fact.says,
        inputs,
        fact.outputs,
        ops,
        results,
        steps=fact.steps,
        assumptions=tuple(assumptions),
    )
