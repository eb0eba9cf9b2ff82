"""The programs that move a scene in time, and its formulas for attitudes, by their wanted names.

Formulas stand in ``flows`` and ``rotations``; here they are given the scene's body, state and
rates, and become programs. What rests on parameters only is on the tape of set-up.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from derive.flows import steps
from derive.flows.carried import remainder
from derive.flows.compact import compact
from derive.flows.exact import flow_exact
from derive.flows.inertia import Inertia
from derive.flows.moser_veselov import plan_dmv, step_dmv
from derive.flows.splitting import step_split, step_split_compensated
from derive.flows.system import System, next_of
from derive.flows.taylor import taylor_step
from derive.graph import Graph, Value
from derive.lecture import LECTURE
from derive.lower import value_of
from derive.program import Operand, Program, Quantity, renamed
from derive.recorded import called, needed
from derive.rotations.functions import attitude_program
from derive.scene import Scene, SceneError
from derive.scene.wanted import ATTITUDES, SPLITTINGS, STEP_DERIVATIVES, TAYLOR, moves, step_of
from derive.specialise import Specialised
from derive.stage import Traced, exact_number, used_inputs
from derive.trace import Number, Tape, number
from derive.vocabulary import Vocabulary

LOOPED = ("step_rk4", "step_rk4_jacobian", "step_rk4_sensitivity")
"""Steps that may be printed as loops over their stages."""
COMPENSATION = "_compensated"
FREE_ROTATION = tuple(
    sorted(
        {
            assumption
            for step in ("general_form", "quaternion_rate_scalar", "quaternion_rate_vector")
            for assumption in LECTURE.assumptions(step)
        }
    )
)
"""What the closed forms and splittings of a free rotation rest on."""
RATES = ("step_rk4", "step_lie", *TAYLOR)
"""Steps that are made from the rate of the state."""
SLOPES = {
    "jacobian": "state_rate_jacobian",
    "tangent": "state_rate_jacobian",
    "sensitivity": "state_rate_sensitivity",
}
"""What the derivatives of a step rest on, by kind."""


@dataclass
class Moving:
    """What the formulas of motion are given: the scene, its rates, its body, the tape of set-up.

    moment : the program of the moment along the axes, None if there is none
    """

    known: Specialised
    graph: Graph
    leaves: Mapping[str, Value]
    rates: Mapping[str, Program]
    moment: Program | None
    tape: Tape = field(default_factory=lambda: Tape("p"))
    given: dict[str, Value] = field(default_factory=dict)

    def parameter(self, value: Value) -> Number:
        """Return a parameter-only value of the graph as a number of set-up."""
        exact = exact_number(self.graph, value)
        if exact is not None:
            return number(exact)
        own = [name for name, leaf in self.leaves.items() if leaf == value]
        name = own[0] if own else f"given{len(self.given)}"
        if not own:
            self.given[name] = value
        return self.tape.input(name)

    def inertia(self) -> Inertia:
        """Return the body's tensor along its axes, about the scene's point."""
        tensor, body = self.known.bindings["I"], self.known.scene.body
        by_symbol = {self.known.words.symbols[c]: v for c, v in self.leaves.items()}
        places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        values = [value_of(self.graph, tensor[p], by_symbol) for p in places]
        xx, yy, zz, xy, xz, yz = (self.parameter(value) for value in values)
        kind = body.kind if body.kind != "rod" else "axisymmetric"
        if kind == "general" and all(n.exact == 0 for n in (xy, xz, yz)):
            kind = "principal"
        return Inertia((xx, yy, zz, xy, xz, yz), kind, body.axis)

    def function(self) -> Tape:
        """Return a tape for a function."""
        return Tape("t", below=self.tape)


def needs(scene: Scene) -> tuple[str, ...]:
    """Return the equations that the wanted steps rest on, whether they are wanted themselves."""
    steps = [name for name in scene.wanted if step_of(name) in RATES]
    slopes = [SLOPES[name.rpartition("_")[2]] for name in steps if name in STEP_DERIVATIVES]
    return tuple(dict.fromkeys(["state_rate"] * bool(steps) + slopes))


def motions(moving: Moving) -> tuple[Program, ...]:
    """Return the programs of all wanted motions and attitude formulas, in the scene's order."""
    found: dict[str, Program] = {}
    for name in moving.known.scene.wanted:
        if name in ATTITUDES:
            found[name] = attitude_program(name)
        elif moves(name):
            found |= {program.name: program for program in _motion(moving, name)}
    return tuple(found.values())


