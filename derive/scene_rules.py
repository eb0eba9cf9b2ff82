"""Rules between the tables of a scene: what would be read singly, yet contradicts the rest."""

from __future__ import annotations

from derive.declaration import Scene


def check(scene: Scene) -> None:
    """Raise SceneError for the first rule that the scene breaks."""


def warnings(scene: Scene) -> tuple[str, ...]:
    """Return sentences on what is allowed and yet unlikely to be meant."""
    return ()
