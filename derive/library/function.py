"""A function that the lecture states, from its problem to its program, and with a Jacobian."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice

from sympy import Symbol

from derive.lecture.chapters import LECTURE
from derive.lower.apart import apart
from derive.lower.arrange import plan
from derive.lower.arrange.arrangement import BY_BALANCES, Arrangement
from derive.lower.expand import families
from derive.lower.forms import (
    Dependents,
    best_values,
    best_with_jacobian,
    cost,
    without_what_cancels,
)
from derive.lower.graph import Graph, Value
from derive.lower.implied import jacobian_by_factors
from derive.lower.lower import lower
from derive.lower.setup import Constants, hot, used_inputs
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.problem import Problem
from derive.mechanics.rotation import FreeRotation
from derive.mechanics.vocabulary import Vocabulary
from derive.program.pattern import compressed
from derive.program.program import MATRIX, Program, Quantity, Sparsity
from derive.scene import Scene, SceneError
from derive.scene.wanted import JACOBIAN, SENSITIVITY, without_ending

MANY_UNKNOWNS = 4
"""Of so many, no solution is differentiated where its factors will do: that is dearer, and slow."""


@dataclass(frozen=True)
class Graphed:
    """A scene in a graph: its components' values, and the constants its functions asked for.

    best : the cheapest values of outputs, where they were looked for already
    """

    mechanism: Mechanism
    graph: Graph
    leaves: Mapping[str, Value]
    constants: Constants
    best: dict[tuple[tuple[Value, ...], ...], list[Value]] = field(default_factory=dict)

    @property
    def scene(self) -> Scene:
        """Return the scene as it was read."""
        return self.mechanism.scene

    @property
    def vocabulary(self) -> Vocabulary:
        """Return what the scene's quantities are called."""
        return self.mechanism.vocabulary

    def taken(self) -> frozenset[str]:
        """Return the names that no operation may have: those of all quantities and components."""
        return frozenset(n for q in self.vocabulary.every() for n in (q.name, *q.components))

    def by_symbol(self) -> dict[Symbol, Value]:
        """Return the value of every component by its symbol."""
        return {self.vocabulary.symbols[c]: value for c, value in self.leaves.items()}

    @cached_property
    def rotation(self) -> FreeRotation:
        """Return the free rotation that a step moves on.

        Raises SceneError if more than one body turning freely is in motion.
        """
        found = self.mechanism.rotation()
        if found is None:
            rule = "is of bodies that turn freely as one, and other things move with these"
            raise SceneError(f"a step of a free rotation {rule}")
        return found


@dataclass(frozen=True)
class Arranged:
    """A wanted function in the graph: its problem, and its output components by quantity.

    ways    : operations of the cheapest program of each way to arrange it, the way taken first
    implied : the cheapest arrangement of each way whose slopes follow from equations it solves
    """

    problem: Problem
    outputs: tuple[tuple[Value, ...], ...]
    ways: Mapping[str, int] = field(default_factory=dict)
    implied: tuple[Arrangement, ...] = ()


def graphed(mechanism: Mechanism) -> Graphed:
    """Return a scene in a graph that holds its parameters, states and inputs, and nothing else."""
    graph, vocabulary = Graph(), mechanism.vocabulary
    leaves = {c: graph.parameter(c) for q in vocabulary.parameters for c in q.components}
    varying = [c for q in (*vocabulary.states, *vocabulary.inputs) for c in q.components]
    leaves |= {c: graph.variable(c) for c in varying}
    return Graphed(mechanism, graph, leaves, Constants(graph))


def arranged(terms: Graphed, base: str) -> Arranged:
    """Return what the lecture says of a function, in the cheapest way to compute it."""
    problem = terms.mechanism.problem(base)
    ways = plan.arrange(terms.mechanism, problem)
    found = [_lowered(terms, problem, way) for way in ways]
    if len(found) == 1:
        return replace(found[0], ways={ways[0].by: 0})
    costs = [cost(terms.graph, _best(terms, one)) for one in found]
    order = sorted(
        range(len(found)), key=lambda n: (costs[n][0], ways[n].by != BY_BALANCES, costs[n][1])
    )
    each: dict[str, int] = {}
    implied: dict[str, Arrangement] = {}
    for n in order:
        each.setdefault(ways[n].by, costs[n][0])
        told = ways[n].implied
        if told is not None and (told.plain or n == order[0]):  # where values divide by it anyway
            implied.setdefault(ways[n].by, ways[n])
    return replace(found[order[0]], ways=each, implied=tuple(implied.values()))


def function(terms: Graphed, wanted: Arranged, name: str) -> Program:
    """Return the program of a wanted function by its name, which says if a Jacobian is with it."""
    if name == without_ending(name):
        return _program(terms, wanted.problem, _best(terms, wanted))
    return _with_jacobian(terms, wanted, name)


def _lowered(terms: Graphed, problem: Problem, way: Arrangement) -> Arranged:
    lowered = lower(terms.graph, way, terms.by_symbol())
    (found,) = without_what_cancels(terms.graph, [lowered])
    values = iter(found)
    return Arranged(
        problem, tuple(tuple(islice(values, len(q.components))) for q in problem.outputs)
    )