def _motion(moving: Moving, name: str) -> tuple[Program, ...]:
    step = step_of(name)
    if name == "flow_exact":
        return (_flow_exact(moving),)
    if name == "step_dmv":
        return _dmv(moving)
    if step in TAYLOR:
        return (_taylor(moving, TAYLOR[step]),)
    if step in SPLITTINGS:
        return (_split(moving, name),)
    return (_runge_kutta(moving, name),)


def _taylor(moving: Moving, order: int) -> Program:
    words, rate = moving.known.words, moving.rates["state_rate"]
    step = _time(moving.known.scene, "time_step")
    series = taylor_step(rate, words.states, words.inputs, order, step)
    return replace(series.signature, loops=series, assumptions=rate.assumptions)


_STEP_PROGRAMS: Mapping[str, Callable[[System], Program]] = {
    "step_rk4": steps.step_rk4,
    "step_rk4_compensated": steps.step_rk4_compensated,
    "step_rk4_jacobian": steps.step_rk4_jacobian,
    "step_rk4_tangent": steps.step_rk4_tangent,
    "step_rk4_sensitivity": steps.step_rk4_sensitivity,
    "step_lie": steps.step_lie,
    "step_lie_compensated": steps.step_lie_compensated,
    "step_lie_jacobian": steps.step_lie_jacobian,
    "step_lie_tangent": steps.step_lie_tangent,
}


def _runge_kutta(moving: Moving, name: str) -> Program:
    rates, step = moving.rates, _time(moving.known.scene, "time_step")
    slopes = rates[SLOPES[name.rpartition("_")[2]]] if name in STEP_DERIVATIVES else None
    system = System(moving.known.words.states, rates["state_rate"], slopes, step)
    program = _STEP_PROGRAMS[name](system)
    if program.sparsity and not any(pattern.row for pattern in program.sparsity.values()):
        raise SceneError(
            f"scene '{moving.known.scene.name}': wanted '{name}' must have entries, "
            "but nothing that it is a derivative by changes the step"
        )
    program = replace(
        program,
        inputs=used_inputs(program.inputs, program.ops, program.results),
        assumptions=rates["state_rate"].assumptions,
    )
    small = moving.known.scene.emission == "compact" and name in LOOPED
    return compact(system, program) if small else program


def _time(scene: Scene, name: str) -> Quantity:
    given = scene.time_step if name == "time_step" else scene.time
    says = "length of the step" if name == "time_step" else "time from the given to the new state"
    return Quantity(name, (name,), (), "s", "", given.low, given.high, says)


@dataclass(frozen=True)
class Recorded:
    """A function as it was traced: what goes in, what comes out, and by which numbers."""

    inputs: tuple[Quantity, ...]
    outputs: tuple[Quantity, ...]
    results: tuple[Number, ...]


def _program(name: str, says: str, tape: Tape, made: Recorded) -> Program:
    results: tuple[Operand, ...] = tuple(
        tape.below.constant(n.operand)
        if tape.below is not None and n.tape is tape.below and isinstance(n.operand, str)
        else n.operand
        for n in made.results
    )
    ops = needed(tape.ops, results)
    inputs = used_inputs(made.inputs, ops, results)
    return Program(name, says, inputs, made.outputs, ops, results, assumptions=FREE_ROTATION)


def _inputs(tape: Tape, q: Quantity) -> list[Number]:
    return [tape.input(c) for c in q.components]


def _rotation(words: Vocabulary) -> tuple[Quantity, Quantity]:
    return words["attitude"], words["omega"]


def _flow_exact(moving: Moving) -> Program:
    tape, words = moving.function(), moving.known.words
    attitude, omega = _rotation(words)
    time = _time(moving.known.scene, "time")
    (t,) = _inputs(tape, time)
    q, w = flow_exact(tape, moving.inertia(), _inputs(tape, attitude), _inputs(tape, omega), t)
    outputs = (next_of(attitude), next_of(omega))
    says = "Attitude and angular velocity after any time without torque (exact solution)."
    made = Recorded((attitude, omega, time), outputs, (*map(number, q), *map(number, w)))
    return _program("flow_exact", says, tape, made)


