"""The programs that move a scene in time, and its formulas for attitudes, by their wanted names.

Formulas stand in the room ``motion``; here they are given the scene's body, state and
rates, and become programs. What rests on parameters only is on the tape of set-up.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from fractions import Fraction

from derive.lecture.chapters import LECTURE
from derive.library.on_constraints import on_constraints
from derive.library.setting import Setting
from derive.lower.setup import used_inputs
from derive.motion import runge_kutta
from derive.motion.attitude.functions import attitude_program
from derive.motion.compensated import remainder
from derive.motion.exact import flow_exact, principal_ratios, turn_and_rates
from derive.motion.moser_veselov import plan_dmv, plan_slopes, step_dmv
from derive.motion.runge_kutta.compact import compact
from derive.motion.runge_kutta.dependence import attitude_and_omega, closure
from derive.motion.runge_kutta.system import System, next_of
from derive.motion.splitting import Start, step_split
from derive.motion.taylor import taylor_step
from derive.motion.taylor.series import in_loops
from derive.program.program import Program, Quantity
from derive.program.recorded import called, needed
from derive.program.tape import Number, Tape, number, seen_from
from derive.scene import Scene, SceneError
from derive.scene.declaration import Given
from derive.scene.results import DISTANCES
from derive.scene.wanted import (
    ATTITUDES,
    SPLITTINGS,
    STEP_DERIVATIVES,
    TAYLOR,
    moves,
    step_of,
    with_column,
)

LOOPED = ("step_rk4", "step_rk4_jacobian", "step_rk4_tangent", "step_rk4_sensitivity")
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
BY_RATES = (*(f"step_{method}" for method in runge_kutta.METHODS), *TAYLOR)
"""Steps that are made from the rate of the state."""
SLOPES = {
    "jacobian": "state_rate_jacobian",
    "tangent": "state_rate_jacobian",
    "sensitivity": "state_rate_sensitivity",
}
"""What the derivatives of a step rest on, by kind."""
Signature = tuple[Sequence[Quantity], Sequence[Quantity]]  # what may go in, and what comes out


def needs(scene: Scene) -> tuple[str, ...]:
    """Return the equations that the wanted steps rest on, whether they are wanted themselves."""
    steps = [name for name in scene.wanted if step_of(name) in BY_RATES]
    slopes = [SLOPES[name.rpartition("_")[2]] for name in steps if name in STEP_DERIVATIVES]
    held = [DISTANCES] * bool(steps and scene.constraints)
    return tuple(dict.fromkeys(["state_rate"] * bool(steps) + slopes + held))


def motions(setting: Setting) -> tuple[Program, ...]:
    """Return the programs of all wanted motions and attitude formulas, in the scene's order."""
    found: dict[str, Program] = {}
    for name in setting.terms.scene.wanted:
        if name in ATTITUDES:
            found[name] = attitude_program(name)
        elif moves(name):
            found |= {program.name: program for program in _motion(setting, name)}
    return tuple(found.values())


def _motion(setting: Setting, name: str) -> tuple[Program, ...]:
    step = step_of(name)
    if name == "flow_exact":
        return (_flow_exact(setting),)
    if name == "step_dmv":
        return _dmv(setting)
    if step in TAYLOR:
        return (_taylor(setting, TAYLOR[step]),)
    if step in SPLITTINGS:
        return (_split(setting, name),)
    return (_runge_kutta(setting, name),)


def _taylor(setting: Setting, order: int) -> Program:
    vocabulary, rate = setting.terms.vocabulary, setting.rates["state_rate"]
    step = _time_step(setting)
    series = taylor_step(rate, vocabulary.states, vocabulary.inputs, order, step)
    return on_constraints(setting, replace(in_loops(series), assumptions=rate.assumptions))


