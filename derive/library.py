"""All programs of a scene: one set-up, and for every wanted function its hot part."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

from sympy import Symbol

from derive.arrange import arrange
from derive.draft import Arrangement
from derive.flows.compact import Compact
from derive.flows.series import Series
from derive.forms import Block, best_values, best_with_jacobian, cost
from derive.graph import Graph, Value
from derive.lecture import LECTURE
from derive.lower import lower, value_of
from derive.machine import mechanism as machines
from derive.machine.mechanism import Known, Mechanism
from derive.motions import Moving, motions, needs, traced, with_names
from derive.program import Program, Quantity, Sparsity, read_by
from derive.scene import Machine, Scene, SceneError
from derive.scene.wanted import EQUATIONS, SPLITTINGS, step_of
from derive.specialise import Specialised
from derive.stage import (
    Constant,
    Constants,
    compressed,
    exact_number,
    hot,
    in_pairs,
    setup,
    used_inputs,
    with_low_parts,
)
from derive.truth import Truth
from derive.wording import formula

JACOBIAN = "_jacobian"
STEP, RATE = "step_rk4", "state_rate"  # what moves a machine in time, and what it rests on
SENSITIVITY = "_sensitivity"
INVERSE = re.compile("J_[xyz][xyz]")


@dataclass(frozen=True)
class Library:
    """What a scene's files are printed from.

    functions : what the lecture states; each satisfies one of the ``truths``
    rates     : further such functions that ``motions`` rest on and nobody wanted for themselves
    motions   : what moves the state in time, and formulas for attitudes
    """

    known: Known
    setup: Program
    functions: tuple[Program, ...]
    constants: tuple[Constant, ...]
    truths: Mapping[str, Truth]
    rates: tuple[Program, ...] = ()
    motions: tuple[Program, ...] = ()

    def __getitem__(self, name: str) -> Program:
        return next(p for p in (self.setup, *self.printed(), *self.rates) if p.name == name)

    def printed(self) -> tuple[Program, ...]:
        """Return the functions that are emitted: the lecture's, then those that move the state."""
        return self.functions + self.motions


@dataclass(frozen=True)
class Wanted:
    """A wanted function in the graph: its truth, and its output components by quantity."""

    fact: Truth
    outputs: tuple[tuple[Value, ...], ...]
    positive: tuple[Value, ...]


def library(scene: Scene | Machine) -> Library:
    """Return the programs that ``scene`` asks for."""
    known = machines.in_terms(scene)
    graph = Graph()
    leaves = _leaves(graph, known)
    constants = Constants(graph)
    asked, hidden = _asked(scene)
    bases = dict.fromkeys(map(_base, (*asked, *hidden)))
    truths = {base: machines.truth_of(known, base) for base in bases}
    wanted = {base: _wanted(graph, known, fact, leaves) for base, fact in truths.items()}
    every = {
        name: _values_only(graph, constants, known, wanted[name])
        if name in wanted
        else _with_jacobian(graph, constants, known, wanted[_base(name)], (leaves, name))
        for name in (*asked, *hidden)
    }
    moment = _moment(graph, constants, known, leaves)
    body = cast(Specialised, known)  # a machine wants no motion, and nothing is read from it
    moving = Moving(body, graph, leaves, every, moment)
    moves = motions(moving)
    taken = {name: _parameter(graph, value) for value, name in constants.names.items()}
    traced_part, renaming = traced(moving, taken)
    moves = tuple(with_names(program, renaming) for program in moves)
    read = {name for program in moves for name in read_by(program)}
    kept = {operand: name for operand, name in traced_part.names.items() if name in read}
    traced_part = replace(traced_part, names=kept)
    required = dict.fromkeys(p for w in wanted.values() for p in w.positive if graph.fixed[p[1]])
    positive = [p for p in required if exact_number(graph, p) is None]
    made = setup(graph, constants, known.words.parameters, positive, traced_part)
    meanings = {name: _meaning(graph, value) for value, name in constants.names.items()}
    meanings |= {
        traced_part.names[operand]: says
        for operand, (_, says) in moving.tape.names.items()
        if operand in traced_part.names
    }
    functions = tuple(every.values())
    if scene.form == "accurate" and made.outputs:
        made = with_low_parts(made)
        meanings |= {f"{name}_low": f"what rounding {name} left" for name in list(meanings)}
    functions, moves = _in_parameters(made, functions), _in_parameters(made, moves)
    if scene.form == "accurate":
        functions = tuple(in_pairs(f, set(constants.names.values())) for f in functions)
    fields = [c for q in made.outputs for c in q.components]
    named = tuple(Constant(name, meanings[name]) for name in fields)
    shown, rates = functions[: len(asked)], functions[len(asked) :]
    return Library(known, made, shown, named, truths, rates, moves)


