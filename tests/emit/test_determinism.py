"""The same inputs give the same bytes: under any hash seed and whatever the symbols are called."""

import json
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from random import Random
from typing import Any

import pytest

from derive.library.library import library
from derive.lower.arrange.block import Solution
from derive.lower.expand import family
from derive.lower.graph import Graph
from derive.program.program import Op, Operand, Program
from derive.scene import catalogue, load, parse_scene
from tests.made import library_of, thinned

DIGEST = """
import hashlib, sys
from derive.emit.casadi_text import casadi_file
from derive.emit.c.source import c_files
from derive.library.library import library
from derive.emit.manifest import manifest
from derive.emit.page.lecture import lecture_page
from derive.emit.page.scene import scene_page
from derive.scene import load
digest = hashlib.sha256(lecture_page().encode())
for name in sys.argv[1:]:
    made = library(load(name))
    texts = [*c_files(made, ()).values(), casadi_file(made), manifest(made, ())]
    for text in [*texts, scene_page(made, ())]:
        digest.update(text.encode())
print(digest.hexdigest())
"""


LARGER = ("edge_runner_flat", "satellite", "reaction_wheel_satellite", "tumbling_disc",
          "unsymmetrical_rotor_in_carrier_axes", "gyrostat")  # fmt: skip


@pytest.mark.parametrize("scenes", thinned([("heavy_top",), LARGER], 2))
def test_the_hash_seed_changes_no_byte(scenes: tuple[str, ...]) -> None:
    found = set()
    running = [
        subprocess.Popen(
            [sys.executable, "-c", DIGEST, *scenes],
            env=os.environ | {"PYTHONHASHSEED": seed},
            stdout=subprocess.PIPE,
        )
        for seed in ("0", "4242")
    ]
    for process in running:
        found.add(process.communicate()[0])
        assert process.returncode == 0
    assert len(found) == 1


NAMED = (
    *("parameters", "coordinates", "speeds", "inputs", "frames", "bodies", "loads", "results"),
    "linearised",
)
"""The tables of a scene whose keys are names of the scene's own."""
SPOKEN = ("title", "source", "meaning", "unit", "kind", "shape", "axis", "about", "components")
"""Entries that hold no name of its own."""
LEAN = ("heavy_top", "edge_runner_flat", "skewed_disc")
EVERY = [n if n in LEAN else pytest.param(n, marks=pytest.mark.long) for n in catalogue()]


def other_names(scene: Mapping[str, Any], text: str, seed: str) -> dict[str, str]:
    """Return another name for each of a scene's own, in any order, most of them alike up to a _."""
    keys = [name for table in NAMED for name in scene.get(table, {})]
    wheels = [wheel["name"] for wheel in scene.get("wheels", ())]
    names = list(dict.fromkeys([*keys, *wheels, *re.findall(r'"\?([A-Za-z]\w*)', text)]))
    places = Random(seed).sample(range(100, 1000), len(names))
    return {name: f"{'zzq'[place % 3]}z_{place}" for name, place in zip(names, places, strict=True)}


def renamed(entry: Any, names: Mapping[str, str], key: str = "") -> Any:
    """Return an entry of a scene with every name replaced, those of rates and components too."""

    def word(found: re.Match[str]) -> str:
        for name in sorted(names, key=len, reverse=True):
            if found[0] == name or found[0].startswith(f"{name}_"):
                return names[name] + found[0].removeprefix(name)
        return found[0]

    match entry:
        case dict():
            own = names if key in NAMED else {}
            return {own.get(k, k): renamed(v, names, k) for k, v in entry.items()}
        case list():
            return [renamed(each, names, key) for each in entry]
        case str() if key == "turned":
            axis, angle = entry.split(maxsplit=1)
            return f"{axis} {renamed(angle, names)}"
        case str() if key not in SPOKEN:
            return re.sub(r"[A-Za-z]\w*", word, entry)
    return entry


def toml(value: Any) -> str:
    """Return a value as TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def disguised(text: str, seed: str) -> str:
    """Return a scene under other names."""
    scene = tomllib.loads(text)
    other = renamed(scene, other_names(scene, text, seed))
    return "\n".join(f"{key} = {toml(value)}" for key, value in other.items())


@pytest.mark.parametrize("name", EVERY)
def test_other_names_give_the_same_operations(name: str) -> None:
    first = library_of(name)
    second = library(parse_scene(disguised(load(name).text, name), name))
    pairs = zip((first.setup, *first.printed()), (second.setup, *second.printed()), strict=True)
    assert [one.name for one, other in pairs if shape(one) != shape(other)] == []


@pytest.mark.parametrize("name", thinned(("unsymmetrical_rotor_in_carrier_axes", "gyrostat"), 2))
def test_what_the_stages_are_called_does_not_matter(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the letters before "_" no name tells which vector it belongs to."""
    before, made = Solution.named, library_of(name)

    def named(self: Solution, kind: str, called: str, *of: Any) -> Any:
        return before(self, kind, called.replace("_", ""), *of)

    monkeypatch.setattr(Solution, "named", named)
    other = library(load(name))
    pairs = zip((made.setup, *made.printed()), (other.setup, *other.printed()), strict=True)
    assert [one.name for one, two in pairs if shape(one) != shape(two)] == []


def test_names_that_begin_alike_are_no_vector() -> None:
    graph = Graph()
    values = [graph.power(graph.variable(name), 2) for name in "xyz"]
    alone = [graph.let(name, value)[1] for name, value in zip(("a_1", "a_2"), values, strict=False)]
    assert family(graph, alone[0]) != family(graph, alone[1])
    vector = (
        graph.let("b_x", values[2], "b")[1],
        graph.let("b_y", graph.power(values[2], 2), "b")[1],
    )
    assert family(graph, vector[0]) == family(graph, vector[1])


def shape(program: Program) -> tuple[Any, ...]:
    """Return a program with every input and every value called by its place."""
    place: dict[Operand, int] = {}

    def at(names: Iterable[Operand | None]) -> list[Any]:
        return [place.setdefault(n, len(place)) if isinstance(n, str) else n for n in names]

    def line(one: Any) -> list[Any]:
        if isinstance(one, Op):
            return [one.operator, at(one.operands), at([one.result])]
        if isinstance(one, str):
            return at([one])
        if isinstance(one, tuple):
            return [line(part) for part in one]
        if not is_dataclass(one):
            return [one]
        return [type(one), *(line(getattr(one, f.name)) for f in fields(one))]

    inputs = [at(q.components) for q in program.inputs]
    ops = [line(one) for one in program.ops]
    return inputs, ops, at(program.results), program.count
