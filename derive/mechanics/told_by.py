"""Which bodies are cut free together, and by which steps of the lecture a balance is written."""

from derive.mechanics.balance import Balance
from derive.mechanics.bodies import carries, form_about
from derive.mechanics.frames import ZERO
from derive.mechanics.valued import Sides
from derive.scene import Scene
from derive.scene.machine import Force, Spring

FEW = 2  # bodies that are cut free together though no load joins them


def hang_together(machine: Scene, bodies: tuple[str, ...]) -> bool:
    """Tell whether bodies hang together by loads between them, or are few or all."""
    if len(bodies) <= FEW or len(bodies) == len(machine.bodies):
        return True
    pairs = [load for load in machine.loads if isinstance(load, Force | Spring)]
    reached = {bodies[0]}
    for _ in bodies:
        for load in pairs:
            ends = {load.on, load.against}
            if ends & reached and ends <= set(bodies):
                reached |= ends
    return reached == set(bodies)


def steps_of(sides: Sides, balance: Balance) -> tuple[str, ...]:
    """Return the lecture steps by which a balance is written."""
    point, frames = balance.point, sides.frames
    if balance.kind == "constraint":
        return ()
    if balance.kind == "virtual power":
        return ("mass_centre_motion", "general_form", "velocity_of_particle")
    if point is None:
        return ("mass_centre_motion",)
    found = dict[str, None]()
    for body in balance.bodies:
        own = sides.efforts[body]
        if carries(frames, body, point):
            found[form_about(frames, body, point[1])] = None
            continue
        central = balance.central or all(part == ZERO for part in own.force.values())
        if central or own.moment != ZERO:
            found["general_form"] = None
        if not central:
            found["any_point_form"] = None
    return tuple(found)
