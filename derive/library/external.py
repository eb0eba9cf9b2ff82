"""The second derivatives that a scene's step needs where CasADi calls it as compiled C."""

from __future__ import annotations

from dataclasses import replace

from derive.library.library import Library
from derive.motion.runge_kutta.second import second_derivatives
from derive.motion.runge_kutta.system import System
from derive.program.program import Program
from derive.scene import SceneError

CASADI = "casadi-external"
"""What the files are called that a scene becomes beside the usual ones."""
STEP, WITH_JACOBIAN = "step_rk4_unit", "step_rk4_unit_jacobian"


def second_of_step(made: Library) -> Program:
    """Return the second derivatives of ``adjoint`` times what step_rk4_unit returns.

    Its constants are those of the scene's own files.
    Raises SceneError for a scene that does not want the step with its Jacobian, in plain floats,
    or whose rates rest on the attitude.
    """
    scene = made.scene
    for name in (STEP, WITH_JACOBIAN):
        if name not in scene.wanted:
            rule = f"C for CasADi needs '{name}' in wanted"
            raise SceneError(f"scene '{scene.name}': {rule}, and it is not there")
    if scene.form != "fast":
        rule = "C for CasADi needs form = 'fast'"
        raise SceneError(f"scene '{scene.name}': {rule}, not '{scene.form}'")
    states, step = made.vocabulary.states, made[STEP]
    (h,) = (q for q in step.inputs if q.name == "time_step")
    taken = frozenset(c for p in made.printed() for q in p.inputs for c in q.components)
    system = System(states, made["state_rate"], made["state_rate_jacobian"], h, taken)
    try:
        found = second_derivatives(system)
    except ValueError as error:
        raise SceneError(f"scene '{scene.name}': C for CasADi {error}") from None
    constants = tuple(q for q in step.inputs if q.role == "constants")
    own = tuple(q for q in found.inputs if q.role != "constants")
    return replace(found, inputs=(*constants, *own))
