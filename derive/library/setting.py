"""What the formulas of motion are given, and what they leave behind for set-up."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from derive.library.function import Graphed
from derive.lower.graph import Graph, Value
from derive.lower.lower import value_of
from derive.lower.stage import exact_number, hot, used_inputs
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.rotation import FreeRotation, free_rotation
from derive.motion.exact.inertia import Inertia, as_symmetric
from derive.program.program import Program
from derive.program.tape import Number, Tape, free_prefix, number
from derive.scene import SceneError
from derive.scene.wanted import SPLITTINGS, step_of

MOMENT = ("moment_x", "moment_y", "moment_z")


@dataclass
class Setting:
    """What the formulas of motion are given: the scene, its rates, its body, the tape of set-up.

    moment : the program of the moment along the axes, None if there is none
    given  : the graph's values that set-up works on, by the names that the tape has for them
    """

    scene: Graphed
    rates: Mapping[str, Program]
    moment: Program | None
    tape: Tape
    given: dict[str, Value] = field(default_factory=dict)

    @property
    def known(self) -> Mechanism:
        """Return the scene in the lecture's terms."""
        return self.scene.known

    def parameter(self, value: Value) -> Number:
        """Return a parameter-only value of the graph as a number of set-up."""
        exact = exact_number(self.scene.graph, value)
        if exact is not None:
            return number(exact)
        known = {**self.scene.leaves, **self.given}
        name = next((name for name, same in known.items() if same == value), None)
        if name is None:
            name = f"given{len(self.given)}"
            self.given[name] = value
        return self.tape.input(name)

    def inertia(self) -> Inertia:
        """Return the body's tensor along its axes, about the scene's point.

        Moments that are the same formula are equal, whatever kind of body the scene says it is.
        """
        tensor, by_symbol = rotation_of(self.scene).tensor, self.scene.by_symbol()
        places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        values = [value_of(self.scene.graph, tensor[p], by_symbol) for p in places]
        xx, yy, zz, xy, xz, yz = (self.parameter(value) for value in values)
        return as_symmetric((xx, yy, zz, xy, xz, yz))

    def function(self) -> Tape:
        """Return a tape for a function."""
        return Tape(free_prefix("t", set(self.scene.taken())), below=self.tape)


def rotation_of(scene: Graphed) -> FreeRotation:
    """Return the free rotation that a step moves on.

    Raises SceneError if more than one body turning freely is in motion.
    """
    found = free_rotation(scene.known)
    if found is None:
        rule = "is of bodies that turn freely as one, and other things move with these"
        raise SceneError(f"a step of a free rotation {rule}")
    return found


def applied_moment(scene: Graphed) -> Program | None:
    """Return the program of the moment along the axes, for steps that kick; None if it is zero."""
    known = scene.known
    if not any(step_of(name) in SPLITTINGS for name in known.scene.wanted):
        return None
    by_symbol = scene.by_symbol()
    turning = rotation_of(scene)
    values = [value_of(scene.graph, e, by_symbol) for e in turning.moment]
    if not any(coefficient for coefficient, _ in values):
        return None
    ops, results = hot(scene.graph, scene.constants, values, scene.taken())
    inputs = used_inputs((*known.words.states, *known.words.inputs), ops, results)
    output = replace(turning.omega, name="moment", components=MOMENT, unit="N m")
    return Program("applied_moment", "", inputs, (output,), ops, results)


def held(scene: Graphed) -> dict[str, str]:
    """Return the graph's constants, each with the parameter that it is."""
    return {name: _parameter(scene.graph, v) for v, name in scene.constants.names.items()}


def _parameter(graph: Graph, value: Value) -> str:
    """Return the parameter that a constant is, "" if it is made of several."""
    coefficient, node = value
    kind, *rest = graph.nodes[node]
    return str(rest[0]) if kind == "input" and coefficient == 1 else ""
