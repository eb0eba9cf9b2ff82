"""Steps of a machine with constraints: what they are brought back onto, and what moves for that."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any, Protocol

from derive.library.setting import Setting
from derive.motion.constrained import PASSES, Homing, held_step
from derive.program.program import Program
from derive.scene import Input, Scene, SceneError
from derive.scene.formula import Formula, symbols
from derive.scene.results import DISTANCES


class OfMachine(Protocol):
    """What a scene's functions rest on, and what holds its machine."""

    @property
    def scene(self) -> Scene:
        """Return the scene as it was read."""

    @property
    def vocabulary(self) -> Any:
        """Return what its quantities are called."""

    @property
    def mechanism(self) -> Any:
        """Return its machine."""


def on_constraints(setting: Setting, step: Program) -> Program:
    """Return a step that ends on the constraints of its machine, if it has any."""
    scene, kind = setting.terms.scene, step.name.rpartition("_")[2]
    if not scene.constraints:
        return step
    if kind in ("tangent", "sensitivity"):
        rule = "is of machines without constraints, which a step is brought back onto"
        raise SceneError(f"'{step.name}' {rule}; step_rk4_jacobian is of these, too")
    states = [c for q in setting.terms.vocabulary.states for c in q.components]
    held = homing_of(setting.terms, setting.rates[DISTANCES], setting.tape.held)
    return held_step(step, states, held)


def homing_of(of: OfMachine, distances: Program, constants: Iterable[str]) -> Homing:
    """Return what vanishes where the constraints hold, without what is redundant, and what moves.

    constants : the names of all that set-up makes

    Places that formulas of time alone move are where they are meant to be.
    """
    scene, states, found = of.scene, of.vocabulary.states, of.mechanism.held
    places, rates, count = list[int](), list[int](), 0
    for tie in found.every:
        kept = tie in found.kept
        if tie.place is not None:
            places += [count] * kept
            count += 1
        rates += [count] * kept
        count += 1
    size = {c: (q.ends[1] - q.ends[0]) ** 2 for q in states for c in q.components}

    def weights(names: Sequence[str]) -> dict[str, Fraction]:
        most = max((size[c] for c in names), default=Fraction(1))
        return {c: size[c] / most for c in names}

    speeds = {s.name for s in scene.speeds if s.free}
    moving = [c.name for c in scene.coordinates if c.free or (
              isinstance(c.rate, Formula) and speeds & {*symbols(c.rate)})]  # fmt: skip
    driving = [c.rate.name for c in scene.coordinates if c.free and isinstance(c.rate, Input)]
    driving += [s.name for s in scene.speeds if s.free]
    attitudes = tuple(q.components for q in states if q.is_quaternion)
    return Homing(distances, tuple(places), tuple(rates), weights(moving), weights(driving),
                  PASSES if found.curved else 1, attitudes, frozenset(constants))  # fmt: skip