def _asked(scene: Scene | Machine) -> tuple[list[str], list[str]]:
    """Return the functions that satisfy equations, and those that only motions rest on."""
    if isinstance(scene, Machine):
        asked = [name for name in scene.wanted if name != STEP]
        rests = [RATE] if STEP in scene.wanted and RATE not in asked else []
        return asked, rests
    asked = [name for name in scene.wanted if _base(name) in EQUATIONS]
    return asked, [name for name in needs(scene) if name not in asked]


def _moment(
    graph: Graph, constants: Constants, known: Known, leaves: Mapping[str, Value]
) -> Program | None:
    """Return the program of the moment along the axes, for steps that kick; None if it is zero."""
    if isinstance(known, Mechanism):
        return None
    if not any(step_of(name) in SPLITTINGS for name in known.scene.wanted):
        return None
    by_symbol = {known.words.symbols[c]: value for c, value in leaves.items()}
    values = [value_of(graph, e, by_symbol) for e in known.bindings["M"]]
    if not any(coefficient for coefficient, _ in values):
        return None
    ops, results = hot(graph, constants, values)
    inputs = used_inputs((*known.words.states, *known.words.inputs), ops, results)
    output = known.words["moment"]
    return Program("applied_moment", "", inputs, (output,), ops, results)


def _parameter(graph: Graph, value: Value) -> str:
    """Return the parameter that a constant is, "" if it is made of several."""
    coefficient, node = value
    kind, *rest = graph.nodes[node]
    return str(rest[0]) if kind == "input" and coefficient == 1 else ""


def _ways(known: Known, fact: Truth) -> tuple[Arrangement, ...]:
    return machines.arrange(known, fact) if isinstance(known, Mechanism) else arrange(known, fact)


def _meaning(graph: Graph, value: Value) -> str:
    text = formula(graph, value)
    return f"{text[2:]} of the inverse inertia tensor" if INVERSE.fullmatch(text) else text


def _base(name: str) -> str:
    return name.removesuffix(JACOBIAN).removesuffix(SENSITIVITY)


def _leaves(graph: Graph, known: Known) -> dict[str, Value]:
    words = known.words
    leaves = {c: graph.parameter(c) for q in words.parameters for c in q.components}
    varying = [c for q in (*words.states, *words.inputs) for c in q.components]
    return leaves | {c: graph.variable(c) for c in varying}


def _wanted(graph: Graph, known: Known, fact: Truth, leaves: Mapping[str, Value]) -> Wanted:
    by_symbol = {known.words.symbols[c]: value for c, value in leaves.items()}
    ways = [_lowered(graph, fact, way, by_symbol) for way in _ways(known, fact)]
    return min(ways, key=lambda way: cost(graph, _best(graph, way))) if len(ways) > 1 else ways[0]


def _lowered(
    graph: Graph, fact: Truth, way: Arrangement, by_symbol: Mapping[Symbol, Value]
) -> Wanted:
    values, positive = lower(graph, way, by_symbol)
    outputs, place = [], 0
    for quantity in fact.outputs:
        outputs.append(tuple(values[place : place + len(quantity.components)]))
        place += len(quantity.components)
    return Wanted(fact, tuple(outputs), tuple(positive))


def _best(graph: Graph, wanted: Wanted) -> list[Value]:
    return best_values(graph, [Block(output, ()) for output in wanted.outputs])


