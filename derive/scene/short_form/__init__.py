"""A TOML document with ``[body]`` in, a ``Scene`` out: a single body as lectures write it.

Nothing else in the package knows that a scene may be written so.
"""

from dataclasses import replace
from typing import Any

from derive.scene.machine import Scene
from derive.scene.safe import require_values
from derive.scene.short_form.long_form import in_long_form
from derive.scene.short_form.rules import check_rules, warnings
from derive.scene.short_form.tables import read_scene
from derive.scene.table import table
from derive.scene.wanted import check_form


def read_short(document: dict[str, Any], name: str, text: str) -> Scene:
    """Return the scene of a parsed TOML document; names of scalars stay what they are.

    Raises SceneError for the first rule that it breaks.
    """
    scene = read_scene(document, name, text)
    said = tuple(table(document.get("known", {}), "known").entries)
    check_rules(scene, said)
    check_form(scene.wanted, scene.head["form"], scene.head["emission"])
    require_values(scene)
    return in_long_form(replace(scene, warnings=warnings(scene, said)))
