"""Figures that were found before: taken over from a scene's JSON while nothing has changed.

Measuring a catalogue takes minutes, and so does proving its bounds. A digest of all that the
figures depend on stands beside them: the scene, its programs, how samples are taken, and the text
of the modules that measure; another one of what the bounds depend on.
"""

import ast
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from derive.library.library import Library
from derive.program.precision import PRECISIONS
from derive.program.program import Bound, Measurement, Program
from derive.verify.proved.bounds import Proof, proof_of, proved_bounds
from derive.verify.search import Sampling
from derive.verify.stated import figures

METHOD = (
    *("program/added", "program/arithmetic", "program/own_sine", "program/pair_sine"),
    *("program/pairs",),
    *("verify/columns", "verify/draw", "verify/gains", "verify/hard_bodies", "verify/measure"),
    *("verify/operators", "verify/ratios", "verify/reference", "verify/sample", "verify/scale"),
    *("verify/search", "verify/solution", "verify/stated"),
)
"""The modules that figures are measured by."""
PROVING = (
    *("program/arithmetic", "program/own_sine", "program/pair_sine", "program/pairs"),
    *("verify/columns", "verify/draw", "verify/scale"),
    *(f"verify/proved/{name}" for name in ("bounds", "cells", "cut", "enclosed", "forms")),
    *(f"verify/proved/{name}" for name in ("lengths", "meant", "multiples", "ranges", "seen")),
    *(f"verify/proved/{name}" for name in ("slopes", "sphere", "traits", "unfolded", "waist")),
)
"""The modules that bounds are proved by, and seen beside."""


@dataclass(frozen=True)
class Measuring:
    """How figures are come by: sampled so, or as they lie below a folder if nothing has changed."""

    sampling: Sampling
    folder: Path | None


@dataclass(frozen=True)
class Digests:
    """What errors and bounds depend on, each in one word."""

    errors: str = ""
    bounds: str = ""


UNDIGESTED = Digests()


@dataclass(frozen=True)
class Figures:
    """The errors of a scene's functions with their bounds, and the digests of what they rest on."""

    each: tuple[Measurement, ...]
    digest: Digests


def figures_of(library: Library, by: Measuring) -> Figures:
    """Return the figures of a scene, measured and proved if none are kept that are still true."""
    manifest, proof = _manifest(library, by), proof_of(by.sampling)
    digest = Digests(digest_of(library, by.sampling), digest_of_bounds(library, proof))
    each = kept_figures(manifest, digest.errors) or figures(library, by.sampling)
    own = kept_bounds(manifest, digest.bounds)
    proved = {_place(b): b for b in own or proved_bounds(library, proof)}
    return Figures(tuple(replace(m, bound=proved.get(_place(m))) for m in each), digest)


def _place(of: Measurement | Bound) -> tuple[str, str, str]:
    return of.function, of.precision, of.output


def are_kept(library: Library, by: Measuring) -> bool:
    """Tell whether the figures of a scene need neither be measured nor proved."""
    manifest = _manifest(library, by)
    own = kept_bounds(manifest, digest_of_bounds(library, proof_of(by.sampling)))
    return bool(own and kept_figures(manifest, digest_of(library, by.sampling)))


def _manifest(library: Library, by: Measuring) -> Any:
    """Return what the JSON of a scene says that lies below the folder, nothing if none does."""
    name = library.scene.name
    return None if by.folder is None else _read(by.folder / name / f"{name}.json")


def digest_of_bounds(library: Library, by: Proof) -> str:
    """Return a digest of all that the bounds of a scene depend on."""
    programs = [_numbers(p) for p in (library.setup, *library.printed())]
    ranges = [(q.name, q.components, q.low, q.high) for q in library.vocabulary.every()]
    parts = (library.scene.name, repr(by), repr([*programs, ranges]), _method(PROVING))
    return sha256("\n".join(parts).encode()).hexdigest()


def digest_of(library: Library, by: Sampling) -> str:
    """Return a digest of all that the figures of a scene depend on."""
    scene = library.scene
    programs = map(_numbers, (library.setup, *library.printed(), *library.rates))
    ranges = [(q.name, q.components, q.low, q.high) for q in library.vocabulary.every()]
    problems = [(name, *map(str, p.residuals)) for name, p in library.problems.items()]
    parts = (scene.name, scene.text, repr(by), repr([*programs, ranges, problems]), _method(METHOD))
    return sha256("\n".join(parts).encode()).hexdigest()


def _numbers(program: Program) -> tuple[Any, ...]:
    """Return what of a program its numbers depend on: all but its words."""
    ends = [[(q.name, q.components, q.low, q.high) for q in given]
            for given in (program.inputs, program.outputs)]  # fmt: skip
    work = (program.ops, program.results, program.numbers, program.sparsity, program.arithmetic)
    return (program.name, *ends, *work)


@cache
def _method(modules: Sequence[str]) -> str:
    """Return what modules say, wherever they and what they import stand."""
    here = Path(__file__).parent.parent
    texts = [(here / f"{name}.py").read_text(encoding="utf-8") for name in modules]
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


def kept_bounds(manifest: Any, digest: str) -> tuple[Bound, ...]:
    """Return the bounds of a scene's JSON, none if they are of another digest or not whole."""
    try:
        if manifest["measured"]["bounds"] != digest:
            return ()
        return stated_bounds(manifest)
    except (KeyError, TypeError, ValueError):
        return ()


def stated_bounds(manifest: Any) -> tuple[Bound, ...]:
    """Return the bounds that a scene's JSON states, whoever proved them."""
    return tuple(
        Bound(
            f["name"],
            precision.name,
            output,
            row.get("proved"),
            float(row.get("seen", 0.0)),
            tuple(f["bounds"]["assumed"]),
            row.get("why", ""),
        )
        for f in manifest["functions"]
        for precision in PRECISIONS
        for output, row in f.get("bounds", {}).get(precision.name, {}).items()
    )


def stated_figures(manifest: Any) -> tuple[Measurement, ...]:
    """Return the figures that a scene's JSON states, whoever measured them."""
    errors = [(f["name"], f.get("error", {})) for f in manifest["functions"]]
    proved = {_place(b): b for b in stated_bounds(manifest)}
    return tuple(
        _measurement(proved, name, precision.name, output, row)
        for precision in PRECISIONS
        for name, error in errors
        if precision.name in error and not isinstance(error, str)  # set-up's is a sentence
        for output, row in error[precision.name].items()
    )


def _measurement(
    proved: Mapping[tuple[str, str, str], Bound],
    function: str,
    precision: str,
    output: str,
    row: Any,
) -> Measurement:
    return Measurement(
        function,
        precision,
        output,
        float(row["median_ulp"]),
        float(row["largest_within_ulp"]),
        float(row["largest_ulp"]),
        int(row["worst_sample"]),
        str(row["worst_kind"]),
        int(row["samples"]),
        int(row["searched"]),
        int(row["hard_samples"]),
        proved.get((function, precision, output)),
    )
