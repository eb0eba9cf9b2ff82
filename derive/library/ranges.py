"""Set-up that tries its parameters against their declared ranges."""

from dataclasses import replace

from derive.library.library import Library
from derive.program.program import Precondition
from derive.program.status import RANGE
from derive.scene import SceneError


def with_ranges_tried(library: Library) -> Library:
    """Return a library whose set-up refuses parameters outside of their ranges, after all else.

    Raises SceneError for a scene without a set-up.
    """
    if not library.constants:
        name = library.scene.name
        raise SceneError(f"scene '{name}': there is no set-up that could check ranges")
    every = [(c, q.ends) for q in library.setup.inputs for c in q.components]
    rules = tuple(
        Precondition(RANGE, f"{c} must be within {float(a):g} .. {float(b):g}", c, "within", (a, b))
        for c, (a, b) in every
    )
    return replace(library, setup=replace(library.setup, rules=(*library.setup.rules, *rules)))


def tries_ranges(library: Library) -> bool:
    """Tell whether set-up tries its parameters against their ranges."""
    return any(rule.status == RANGE for rule in library.setup.rules)
