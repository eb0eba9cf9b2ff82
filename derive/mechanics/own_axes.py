"""The axes of turned bodies: each a frame of its own, whose name no scene can give."""

from derive.scene import Scene
from derive.scene.machine import Frame


def own_axes(body: str) -> str:
    """Return what the axes of a turned body are called; no user's frame can have this name."""
    return f"{body}.axes"


def frame_called(frame: str) -> str:
    """Return what a frame is called in sentences.

    >>> frame_called(own_axes("disc")), frame_called("stem")
    ('the axes of disc', 'stem')
    """
    body = frame.removesuffix(".axes")
    return frame if body == frame else f"the axes of {body}"


def frames_of_bodies(machine: Scene) -> tuple[Frame, ...]:
    """Return a frame for each turned body, at its mass centre."""
    return tuple(
        Frame(own_axes(b.name), b.frame, b.turned, None, "", b.centre)
        for b in machine.bodies
        if b.turned
    )
