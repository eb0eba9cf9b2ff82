"""What the formulas of motion are given, and what they leave behind for set-up."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from derive.library.function import Graphed
from derive.lower.graph import Graph, Value
from derive.lower.lower import value_of
from derive.lower.setup import exact_number, hot, used_inputs
from derive.motion.exact.inertia import Inertia, as_symmetric
from derive.program.program import Program
from derive.program.tape import Number, Tape, free_prefix, number
from derive.scene.wanted import SPLITTINGS, step_of

MOMENT = ("moment_x", "moment_y", "moment_z")


@dataclass
class Setting:
    """What the formulas of motion are given: the scene, its rates, its body, the tape of set-up.

    moment : the program of the moment along the axes, None if there is none
    given  : the graph's values that set-up works on, by the names that the tape has for them
    """

    terms: Graphed
    rates: Mapping[str, Program]
    moment: Program | None
    tape: Tape
    given: dict[str, Value] = field(default_factory=dict)

    def parameter(self, value: Value) -> Number:
        """Return a parameter-only value of the graph as a number of set-up."""
        exact = exact_number(self.terms.graph, value)
        if exact is not None:
            return number(exact)
        known = {**self.terms.leaves, **self.given}
        name = next((name for name, same in known.items() if same == value), None)
        if name is None:
            name = f"given{len(self.given)}"
            self.given[name] = value
        return self.tape.input(name)

    def inertia(self) -> Inertia:
        """Return the body's tensor along its axes, about the scene's point.

        Moments that are the same formula are equal, whatever kind of body the scene says it is.
        """
        tensor, by_symbol = self.terms.rotation.tensor, self.terms.by_symbol()
        places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        values = [value_of(self.terms.graph, tensor[p], by_symbol) for p in places]
        xx, yy, zz, xy, xz, yz = (self.parameter(value) for value in values)
        return as_symmetric((xx, yy, zz, xy, xz, yz))

    def function(self) -> Tape:
        """Return a tape for a function."""
        return Tape(free_prefix("t", set(self.terms.taken())), below=self.tape)


def applied_moment(terms: Graphed) -> Program | None:
    """Return the program of the moment along the axes, for steps that kick; None if it is zero."""
    if not any(step_of(name) in SPLITTINGS for name in terms.scene.wanted):
        return None
    by_symbol = terms.by_symbol()
    turning = terms.rotation
    values = [value_of(terms.graph, e, by_symbol) for e in turning.moment]
    if not any(coefficient for coefficient, _ in values):
        return None
    ops, results = hot(terms.graph, terms.constants, values, terms.taken())
    varying = (*terms.vocabulary.states, *terms.vocabulary.inputs)
    inputs = used_inputs(varying, ops, results)
    output = replace(turning.omega, name="moment", components=MOMENT, unit="N m")
    return Program("applied_moment", "", inputs, (output,), ops, results)


def held(terms: Graphed) -> dict[str, str]:
    """Return the graph's constants, each with the parameter that it is."""
    return {name: _parameter(terms.graph, v) for v, name in terms.constants.names.items()}


def _parameter(graph: Graph, value: Value) -> str:
    """Return the parameter that a constant is, "" if it is made of several."""
    coefficient, node = value
    kind, *rest = graph.nodes[node]
    return str(rest[0]) if kind == "input" and coefficient == 1 else ""
