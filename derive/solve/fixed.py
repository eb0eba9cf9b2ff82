"""A scene with another set-up: a table of constants in its place, or one that tries ranges."""

from functools import partial

from derive.library.fixed import with_fixed
from derive.library.ranges import with_ranges_tried
from derive.solve.handle import Handle, handle
from derive.solve.settings import NamedValues, settings


def fix(scene: Handle, values: NamedValues) -> Handle:
    """Return a scene of which every parameter that set-up is told has a value.

    Raises DeriveError for one that is missing, strange, or refused by set-up.
    """
    given = settings(scene.name, scene.library.vocabulary.parameters, values)
    with_fixed(scene.library, given)
    made = (*scene.changes, partial(with_fixed, values=given))
    return handle(scene.scene.text, scene.name, scene.source, made)


def try_ranges(scene: Handle) -> Handle:
    """Return a scene whose set-up refuses parameters outside of their declared ranges.

    Raises DeriveError for one without a set-up.
    """
    with_ranges_tried(scene.library)
    made = (*scene.changes, with_ranges_tried)
    return handle(scene.scene.text, scene.name, scene.source, made)
