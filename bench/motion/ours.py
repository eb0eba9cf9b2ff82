"""Our steppers for a case: the scene of its kind emitted, compiled with the driver, and called."""

import json
import tomllib
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.motion.case import Case
from bench.motion.glue import glue, movers
from bench.motion.runner import Mover, built, methods_header
from derive.emit.c.source import c_files
from derive.emit.manifest import manifest
from derive.library.library import Library, library
from derive.scene import SceneError, load

SCENES = ("principal", "general", "axisymmetric", "spherical", "moment", "wheel", "weight")
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Emission:
    """A scene's programs, their C, its manifest as JSON and read, and what could not be made."""

    scene: str
    programs: Library
    texts: Mapping[str, str]
    json: str
    manifest: Mapping[str, Any]
    without: Mapping[str, str]


def scenes_for(case: Case) -> list[str]:
    """Return the scenes that describe a case: the most special one first.

    >>> from bench.motion.case import cases
    >>> scenes_for(cases()["sphere"]), scenes_for(cases()["full_tensor"])
    (['spherical', 'axisymmetric', 'principal'], ['general'])
    """
    for name, vector in (("moment", case.moment), ("wheel", case.wheel), ("weight", case.weight)):
        if any(vector):
            return [name]
    if not case.principal:
        return ["general"]
    found = ["principal"]
    if case.inertia[0] == case.inertia[1]:
        found.insert(0, "axisymmetric")
        if case.inertia[1] == case.inertia[2]:
            found.insert(0, "spherical")
    return found


def parameters(emission: Emission, case: Case) -> list[float]:
    """Return the values of a scene's parameters in a case, in the order of the manifest."""
    values = _values(case)
    return [values[q["name"]] for q in emission.manifest["parameters"]]


def _values(case: Case) -> dict[str, float]:
    xx, yy, zz, xy, xz, yz = (float(x) for x in case.inertia)
    found = {"I_xx": xx, "I_yy": yy, "I_zz": zz, "I_xy": -xy, "I_xz": -xz, "I_yz": -yz}
    found |= {"A": xx, "C": zz}
    for letter, vector in (("M", case.moment), ("h", case.wheel), ("c", case.weight)):
        found |= {f"{letter}_{axis}": float(x) for axis, x in zip(AXES, vector, strict=True)}
    return found


@cache
def emission(scene: str) -> Emission:
    """Return the C and the manifest of a scene of the folder ``scenes``, made in memory.

    A function that is refused is left out, and ``without`` says why.
    """
    text = (files("bench.motion") / "scenes" / f"{scene}.toml").read_text(encoding="utf-8")
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"{scene}.toml"
        path.write_text(text, encoding="utf-8")
        without = _unmade(path)
        path.write_text(_only(text, without), encoding="utf-8")
        programs = library(load(str(path)))
    described = manifest(programs, ())
    texts = c_files(programs, ())
    return Emission(scene, programs, texts, described, json.loads(described), without)


def _unmade(path: Path) -> dict[str, str]:
    """Return why a wanted function cannot be made, by its name; nothing if all can."""
    text, found = path.read_text(encoding="utf-8"), {}
    names = tomllib.loads(text)["wanted"]
    for name in names:
        path.write_text(_only(text, set(names) - {name}), encoding="utf-8")
        try:
            library(load(str(path)))
        except SceneError as reason:
            found[name] = f"not emitted: {reason}"
    return found


def _only(text: str, without: Collection[str]) -> str:
    for name in without:
        text = text.replace(f'    "{name}",\n', "")
    return text


def ours(made: Emission, precision: str, folder: Path) -> Mover:
    """Return a scene's steppers built with the driver."""
    count = len(made.manifest["parameters"])
    names = made.manifest["files"][precision]
    texts = {name: made.texts[name] for name in (names["source"], names["header"])}
    texts |= {
        "methods.h": methods_header(precision, count),
        "methods.c": glue(made.manifest, precision),
    }
    return built(texts, movers(made.manifest), count, folder)
