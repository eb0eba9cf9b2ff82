"""The same inputs give the same bytes: under any hash seed and whatever the symbols are called."""

import os
import re
import subprocess
import sys

import pytest

from derive.library import library
from derive.scene import catalogue, load, parse_scene

DIGEST = """
import hashlib
from derive.casadi_text import casadi_file
from derive.emit import c_files
from derive.library import library
from derive.manifest import manifest
from derive.page import lecture_page
from derive.page.scene import scene_page
from derive.scene import load
digest = hashlib.sha256(lecture_page().encode())
for name in ("satellite", "tumbling_disc", "unsymmetrical_rotor_in_carrier_axes"):
    made = library(load(name))
    texts = [*c_files(made, ()).values(), casadi_file(made), manifest(made, ())]
    for text in [*texts, scene_page(made, ())]:
        digest.update(text.encode())
print(digest.hexdigest())
"""


def test_the_hash_seed_changes_no_byte():
    found = set()
    running = [
        subprocess.Popen(
            [sys.executable, "-c", DIGEST],
            env=os.environ | {"PYTHONHASHSEED": seed},
            stdout=subprocess.PIPE,
        )
        for seed in ("0", "4242")
    ]
    for process in running:
        found.add(process.communicate()[0])
        assert process.returncode == 0
    assert len(found) == 1


# Scenes of motion alone say the same as the others about how parameters are named.
MOVED_ONLY = ("attitude", "heavy_body", "rigid_body_steps", "tumbling_body")


def renamed(text: str, names: dict[str, str]) -> str:
    parts = re.split(r'(unit\s*=\s*"[^"]*")', text)
    words = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
    other = [
        p if i % 2 else words.sub(lambda m: names.get(m[0], m[0]), p) for i, p in enumerate(parts)
    ]
    return "".join(other)


@pytest.mark.long
@pytest.mark.parametrize("name", [n for n in catalogue() if n not in MOVED_ONLY])
def test_other_names_give_the_same_operations(name):
    scene = load(name)
    given = (
        [p.name for p in scene.parameters]
        + [c.name for c in scene.coordinates]
        + [s.name for s in scene.speeds]
    )
    other = {old: f"Zz{len(given) - i}{old[::-1].strip('_')}" for i, old in enumerate(given)}
    other |= {f"{old}_{dots}": f"{new}_{dots}" for old, new in other.items()
              for dots in ("dot", "ddot")}  # fmt: skip
    disguised = parse_scene(renamed(scene.text, other), name)
    first, second = library(scene), library(disguised)
    for one, two in zip(
        (first.setup, *first.functions), (second.setup, *second.functions), strict=True
    ):
        assert shape(one) == shape(two)


def shape(program) -> tuple:
    """Return a program with every input and constant called by its place."""
    names = [c for q in program.inputs for c in q.components]
    place = {n: f"input {i}" for i, n in enumerate(names)}
    ops = tuple((op.operator, tuple(place.get(o, o) for o in op.operands)) for op in program.ops)
    return ops, tuple(place.get(r, r) for r in program.results)
