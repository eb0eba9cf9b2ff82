"""A scene with fixed parameters: its C has a table of constants and no set-up."""

from derive.library.fixed import with_fixed
from derive.solve.handle import Handle, handle
from derive.solve.settings import NamedValues, settings


def fix(scene: Handle, values: NamedValues) -> Handle:
    """Return a scene of which every parameter that set-up is told has a value.

    Raises DeriveError for one that is missing, strange, or refused by set-up.
    """
    given = settings(scene.name, scene.library.vocabulary.parameters, values)
    with_fixed(scene.library, given)
    return handle(scene.scene.text, scene.name, scene.source, (*given.items(),))
