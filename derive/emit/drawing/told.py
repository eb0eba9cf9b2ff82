"""What a drawing shows, in words: for readers who do not see it."""

from collections.abc import Iterator

from derive.scene import Scene
from derive.scene.machine import INERTIAL, Member
from derive.scene.said import is_hidden
from derive.scene.wanted import attitudes_only


def drawing_told(scene: Scene) -> str:
    """Return the alternative text of a drawing."""
    return f"Drawing of {scene.name}: {'; '.join(_shown(scene))}."


def _shown(scene: Scene) -> Iterator[str]:
    bodies = () if attitudes_only(list(scene.wanted)) else scene.bodies
    yield from map(_body, bodies)
    frames = [f.name for f in scene.frames if f.name != INERTIAL]
    yield f"axes of {', '.join(frames) or 'N'}"
    loads = [load.name for load in scene.loads if not is_hidden(load.name)]
    if loads and bodies:
        yield f"loads {', '.join(loads)}"


def _body(body: Member) -> str:
    if not body.parts:
        return f"{body.name}, drawn by its inertia"
    return f"{body.name}, {f'a {body.look}' if body.look else 'with its shape'}".replace("_", " ")