def _best(terms: Graphed, wanted: Arranged) -> list[Value]:
    if wanted.outputs not in terms.best:
        found = best_values(terms.graph, [Dependents(output, ()) for output in wanted.outputs])
        stands = [value for output in wanted.outputs for value in output]
        each = (found, stands)
        terms.best[wanted.outputs] = min(each, key=lambda values: cost(terms.graph, values))
    return terms.best[wanted.outputs]


def _with_jacobian(terms: Graphed, wanted: Arranged, name: str) -> Program:
    problem, columns = wanted.problem, _columns(terms, wanted, name)
    values, rows = _differentiated(terms, wanted, columns)
    row_names = [c for q in problem.outputs for c in q.components]
    column_names = [c for q in columns for c in q.components]
    pattern, nonzeros = compressed(rows, row_names, column_names, lambda v: not v[0])
    if not nonzeros:
        rule = "must have entries, but nothing that varies changes it"
        raise SceneError(f"wanted '{problem.name}{JACOBIAN}' {rule}")
    program = _program(terms, problem, [*values, *nonzeros])
    return replace(
        program,
        name=name,
        says=problem.says.rstrip(".") + ", with its Jacobian.",
        outputs=(*program.outputs, _jacobian_quantity(pattern)),
        sparsity={MATRIX: pattern},
    )


def _differentiated(
    terms: Graphed, wanted: Arranged, columns: Sequence[Quantity]
) -> tuple[list[Value], list[list[Value]]]:
    """Return the outputs' values and the rows of their Jacobian, sharing all that they can.

    Outputs are looked at one by one, and those together that vary by components of one vector.
    """
    inputs = tuple(tuple(terms.leaves[c] for c in q.components) for q in columns)
    leaves = [leaf for quantity in inputs for leaf in quantity]
    every = (jacobian_by_factors(terms.graph, way, terms.by_symbol(), leaves)
             for way in wanted.implied)  # fmt: skip
    found = [one for one in every if one is not None]
    many = len(wanted.problem.unknowns) >= MANY_UNKNOWNS
    if not (found and many and all(w.implied and w.implied.plain for w in wanted.implied)):
        ways = dict.fromkeys((_one_by_one(wanted), _together(terms.graph, wanted)))
        found += [_in_groups(terms.graph, wanted, groups, inputs) for groups in ways]
    return min(found, key=lambda one: cost(terms.graph, [*one[0], *(e for r in one[1] for e in r)]))


Partition = tuple[tuple[int, ...], ...]


def _one_by_one(wanted: Arranged) -> Partition:
    return tuple((n,) for n in range(len(wanted.outputs)))


def _together(graph: Graph, wanted: Arranged) -> Partition:
    """Return the places of outputs in groups that share a vector which they vary by."""
    every = ({f for v in output for f in families(graph, v)} for output in wanted.outputs)
    return tuple(apart([{f for f in own if isinstance(f, str)} for own in every]))


def _in_groups(
    graph: Graph, wanted: Arranged, groups: Partition, inputs: tuple[tuple[Value, ...], ...]
) -> tuple[list[Value], list[list[Value]]]:
    """Return values and rows in the order of the outputs, each group looked at as one."""
    values: dict[int, list[Value]] = {}
    rows: dict[int, list[list[Value]]] = {}
    for group in groups:
        dependents = Dependents(tuple(v for n in group for v in wanted.outputs[n]), inputs)
        before = [v for each in values.values() for v in each]
        before += [entry for each in rows.values() for row in each for entry in row]
        found, slopes = best_with_jacobian(graph, dependents, before)
        own, own_rows = iter(found), iter(slopes)
        for n in group:
            size = len(wanted.outputs[n])
            values[n], rows[n] = list(islice(own, size)), list(islice(own_rows, size))
    order = sorted(values)
    return [v for n in order for v in values[n]], [row for n in order for row in rows[n]]


def _jacobian_quantity(pattern: Sparsity) -> Quantity:
    parts = tuple(f"d({pattern.rows[i]})/d({pattern.columns[k]})" for i, k in pattern.places())
    says = "nonzeros of the Jacobian, in compressed-column order, each in its own unit"
    return Quantity(MATRIX, parts, (len(parts),), "", "", None, None, says)


def _columns(terms: Graphed, wanted: Arranged, name: str) -> tuple[Quantity, ...]:
    """Return what the Jacobian is taken by: every state of a state rate, and all that is used."""
    vocabulary = terms.vocabulary
    if name.endswith(SENSITIVITY):
        return (*vocabulary.states, *vocabulary.parameters)
    graph, values = terms.graph, (v for output in wanted.outputs for v in output)
    below = (graph.nodes[n] for n in graph.within(values))
    used = {node[1] for node in below if node[0] == "input"}
    every = (*vocabulary.states, *vocabulary.inputs)
    whole = vocabulary.states if wanted.problem.name == "state_rate" else ()
    return tuple(q for q in every if q in whole or used & set(q.components))


def _program(terms: Graphed, problem: Problem, values: Sequence[Value]) -> Program:
    vocabulary = terms.vocabulary
    ops, results = hot(terms.graph, terms.constants, values, terms.taken())
    inputs = used_inputs((*vocabulary.states, *vocabulary.inputs), ops, results)
    assumptions = sorted({a for step in problem.steps for a in LECTURE.assumptions(step)})
    return Program(
        problem.name,
        problem.says,
        inputs,
        problem.outputs,
        ops,
        results,
        steps=problem.steps,
        assumptions=tuple(assumptions),
    )
