"""What a load does that holds points of two bodies together, along axes that may turn.

It has no power where the points stay at one place on these axes. If they are apart on others, the
axes' own turning moves one beside the other, so the body that the axes turn with has a moment too.
"""

from derive.mechanics.frames import Frames, Located
from derive.mechanics.sheet import AXES
from derive.scene import SceneError
from derive.scene.constraint import Constraint, Meeting
from derive.scene.constraints import body_turning_with
from derive.scene.machine import INERTIAL, Force

ActedOn = dict[str, list[tuple[Located, int]]]
"""Where a force acts on each body, and with which sign."""


def ends(frames: Frames, load: Force) -> ActedOn:
    """Return where a force acts, that may hold points together, on which bodies."""
    words = frames.words
    here = (load.frame, words.column(load.at))
    there = (load.other[0], words.column(load.other[1])) if load.other else here
    one = _held_by(frames, load)
    if one is None or one.meeting is None:
        return _pair(load, here, there)
    to = (one.meeting.to_frame, words.column(one.meeting.to))
    if not _apart(frames, one.meeting):
        return _pair(load, here, to)
    if one.load != one.name:  # a load of the scene acts where the scene says
        return _pair(load, here, there)
    body = body_turning_with(frames.machine, load.along)
    if body == load.on:
        return _pair(load, there, there)
    if body == load.against:
        return _pair(load, here, here)
    if body == INERTIAL:
        return _pair(load, here, there)
    if body:
        return _pair(load, here, there) | {body: [(here, -1), (there, 1)]}
    rule = "turns with no body, which what holds the points would have a moment on"
    raise SceneError(f"constraint '{one.name}': '{load.along}' {rule}; "
                     "name another by along, or say it by zero = 'formula'")  # fmt: skip


def _pair(load: Force, here: Located, there: Located) -> ActedOn:
    return {load.on: [(here, 1)]} | ({load.against: [(there, -1)]} if load.against else {})


def _held_by(frames: Frames, load: Force) -> Constraint | None:
    """Return the constraint whose points a load holds at one place, from the one to the other."""
    for one in frames.machine.constraints:
        m = one.meeting
        if m is None or one.load != load.name or one.of_rates:
            continue
        if (load.on, load.against, load.frame, load.at) == (m.on, m.against, m.frame, m.at):
            return one
    return None


def _apart(frames: Frames, meeting: Meeting) -> bool:
    """Tell whether points that meet may be apart along axes that nothing is said of."""
    here = (meeting.frame, frames.words.column(meeting.at))
    there = (meeting.to_frame, frames.words.column(meeting.to))
    d = frames.apart(there, here, meeting.along)
    return any(x != 0 for axis, x in zip(AXES, d, strict=True) if axis not in meeting.axes)
