"""The derivatives that a scene's step needs where CasADi calls it as compiled C."""

from __future__ import annotations

from dataclasses import dataclass, replace

from derive.library.library import Library
from derive.motion.along import first_along, second_along, with_set_up
from derive.motion.runge_kutta.second import second_derivatives
from derive.motion.runge_kutta.system import System
from derive.program.program import Program, Quantity
from derive.scene import Scene, SceneError

CASADI = "casadi-external"
"""What the files are called that a scene becomes beside the usual ones."""
STEPS = ("step_rk4_unit", "step_rk4")
"""Steps that CasADi may call: the first of them that is wanted."""
BY_LENGTH, BY_STATE, BY_PARAMETERS = "by_length", "by_state", "by_parameters"


@dataclass(frozen=True)
class StepDerivatives:
    """A step with its Jacobian, and what gives its further derivatives.

    lower         : the second derivatives by states and inputs, at once, where the structure of
                    the step allows that; else None
    first, second : derivatives along changes of what their names say, by name: of the states
                    after, and of the derivatives by states, inputs, length (and parameters)
    """

    step: Program
    jacobian: Program
    lower: Program | None
    first: dict[str, Program]
    second: dict[str, Program]

    def programs(self) -> tuple[Program, ...]:
        """Return what is printed beside the step and its Jacobian."""
        lower = () if self.lower is None else (self.lower,)
        return (*lower, *self.first.values(), *self.second.values())


def derivatives_of_step(made: Library) -> StepDerivatives:
    """Return the first and second derivatives of what a scene's step returns.

    Constants are those of the scene's own files.
    Raises SceneError for a scene that does not want a step with its Jacobian, in plain floats and
    unrolled, or whose rates hold an operator without derivatives.
    """
    scene = made.scene
    name = step_name(scene)
    if f"{name}_jacobian" not in scene.wanted:
        rule = f"C for CasADi needs '{name}_jacobian' in wanted, and it is not there"
        raise SceneError(f"scene '{scene.name}': {rule}")
    for entry, says in (("form", scene.form), ("emission", scene.emission)):
        if says != "fast":
            rule = f"C for CasADi needs {entry} = 'fast', not '{says}'"
            raise SceneError(f"scene '{scene.name}': {rule}")
    try:
        return _derivatives(made, name)
    except ValueError as error:
        raise SceneError(f"scene '{scene.name}': C for CasADi: {error}") from None


def step_name(scene: Scene) -> str:
    """Return the step that CasADi calls. Raises SceneError for a scene that wants none of them."""
    for name in STEPS:
        if name in scene.wanted:
            return name
    rule = "C for CasADi needs 'step_rk4_unit' or 'step_rk4' in wanted, and neither is there"
    raise SceneError(f"scene '{scene.name}': {rule}")


def _derivatives(made: Library, name: str) -> StepDerivatives:
    step, jacobian = made[name], made[f"{name}_jacobian"]
    lower = _lower(made) if name == STEPS[0] else None
    of = [c for q in (*made.vocabulary.states, *step_inputs(made)) for c in q.components]
    of.append("time_step")
    first = {BY_LENGTH: first_along(step, ["time_step"], f"{name}_{BY_LENGTH}")}
    if lower is None:
        second = {BY_STATE: second_along(step, of, of, f"{name}_twice_{BY_STATE}")}
    else:
        second = {BY_LENGTH: second_along(step, ["time_step"], of, f"{name}_twice_{BY_LENGTH}")}
    if made.constants:
        whole = with_set_up(step, made.setup)
        by = [c for q in made.setup.inputs for c in q.components]
        first[BY_PARAMETERS] = first_along(whole, by, f"{name}_{BY_PARAMETERS}")
        twice = f"{name}_twice_{BY_PARAMETERS}"
        second[BY_PARAMETERS] = second_along(whole, by, [*of, *by], twice)
    return StepDerivatives(step, jacobian, lower, first, second)


def _lower(made: Library) -> Program | None:
    """Return the second derivatives of step_rk4_unit where they have its structure, else None."""
    states, step = made.vocabulary.states, made[STEPS[0]]
    (h,) = (q for q in step.inputs if q.name == "time_step")
    taken = frozenset(c for p in made.printed() for q in p.inputs for c in q.components)
    system = System(states, made["state_rate"], made["state_rate_jacobian"], h, taken)
    try:
        found = second_derivatives(system)
    except ValueError:
        return None
    constants = tuple(q for q in step.inputs if q.role == "constants")
    own = tuple(q for q in found.inputs if q.role != "constants")
    return replace(found, inputs=(*constants, *own))


def step_inputs(made: Library) -> tuple[Quantity, ...]:
    """Return what the rates are given beside state and constants, held while a step lasts."""
    own = {q.name for q in made.vocabulary.states}
    given = made["state_rate"].inputs
    return tuple(q for q in given if q.role != "constants" and q.name not in own)