def _runge_kutta(setting: Setting, name: str) -> Program:
    rates, step = setting.rates, _time_step(setting)
    slopes = rates[SLOPES[name.rpartition("_")[2]]] if name in STEP_DERIVATIVES else None
    states, taken = setting.terms.vocabulary.states, setting.terms.taken()
    column = setting.terms.scene.column is not None and with_column(name)
    system = System(states, rates["state_rate"], slopes, step, taken, column)
    _check_quaternions(setting, name, len(system.quaternions))
    _check_free_turn(system, name)
    if _looped(setting, name) and setting.terms.scene.constraints:
        rule = "is for machines without constraints, which a step is brought back onto"
        raise SceneError(f"emission = 'compact' {rule}")
    program = on_constraints(setting, runge_kutta.step(system, name))
    if program.sparsity and not any(pattern.row for pattern in program.sparsity.values()):
        rule = "must have entries, but nothing that it is a derivative by changes the step"
        raise SceneError(f"wanted '{name}' {rule}")
    program = replace(
        program,
        inputs=used_inputs(program.inputs, program.ops, program.results),
        assumptions=rates["state_rate"].assumptions,
    )
    return compact(system, program) if _looped(setting, name) else program


def _looped(setting: Setting, name: str) -> bool:
    return setting.terms.scene.emission == "compact" and name in LOOPED


def _check_quaternions(setting: Setting, name: str, count: int) -> None:
    """Refuse a machine's step that knows of another number of quaternions than the state has."""
    if name.endswith("_tangent") and count != 1:
        rule = f"is over the errors of one quaternion, and the state has {count}"
        raise SceneError(f"'{name}' {rule}")
    if _looped(setting, name) and count > 1:
        rule = f"emission = 'compact' is for one quaternion at most, and the state has {count}"
        raise SceneError(f"'{name}': {rule}")


def _check_free_turn(system: System, name: str) -> None:
    """Refuse a step that keeps the length of q where what turns q rests on it, or nothing does."""
    if step_of(name) != "step_rk4_unit":
        return
    count, places = len(system.quaternions), attitude_and_omega(system)
    if count != 1:
        rule = f"keeps the length of one quaternion, and the state has {count or 'none'}"
        raise SceneError(f"'{name}' {rule}")
    if places is None:
        rule = "needs an angular velocity among the states that turns the quaternion, and has none"
        raise SceneError(f"'{name}' {rule}: want step_rk4")
    attitude, omega = (system.names[place] for place in places)
    found = [part for part in attitude if part in closure(system, set(omega))]
    if found:
        rule = f"is for rates of '{omega[0]}' that do not rest on '{found[0]}'"
        raise SceneError(f"'{name}' {rule}, as they do here: want step_rk4")


def _time_step(setting: Setting) -> Quantity:
    return _seconds("time_step", setting.terms.scene.time_step, "length of the step")


def _seconds(name: str, range_: Given, says: str) -> Quantity:
    return Quantity(name, (name,), (), "s", "", range_.low, range_.high, says)


def _program(
    name: str, says: str, tape: Tape, ends: Signature, values: Iterable[Number | Fraction | int]
) -> Program:
    """Return what a tape holds of ``values``; of the inputs, those that they rest on."""
    results = tuple(seen_from(tape, number(value)) for value in values)
    ops = needed(tape.ops, results)
    inputs, outputs = used_inputs(ends[0], ops, results), tuple(ends[1])
    return Program(name, says, inputs, outputs, ops, results, assumptions=FREE_ROTATION)


def _inputs(tape: Tape, q: Quantity) -> list[Number]:
    return [tape.input(c) for c in q.components]


def _rotation(setting: Setting) -> tuple[Quantity, Quantity]:
    return setting.terms.rotation.attitude, setting.terms.rotation.omega


