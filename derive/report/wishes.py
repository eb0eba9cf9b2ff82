"""What else a scene could want: its steps in time, and its functions in the other form.

The rules of the scene room decide: a name is put into ``wanted``, and the scene is read again.
"""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from derive.library.library import Library, library
from derive.scene import Scene, SceneError, read
from derive.scene.wanted import ATTITUDES, COMPENSATED, STEP_FUNCTIONS, moves

STEPS = tuple(n for n in (*STEP_FUNCTIONS, *COMPENSATED) if n != "step_rk4_unit")
"""All that moves a state, derivatives aside; on the sphere, step_rk4_unit is step_rk4."""
ORDERS = ("step_taylor", "step_taylor12")
"""Of the orders that Taylor steps come in: the highest and the lowest, and those wanted."""
OTHER_FORM = {"fast": "accurate", "accurate": "fast"}


@dataclass(frozen=True)
class Wished:
    """A scene with all the steps that it could want.

    steps   : their names, those that it wants first        own : those that it wants itself
    refused : sentences why others cannot be wanted, by name
    """

    library: Library
    steps: tuple[str, ...]
    own: tuple[str, ...]
    refused: dict[str, str]


def wished(given: Library) -> Wished:
    """Return a scene's programs with those of every step that its rules admit."""
    scene, refused = given.scene, dict[str, str]()
    own = tuple(name for name in scene.wanted if name in STEPS)
    more = [n for n in STEPS if n not in own and (n in ORDERS or not n.startswith("step_taylor"))]
    admitted = [name for name in more if _admits(scene, name, refused)]
    if not admitted:
        return Wished(given, own, own, refused)
    try:
        return Wished(library(_wanting(scene, admitted)), (*own, *admitted), own, refused)
    except SceneError as error:
        return _one_by_one(given, Wished(given, own, own, refused), admitted, str(error))


def _one_by_one(given: Library, found: Wished, names: Sequence[str], why: str) -> Wished:
    """Return a scene with those of some steps of which there are programs."""
    made: list[str] = []
    for name in names:
        try:
            library(_wanting(given.scene, [name]))
            made.append(name)
        except SceneError as error:
            found.refused[name] = _without_name(str(error))
            if not found.own and name == names[0] and found.refused[name] == _without_name(why):
                found.refused.update(dict.fromkeys(names, found.refused[name]))
                return found  # what holds for the first holds for all: nothing is free
    if not made:
        return found
    whole = library(_wanting(given.scene, made))
    return Wished(whole, (*found.own, *made), found.own, found.refused)


def _admits(scene: Scene, name: str, refused: dict[str, str]) -> bool:
    try:
        _wanting(scene, [name])
    except SceneError as error:
        refused[name] = str(error)
        return False
    return True


def in_other_form(scene: Scene) -> Library | None:
    """Return the functions of a scene in its other form, None if there are none."""
    document = _document(scene)
    own = [entry for entry in document["wanted"]
           if not moves(entry) and entry not in ATTITUDES]  # fmt: skip
    if not own:
        return None
    try:
        entries = {"form": OTHER_FORM[scene.form], "wanted": own}
        return library(read({**document, **entries}, scene.name, scene.text))
    except SceneError:
        return None


def _wanting(scene: Scene, names: Sequence[str]) -> Scene:
    document = _document(scene)
    wanted = [*dict.fromkeys([*document["wanted"], *names])]  # a group as it is declared
    return read({**document, "wanted": wanted}, scene.name, scene.text)


def _document(scene: Scene) -> dict[str, Any]:
    return tomllib.loads(scene.text, parse_float=Decimal)


def _without_name(sentence: str) -> str:
    """Return what is said of a scene without its name, which stands on the page already."""
    return sentence.partition("': ")[2] if sentence.startswith("scene '") else sentence