def _values_only(graph: Graph, constants: Constants, known: Known, wanted: Wanted) -> Program:
    return _program(graph, constants, known, wanted.fact, _best(graph, wanted))


def _with_jacobian(
    graph: Graph,
    constants: Constants,
    known: Known,
    wanted: Wanted,
    by: tuple[Mapping[str, Value], str],
) -> Program:
    leaves, name = by
    columns = _columns(graph, known, wanted)
    if name.endswith(SENSITIVITY):
        columns = (*known.words.states, *known.words.parameters)
    inputs = tuple(tuple(leaves[c] for c in q.components) for q in columns)
    values: list[Value] = []
    rows: list[list[Value]] = []
    for output in wanted.outputs:
        shared = values + [entry for row in rows for entry in row]
        own, derivatives = best_with_jacobian(graph, Block(output, inputs), shared)
        values += own
        rows += derivatives
    row_names = [c for q in wanted.fact.outputs for c in q.components]
    column_names = [c for q in columns for c in q.components]
    pattern, nonzeros = compressed(rows, row_names, column_names)
    if not nonzeros:
        raise SceneError(
            f"scene '{known.scene.name}': wanted '{wanted.fact.name}{JACOBIAN}' must have entries, "
            "but nothing that varies changes it"
        )
    program = _program(graph, constants, known, wanted.fact, [*values, *nonzeros])
    return replace(
        program,
        name=name,
        says=wanted.fact.says.rstrip(".") + ", with its Jacobian.",
        outputs=(*program.outputs, _jacobian_quantity(pattern)),
        sparsity={"jacobian": pattern},
    )


def _jacobian_quantity(pattern: Sparsity) -> Quantity:
    parts = tuple(f"d({pattern.rows[i]})/d({pattern.columns[k]})" for i, k in pattern.places())
    says = "nonzeros of the Jacobian, in compressed-column order"
    return Quantity("jacobian", parts, (len(parts),), "", "", None, None, says)


def _columns(graph: Graph, known: Known, wanted: Wanted) -> tuple[Quantity, ...]:
    """Return what the Jacobian is taken by: every state of a state rate, and all that is used."""
    words = known.words
    used = _inputs_below(graph, [v for output in wanted.outputs for v in output])
    every = (*words.states, *words.inputs)
    whole = words.states if wanted.fact.name == "state_rate" else ()
    return tuple(q for q in every if q in whole or used & set(q.components))


def _inputs_below(graph: Graph, values: Iterable[Value]) -> set[str]:
    """Return the names of all inputs that ``values`` are made of."""
    names: set[str] = set()
    seen: set[int] = set()
    waiting = [node for _, node in values]
    while waiting:
        node = waiting.pop()
        if node in seen:
            continue
        seen.add(node)
        if graph.nodes[node][0] == "input":
            names.add(graph.nodes[node][1])
        waiting += graph.below(node)
    return names


def _program(
    graph: Graph, constants: Constants, known: Known, fact: Truth, values: Sequence[Value]
) -> Program:
    ops, results = hot(graph, constants, values)
    inputs = used_inputs((*known.words.states, *known.words.inputs), ops, results)
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


def _in_parameters(made: Program, functions: Sequence[Program]) -> tuple[Program, ...]:
    """Return the functions, each with the constants as its first input if it uses any."""
    names = {c for q in made.outputs for c in q.components}
    return tuple(_with_inputs(f, made.outputs) if _reads(f, names) else f for f in functions)


def _with_inputs(program: Program, more: tuple[Quantity, ...]) -> Program:
    """Return a program that is given ``more`` before its other inputs."""
    inputs, loops = (*more, *program.inputs), program.loops
    if isinstance(loops, Series):
        loops = replace(loops, inputs=inputs)
    elif isinstance(loops, Compact):
        rate, unrolled = (_with_inputs(p, more) for p in (loops.rate, loops.unrolled))
        loops = replace(loops, rate=rate, unrolled=unrolled)
    return replace(program, inputs=inputs, loops=loops)


def _reads(program: Program, names: set[str]) -> bool:
    return bool(read_by(program) & names)