def _dmv(moving: Moving) -> tuple[Program, ...]:
    words, step = moving.known.words, _time(moving.known.scene, "time_step")
    omega = words["omega"]
    tape = moving.function()
    (h,) = _inputs(tape, step)
    entries = plan_dmv(tape, moving.inertia(), _inputs(tape, omega), h)
    names = tuple(f"plan_{name}" for name, _, _ in entries)
    plan = Quantity(
        "plan", names, (len(names),), "", "", None, None,
        "what a motion without torque and a length of step keep",
    )  # fmt: skip
    says = "Plan many steps of one length from an angular velocity; call it once."
    made = Recorded((omega, step), (plan,), tuple(number(n) for _, n, _ in entries))
    planned = _program("plan_dmv", says, tape, made)
    return planned, _dmv_step(moving, plan, [name for name, _, _ in entries])


def _dmv_step(moving: Moving, plan: Quantity, names: Sequence[str]) -> Program:
    tape, (attitude, omega) = moving.function(), _rotation(moving.known.words)
    rest = remainder((attitude, omega))
    planned = dict(zip(names, _inputs(tape, plan), strict=True))
    q, w, left = step_dmv(
        tape,
        moving.inertia(),
        planned,
        _inputs(tape, attitude),
        _inputs(tape, omega),
        _inputs(tape, rest),
    )
    outputs = (next_of(attitude), next_of(omega), next_of(rest))
    says = "One step of a torque-free rotation, as plan_dmv laid it out (order 10)."
    made = Recorded((plan, attitude, omega, rest), outputs, tuple(map(number, (*q, *w, *left))))
    return _program("step_dmv", says, tape, made)


def _split(moving: Moving, name: str) -> Program:
    tape, step = moving.function(), _time(moving.known.scene, "time_step")
    attitude, omega = _rotation(moving.known.words)
    order, body, rest = SPLITTINGS[step_of(name)], moving.inertia(), remainder((attitude, omega))
    (h,) = _inputs(tape, step)
    given = _inputs(tape, attitude), _inputs(tape, omega), _moment(moving, tape), h
    inputs = (attitude, omega, *_outside(moving), step)
    outputs = [next_of(attitude), next_of(omega)]
    says = "One step of the rotation by splitting it into turns about two axes"
    if name.endswith(COMPENSATION):
        moved: tuple[list[Number], ...] = step_split_compensated(
            tape, body, order, *given, _inputs(tape, rest)
        )
        inputs, outputs = (*inputs, rest), [*outputs, next_of(rest)]
        says += f" (order {order}), carrying what rounding leaves."
    else:
        moved = step_split(tape, body, order, *given)
        says += f" (order {order})."
    made = Recorded(inputs, tuple(outputs), tuple(number(n) for part in moved for n in part))
    return _program(name, says, tape, made)


def _outside(moving: Moving) -> tuple[Quantity, ...]:
    """Return the inputs that the moment may use, held while the step lasts."""
    states = moving.known.words.states
    return tuple(q for q in moving.moment.inputs if q not in states) if moving.moment else ()


def _moment(moving: Moving, tape: Tape) -> Callable[[Sequence[Number]], list[Number]] | None:
    """Return the moment along the axes as a function of the attitude, None if there is none."""
    program = moving.moment
    if program is None:
        return None
    outside = {c: tape.input(c) for q in _outside(moving) for c in q.components}
    parts = moving.known.words["attitude"].components

    def at(attitude: Sequence[Number]) -> list[Number]:
        return called(tape, program, outside | dict(zip(parts, attitude, strict=True)))

    return at


def traced(moving: Moving, taken: Mapping[str, str]) -> tuple[Traced, Mapping[str, str]]:
    """Return set-up's part of the motions, and how its constants are renamed.

    taken : names of the graph's constants, each with the parameter that it is, or ""
    """
    shared = {parameter: name for name, parameter in taken.items() if parameter}
    names: dict[str, str] = {}
    for operand, (name, _) in moving.tape.names.items():
        used = {*taken, *names.values()}
        several = (name, *(f"{name}{k}" for k in range(2, len(used) + 3)))
        names[operand] = shared.get(operand) or next(n for n in several if n not in used)
    new = {name: names[operand] for operand, (name, _) in moving.tape.names.items()}
    own = {operand: name for operand, name in names.items() if operand not in shared}
    return Traced(tuple(moving.tape.ops), dict(moving.given), own), new


def with_names(program: Program, names: Mapping[str, str]) -> Program:
    """Return a program whose constants are called by their new names."""
    results = tuple(names.get(r, r) if isinstance(r, str) else r for r in program.results)
    return replace(program, ops=renamed(program.ops, names), results=results)
