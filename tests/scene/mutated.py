"""Every number and formula of a scene file changed in turn: what does nobody listen to?

An entry is heard if some change of it changes the emitted C, or is refused or warned about. What
is not heard must not matter: the range of what is no argument; in a machine, an entry without which
a cloud of particles has the same answers; of one body, an entry without which the lecture's
equations have the same answers, and which is heard as soon as vectors known to be 0 are arguments:
a body on which no moment acts may not need all of its inertia.
"""

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from decimal import Decimal
from typing import Any

from mpmath import mp, mpf

from derive.check.particles import of_cloud
from derive.emit.c.source import c_files
from derive.library.library import Library, library
from derive.program.precision import PRECISIONS
from derive.scene import Scene, SceneError, parse_scene
from derive.scene.results import MATRICES
from derive.verify.cloud import answers
from derive.verify.cloud.series import DIGITS
from derive.verify.cloud.small import slopes_about_rest
from derive.verify.sample import samples

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
            matters = any(_matters(made, o, name) for o in others)
            found += [".".join(map(str, path))] * matters
    return found


def unread(text: str, name: str = "example") -> list[str]:
    """Return the paths of entries of which no change changes what is read, or is refused.

    It asks less than ``ignored``, and of a scene of any size within seconds.
    """
    document = tomllib.loads(text, parse_float=Decimal)
    before, found = _read(written(document), name), []
    for path, value in _leaves(document, ()):
        others = (_read(written(_with(document, path, o)), name) for o in _others(value))
        if all(other == before for other in others):
            found.append(".".join(map(str, path)))
    return found


def _read(text: str, name: str) -> Scene | str:
    try:
        return replace(parse_scene(text, name), text="", told=())
    except SceneError as error:
        return str(error)


def _said(text: str, name: str) -> tuple[str, ...]:
    """Return all that is said of a scene: its code and warnings, or why it is refused."""
    try:
        scene: Scene = replace(parse_scene(text, name), text="", told=())
        return (*c_files(library(scene), ()).values(), *scene.warnings)
    except SceneError as error:
        return (str(error),)


def _matters(made: Library, text: str, name: str) -> bool:
    """Tell whether a change changes the answers at a sample; where there are none, it does."""
    other = parse_scene(text, name)
    (sample,) = samples(made.mechanism, PRECISIONS[1], 1, 0).each[:1]
    scenes = (made.scene, other)
    first, second = (_by_particles(made, one, sample.values) for one in scenes)
    with mp.workdps(DIGITS):
        pairs = list(zip(first, second, strict=True))
        size = max((abs(x) for pair in pairs for x in pair), default=mpf(0))
        return not pairs or any(abs(a - b) > AGREE * size for a, b in pairs)


def _by_particles(made: Library, scene: Scene, values: Mapping[str, float]) -> list[Any]:
    """Return the answers of a machine that its cloud of particles has."""
    found = []
    for base, problem in made.problems.items():
        posed = scene.posed(base)
        cloud = answers(posed, values)
        if base == "linearised" or problem.outputs[0].name in MATRICES:
            found += [x for table in slopes_about_rest(scene, values) for x in table]
            continue
        names = [c for q in problem.outputs for c in q.components]
        found += [*of_cloud(posed, cloud, base, names).values()]
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
    return "".join(f"{_key(key)} = {_inline(value)}\n" for key, value in document.items())


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_inline(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return str(value).lower().removesuffix("inity")  # a Decimal says Infinity, TOML says inf


def _key(key: str) -> str:
    return key if re.fullmatch("[A-Za-z0-9_-]+", key) else json.dumps(key, ensure_ascii=False)