def _flow_exact(setting: Setting) -> Program:
    tape, (attitude, omega) = setting.function(), _rotation(setting)
    given = setting.terms.scene.time
    time = _seconds("time", given, "time from the given to the new state")
    (t,) = _inputs(tape, time)
    body, rates = setting.inertia(), _inputs(tape, omega)
    q, w = flow_exact(body, _inputs(tape, attitude), rates, t)
    ends = (attitude, omega, time), (next_of(attitude), next_of(omega))
    says = "Attitude and angular velocity after any time without torque (exact solution)."
    moments, axes = principal_ratios(body)
    free = (*moments, *(x for axis in axes for x in axis), *turn_and_rates(body, rates, t)[0])
    program = _program("flow_exact", says, tape, ends, (*q, *w))
    return replace(program, free=tuple(seen_from(tape, n) for n in free))


def _dmv(setting: Setting) -> tuple[Program, ...]:
    (_, omega), step = _rotation(setting), _time_step(setting)
    tape = setting.function()
    (h,) = _inputs(tape, step)
    entries = plan_dmv(tape, setting.inertia(), _inputs(tape, omega), h)
    names = tuple(f"plan_{name}" for name, _, _ in entries)
    plan = Quantity(
        "plan", names, (len(names),), "", "", None, None,
        "what a motion without torque and a length of step keep, each in its own unit", "plan",
    )  # fmt: skip
    says = "Plan many steps of one length from an angular velocity; call it once."
    ends = (omega, step), (plan,)
    planned = _program("plan_dmv", says, tape, ends, [n for _, n, _ in entries])
    values = plan_slopes(tape, setting.inertia(), _inputs(tape, omega), h)
    planned = replace(planned, slopes=_program("plan_dmv", says, tape, ends, values))
    return planned, _dmv_step(setting, plan, [name for name, _, _ in entries])


def _dmv_step(setting: Setting, plan: Quantity, names: Sequence[str]) -> Program:
    tape, (attitude, omega) = setting.function(), _rotation(setting)
    rest = remainder((attitude, omega))
    planned = dict(zip(names, _inputs(tape, plan), strict=True))
    state = (_inputs(tape, q) for q in (attitude, omega, rest))
    after = step_dmv(tape, setting.inertia(), planned, *state)
    moved = (attitude, omega, rest)
    says = "One step of a torque-free rotation, as plan_dmv laid it out (order 10)."
    return _program("step_dmv", says, tape, ((plan, *moved), [*map(next_of, moved)]), after)


def _split(setting: Setting, name: str) -> Program:
    tape, step = setting.function(), _time_step(setting)
    attitude, omega = _rotation(setting)
    order, carries = SPLITTINGS[step_of(name)], name.endswith(COMPENSATION)
    rest = (remainder((attitude, omega)),) if carries else ()
    (h,) = _inputs(tape, step)
    state, left = (_inputs(tape, attitude), _inputs(tape, omega)), [_inputs(tape, q) for q in rest]
    start = Start(*state, _moment(setting, tape), h, *left)
    after = step_split(tape, setting.inertia(), order, start)
    inputs = (attitude, omega, *_outside(setting), step, *rest)
    says = f"One step of the rotation by splitting it into turns about two axes (order {order})"
    says += ", carrying what rounding leaves." if carries else "."
    outputs = tuple(map(next_of, (attitude, omega, *rest)))
    return _program(name, says, tape, (inputs, outputs), after)


def _outside(setting: Setting) -> tuple[Quantity, ...]:
    """Return the inputs that the moment may use, held while the step lasts."""
    states = setting.terms.vocabulary.states
    return tuple(q for q in setting.moment.inputs if q not in states) if setting.moment else ()


def _moment(setting: Setting, tape: Tape) -> Callable[[Sequence[Number]], list[Number]] | None:
    """Return the moment along the axes as a function of the attitude, None if there is none."""
    program = setting.moment
    if program is None:
        return None
    outside = {c: tape.input(c) for q in _outside(setting) for c in q.components}
    parts = setting.terms.rotation.attitude.components

    def at(attitude: Sequence[Number]) -> list[Number]:
        return called(tape, program, outside | dict(zip(parts, attitude, strict=True)))

    return at
