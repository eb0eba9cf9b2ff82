"""The right sides of lecture steps, in the components that a scene's own quantities have."""

from collections.abc import Mapping
from typing import Any

from derive.lecture.chapters import LECTURE
from derive.lecture.vectors import Expression, components


def by_law(step: str, bindings: Mapping[str, Any]) -> Any:
    """Return the right side of a lecture step in the components that ``bindings`` give."""
    return components(law(step), bindings)


def law(step: str) -> Expression:
    """Return the right side of a lecture step that makes one claim."""
    right = LECTURE[step].right
    if isinstance(right, tuple):
        raise TypeError(f"lecture step '{step}' makes {len(right)} claims, not one")
    return right
