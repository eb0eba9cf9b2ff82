"""The emitted files of a scene, compiled and loaded: what a user would run."""

import json
import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import casadi

from derive.check.call import CFunction, c_functions
from derive.check.compiler import Compiler, compiled
from derive.check.verdict import Outcome, Verdict
from derive.emit.c.members_file import OVER_MEMBERS
from derive.emit.casadi_module import imported
from derive.emit.files import differences, scene_files
from derive.emit.reported import lying_beside
from derive.library.external import CASADI, derivatives_of_step
from derive.library.library import Library
from derive.program.precision import F64, PRECISIONS, Precision
from derive.program.program import Program
from derive.verify.kept import Measuring, figures_of, stated_figures
from derive.verify.measure import Errors, Expected, errors
from derive.verify.sample import Sample
from derive.verify.search import SAMPLING, Sampling, sampled_at

SAMPLES = range(1, 10**9 + 1)
"""How many samples may be asked for: a billion takes days."""


@dataclass(frozen=True)
class Files:
    """The texts of a scene's files by name, and where they are from.

    differ : files that lie there and are not what the scene makes
    samples : of the ranges, that each stated error was looked for at
    parts   : what was asked for beside the usual files
    left    : files that lie there and no scene makes
    """

    texts: Mapping[str, str]
    origin: str
    differ: tuple[str, ...] = ()
    samples: int = SAMPLING.samples
    parts: tuple[str, ...] = ()
    left: tuple[str, ...] = ()

    @property
    def manifest(self) -> Mapping[str, Any]:
        """Return the scene's JSON."""
        name = next(name for name in self.texts if name.endswith(".json"))
        found: Mapping[str, Any] = json.loads(self.texts[name])
        return found


@dataclass(frozen=True)
class Emitted:
    """A scene's programs beside the compiled C of one precision that was printed from them."""

    library: Library
    precision: Precision
    functions: Mapping[str, CFunction]
    shared: Path

    def constants(self, sample: Sample) -> dict[str, list[float]]:
        """Return what set-up makes of a sample's parameters; nothing where a scene needs none."""
        setup = self.functions.get("setup")
        return {} if setup is None else setup(inputs(self.library.setup, sample, {}))

    def results(self, program: Program, sample: Sample) -> list[float]:
        """Return all components that a function of C gives at a sample."""
        found = self.functions[program.name](inputs(program, sample, self.constants(sample)))
        return [x for q in program.outputs for x in found[q.name]]


def errors_of(
    one: Emitted, program: Program, each: Sequence[Sample], true: Sequence[Sequence[Expected]]
) -> list[Errors]:
    """Return how far each output of a function of C is from what it should be."""
    columns = list(zip(*(one.results(program, s) for s in each), strict=True))
    return errors(program, columns, true, one.precision)


def verdict(one: Emitted, function: str, check: str, outcome: Outcome, says: str) -> Verdict:
    """Return a verdict on a function in C, or on ``all``."""
    name = one.library.scene.name
    return Verdict(name, function, one.precision.name, check, outcome, says)


def inputs(
    program: Program, sample: Sample, constants: Mapping[str, Sequence[float]]
) -> dict[str, Sequence[float]]:
    """Return a function's inputs by name at a sample."""
    return {
        q.name: constants["constants"]
        if q.role == "constants"
        else [sample.values[c] for c in q.components]
        for q in program.inputs
    }


def sampling_of(folder: Path, name: str) -> Sampling:
    """Return how widely the JSON of a scene says that its errors were looked for.

    It is the usual one where no JSON lies there, or one that says no such thing.
    """
    try:
        text = (folder / name / f"{name}.json").read_text(encoding="utf-8")
        said = {m.samples for m in stated_figures(json.loads(text))}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return SAMPLING
    return sampled_at(*said) if len(said) == 1 and min(said) in SAMPLES else SAMPLING


def parts_of(folder: Path, name: str) -> tuple[str, ...]:
    """Return what the JSON of a scene says that was asked for beside the usual files."""
    try:
        text = (folder / name / f"{name}.json").read_text(encoding="utf-8")
        said = shlex.split(json.loads(text)["command"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return ()
    return tuple(part for part in (CASADI, OVER_MEMBERS) if f"--{part}" in said)


def files(library: Library, folder: Path, sampling: Sampling) -> Files:
    """Return a scene's files, made in memory: what lies below ``folder`` is compared, never run.

    Only figures are taken over from there, by the digest of all that they depend on.
    """
    name = library.scene.name
    measured = figures_of(library, Measuring(sampling, folder))
    parts = parts_of(folder, name)
    of = derivatives_of_step(library) if CASADI in parts else None
    beside = lying_beside(library, folder)
    made = scene_files(library, measured.each, measured.digest, beside, of, parts)
    texts = {path.partition("/")[2]: text for path, text in made.items()}
    own = {file: text for file, text in texts.items() if not file.endswith(".html")}
    if not (folder / name).is_dir():
        return Files(own, "made in memory", (), sampling.samples)
    every = [*differences(folder, made)]
    found = tuple(d.name for d in every if not d.left_over)
    left = tuple(str(folder / d.name) for d in every if d.left_over)
    return Files(own, f"{folder / name}", found, sampling.samples, parts, left)


def loaded(library: Library, found: Files, workshop: Path, with_: Compiler) -> Iterator[Emitted]:
    """Yield the compiled C of each precision; raises CompilerError at a warning."""
    name = library.scene.name
    for precision in PRECISIONS:
        own = {n: t for n, t in found.texts.items() if n.endswith((".c", ".h"))}
        shared = compiled(own, f"{name}_{precision.name}.c", workshop, with_)
        callable_ = c_functions(found.manifest, shared, precision.name)
        yield Emitted(library, precision, callable_, shared)


def casadi_module(library: Library, found: Files, workshop: Path) -> ModuleType:
    """Return the scene's CasADi file as a module."""
    name = f"{library.scene.name}_casadi"
    return imported(name, found.texts[f"{name}.py"], workshop)


def from_parameters(
    module: Any, function: Any, program: Program, sample: Sample
) -> list[list[float]]:
    """Return what a function of a CasADi file, or set-up itself, gives from parameters on."""
    names = [q.components for q in program.inputs if q.role != "constants"]
    if program.makes("constants"):
        names = [module.PARAMETERS]
    elif len(names) < len(program.inputs):
        names = [module.PARAMETERS, *names]
    given = [casadi.DM([sample.values[c] for c in own]) for own in names]
    return [list(y.nonzeros()) for y in function.call(given)]


def is_double(emitted: Emitted) -> bool:
    """Tell whether this is the precision that CasADi computes in."""
    return emitted.precision is F64
