"""Every number and formula of a scene file changed in turn: what does nobody listen to?

An entry is heard if some change of it changes the emitted C, or is refused or warned about. What
is not heard must not matter: the range of what is no argument, or, in a machine, an entry without
which a cloud of particles has the same answers.
"""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from decimal import Decimal
from typing import Any

from mpmath import mp, mpf

from derive.c_text import PRECISIONS
from derive.check.particles import _of_cloud as of_cloud
from derive.cloud import answers
from derive.cloud.series import DIGITS
from derive.cloud.small import slopes
from derive.emit import c_files
from derive.library import Library, library
from derive.machine.words import MATRICES
from derive.sample import samples
from derive.scene import Machine, Scene, SceneError, parse_scene

Path = tuple[str | int, ...]
WORDS = ("title", "source", "meaning", "unit", "name")
"""Entries for people, and names, which are text and no formula."""
CALLED = {"angular_velocity": "omega", "angular_acceleration": "omega_dot"}
"""Entries of known vectors whose argument has another name."""
AGREE = mpf(10) ** -20  # the cloud has 25 digits, and a difference of slopes keeps twenty
AXES = {"x": "y", "y": "z", "z": "x"}


def ignored(text: str, name: str = "example") -> list[str]:
    """Return the paths of entries that matter and can be changed without anything changing."""
    document = tomllib.loads(text, parse_float=Decimal)
    made, before = library(parse_scene(text, name)), _said(written(document), name)
    taken = {q.name for f in (made.setup, *made.printed()) for q in f.inputs}
    found = []
    for path, value in _leaves(document, ()):
        others = [written(_with(document, path, other)) for other in _others(value)]
        heard = any(_said(other, name) != before for other in others)
        named = {CALLED.get(str(key), key) for key in path}
        if not heard and not ("range" in path and not named & taken):
            found += [".".join(map(str, path))] * any(_matters(made, o, name) for o in others)
    return found


def _said(text: str, name: str) -> tuple[str, ...]:
    """Return all that is said of a scene: its code and warnings, or why it is refused."""
    try:
        scene: Scene | Machine = replace(parse_scene(text, name), text="")
        return (*c_files(library(scene), ()).values(), *scene.warnings)
    except SceneError as error:
        return (str(error),)


def _matters(made: Library, text: str, name: str) -> bool:
    """Tell whether the particles of a machine see a change; of one body, every change matters."""
    other, scene = parse_scene(text, name), made.known.scene
    if not isinstance(other, Machine) or not isinstance(scene, Machine):
        return True
    (sample,) = samples(made.known, PRECISIONS[1], 1, 0).each[:1]
    first, second = (_by_particles(made, one, sample.values) for one in (scene, other))
    with mp.workdps(DIGITS):
        pairs = list(zip(first, second, strict=True))
        size = max((abs(x) for pair in pairs for x in pair), default=mpf(0))
        return not pairs or any(abs(a - b) > AGREE * size for a, b in pairs)


def _by_particles(made: Library, scene: Machine, values: Mapping[str, float]) -> list[Any]:
    """Return the answers of a machine that its cloud of particles has."""
    cloud, found = answers(scene, values), []
    for base, fact in made.truths.items():
        if base == "linearised" or fact.outputs[0].name in MATRICES:
            found += [x for table in slopes(scene, values) for x in table]
            continue
        names = [c for q in fact.outputs for c in q.components]
        found += [of_cloud(scene, cloud, base, n) for n in names]
    return [x for x in found if x is not None]


def _leaves(value: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in WORDS and key != "wanted":
                yield from _leaves(inner, (*path, key))
    elif isinstance(value, list):
        for place, inner in enumerate(value):
            yield from _leaves(inner, (*path, place))
    else:
        yield path, value


def _others(value: Any) -> Iterator[Any]:
    """Yield values that mean something else: nearby numbers, other formulas, other axes."""
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, int | Decimal):
        yield from (value * Decimal("0.9375"), value * Decimal("1.0625"), value + Decimal("0.125"))
    elif value[:1] in AXES and value[1:2] in ("", " "):
        yield AXES[value[0]] + value[1:]
    elif value.strip("-+0. ") == "":
        yield "0.125"
    elif value.startswith(("?", "-?")):
        yield value.replace("?", "7/8*?", 1)
    else:
        yield f"7/8*({value})"


def _with(document: Any, path: Path, value: Any) -> Any:
    if not path:
        return value
    first, *rest = path
    if isinstance(document, dict):
        return {k: _with(v, tuple(rest), value) if k == first else v for k, v in document.items()}
    return [_with(v, tuple(rest), value) if k == first else v for k, v in enumerate(document)]


def written(document: dict[str, Any]) -> str:
    """Return a document as TOML, a line an entry."""
    return "".join(f"{key} = {_inline(value)}\n" for key, value in document.items())


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_inline(v)}" for key, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return str(value)
