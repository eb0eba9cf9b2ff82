"""Figures that were measured before: taken over from a scene's JSON while nothing has changed.

Measuring a catalogue takes minutes. A digest of all that the figures depend on stands beside them:
the scene, its programs, how samples are taken, and the text of the modules that measure.
"""

import ast
import json
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from derive.library.library import Library
from derive.program.precision import PRECISIONS
from derive.program.program import Measurement, Program
from derive.verify.search import Sampling
from derive.verify.stated import figures

METHOD = (
    *("program/added", "program/arithmetic", "program/own_sine", "program/pair_sine"),
    *("program/pairs",),
    *("verify/columns", "verify/draw", "verify/hard_bodies", "verify/measure"),
    *("verify/operators", "verify/ratios", "verify/reference", "verify/sample", "verify/scale"),
    *("verify/search", "verify/solution", "verify/stated"),
)
"""The modules that figures are measured by."""


@dataclass(frozen=True)
class Measuring:
    """How figures are come by: sampled so, or as they lie below a folder if nothing has changed."""

    sampling: Sampling
    folder: Path | None


@dataclass(frozen=True)
class Figures:
    """The errors of a scene's functions, and the digest of all that they depend on."""

    each: tuple[Measurement, ...]
    digest: str


def figures_of(library: Library, by: Measuring) -> Figures:
    """Return the figures of a scene, measured if none are kept that are still true."""
    digest = digest_of(library, by.sampling)
    return Figures(_kept(library, by, digest) or figures(library, by.sampling), digest)


def are_kept(library: Library, by: Measuring) -> bool:
    """Tell whether the figures of a scene need not be measured."""
    return bool(_kept(library, by, digest_of(library, by.sampling)))


def _kept(library: Library, by: Measuring, digest: str) -> tuple[Measurement, ...]:
    name = library.scene.name
    file = None if by.folder is None else by.folder / name / f"{name}.json"
    return () if file is None else kept_figures(_read(file), digest)


def digest_of(library: Library, by: Sampling) -> str:
    """Return a digest of all that the figures of a scene depend on."""
    scene = library.scene
    programs = map(_numbers, (library.setup, *library.printed(), *library.rates))
    ranges = [(q.name, q.components, q.low, q.high) for q in library.vocabulary.every()]
    problems = [(name, *map(str, p.residuals)) for name, p in library.problems.items()]
    parts = (scene.name, scene.text, repr(by), repr([*programs, ranges, problems]), _method())
    return sha256("\n".join(parts).encode()).hexdigest()


def _numbers(program: Program) -> tuple[Any, ...]:
    """Return what of a program its numbers depend on: all but its words."""
    ends = [[(q.name, q.components, q.low, q.high) for q in given]
            for given in (program.inputs, program.outputs)]  # fmt: skip
    work = (program.ops, program.results, program.numbers, program.sparsity, program.arithmetic)
    return (program.name, *ends, *work)


@cache
def _method() -> str:
    """Return what the modules that measure say, wherever they and what they import stand."""
    here = Path(__file__).parent.parent
    texts = [(here / f"{name}.py").read_text(encoding="utf-8") for name in METHOD]
    return sha256("\n".join(sorted(map(unplaced, texts))).encode()).hexdigest()


def unplaced(text: str) -> str:
    """Return the text of a module without its imports and without spaces.

    >>> unplaced("import a\\nx = a.b\\n")
    'x=a.b'
    """
    lines = text.splitlines()
    for node in ast.parse(text).body:
        if isinstance(node, ast.Import | ast.ImportFrom) and node.end_lineno:
            lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
    return "".join("".join(lines).split())


def _read(file: Path) -> Any:
    """Return what a scene's JSON says, nothing if there is none that can be read."""
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def kept_figures(manifest: Any, digest: str) -> tuple[Measurement, ...]:
    """Return the figures of a scene's JSON, none if they are of another digest or not whole."""
    try:
        if manifest["measured"]["digest"] != digest:
            return ()
        return stated_figures(manifest)
    except (KeyError, TypeError, ValueError):
        return ()


def stated_figures(manifest: Any) -> tuple[Measurement, ...]:
    """Return the figures that a scene's JSON states, whoever measured them."""
    errors = [(f["name"], f.get("error", {})) for f in manifest["functions"]]
    return tuple(
        _measurement(name, precision.name, output, row)
        for precision in PRECISIONS
        for name, error in errors
        if precision.name in error and not isinstance(error, str)  # set-up's is a sentence
        for output, row in error[precision.name].items()
    )


def _measurement(function: str, precision: str, output: str, row: Any) -> Measurement:
    numbers = ("samples", "searched", "hard_samples")
    return Measurement(
        function,
        precision,
        output,
        float(row["median_ulp"]),
        float(row["largest_within_ulp"]),
        float(row["largest_ulp"]),
        int(row["worst_sample"]),
        str(row["worst_kind"]),
        *(int(row[name]) for name in numbers),
    )
