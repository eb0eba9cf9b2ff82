"""Functions over members give the bits of the scene's own, in vectors and at their ends."""

import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derive.check.compiler import WARNINGS, Compiler
from derive.emit.c.members import IN_COMMON, SET_ENDINGS, Sets, is_in_vectors
from derive.emit.c.members_file import VECTOR_OPTIONS, members_files, members_of
from derive.emit.c.source import c_files
from derive.library.library import Library
from derive.program.precision import F32, F64, PRECISIONS, Precision
from derive.program.program import Program, component_names
from derive.scene import catalogue
from derive.solve.members import MembersCompiled, members_compiled
from derive.verify.columns import Supplied
from tests.check.bulk import differing, inputs_at, returned_at, shared
from tests.made import library_of

MANY = 4099
COMPILERS = tuple(name for name in ("gcc", "clang") if shutil.which(name))
OPTIONS = (("-O2",), VECTOR_OPTIONS)
FEW = ("heavy_top", "free_body_principal", "attitude")
"""Sines and constants; a machine without either; choices and ``atan2``."""
SCENES = [
    *FEW,
    *(pytest.param(n, marks=[pytest.mark.long, *([pytest.mark.whole] if n != "satellite" else [])])
      for n in catalogue() if n not in FEW),
]  # fmt: skip


def supplied(made: Library, precision: Precision, many: int, sets: Sets) -> Supplied:
    """Return inputs of all functions; what members have in common is the same for all."""
    at = inputs_at(made, precision, many)
    same = {*IN_COMMON}
    if sets == "shared":
        same |= {c for q in made.setup.inputs for c in q.components}
        same |= {*component_names(made.setup)}
    own = {n: np.full_like(x, x[0]) if n in same else x for n, x in at.own.items()}
    return replace(at, own=own)


def over_members(
    made: Library, precision: Precision, at: Supplied, by: MembersCompiled, sets: Sets
) -> Mapping[str, Any]:
    """Return what functions over members give, as ``returned_at`` does."""
    many = len(next(iter(at.own.values())))
    constants = None
    if made.constants:
        rows = [at.own[c] for q in made.setup.inputs for c in q.components]
        table = np.array(rows, precision.dtype).reshape(len(rows), many)
        constants, status = by.setup(table)
        assert not status.any()
        constants = np.ascontiguousarray(constants[:, 0]) if sets == "shared" else constants
    return {p.name: called(p, precision, at, by, constants) for p in made.printed()}


def called(
    program: Program, precision: Precision, at: Supplied, by: MembersCompiled, constants: Any
) -> Any:
    """Return the results of one function, (members, components)."""
    many = len(next(iter(at.own.values())))
    given: dict[str, Any] = {
        q.name: np.array([at.own[c] for c in q.components], precision.dtype)
        for q in program.inputs if q.role != "constants"
    }  # fmt: skip
    given |= {name: float(given[name][0, 0]) for name in IN_COMMON if name in given}
    found = by.results(program, many)
    by(program.name, constants, given, found, many)
    return np.concatenate(found).T


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("scene", SCENES)
def test_thousands_of_members_have_the_bits_of_the_scenes_own_function(
    scene: str, compiler: str, tmp_path: Path
) -> None:
    made = library_of(scene)
    for precision in PRECISIONS:
        own = shared(made, precision, c_files(made, ()), tmp_path / precision.name)
        for sets in SET_ENDINGS:
            at = supplied(made, precision, MANY, sets)
            expected = returned_at(made, precision, at, own)
            for options in OPTIONS:
                by = members_compiled(made, precision, Compiler((compiler,)), options)
                found = over_members(made, precision, at, by, sets)
                assert differing(expected, found) == [], (precision.name, sets, options)
        assert all(np.any(table) for table in found.values())


@pytest.mark.long
@pytest.mark.parametrize("compiler", COMPILERS)
def test_angles_beyond_our_own_sines_and_no_numbers_have_those_bits_too(
    compiler: str, tmp_path: Path
) -> None:
    made = library_of("heavy_top")
    for precision, most in ((F64, 25735.0), (F32, 804.0)):
        at = supplied(made, precision, 257, "each")
        theta = at.own["theta"].copy()
        odd = (most, np.nextafter(precision.dtype(most), precision.dtype(np.inf)), -1e6, 1e30,
               np.nan, np.inf, -np.inf, -0.0)  # fmt: skip
        for n, angle in enumerate(odd):
            theta[n * 31] = angle
        at = replace(at, own={**at.own, "theta": theta})
        own = shared(made, precision, c_files(made, ()), tmp_path / precision.name)
        by = members_compiled(made, precision, Compiler((compiler,)))
        found = over_members(made, precision, at, by, "each")
        assert differing(returned_at(made, precision, at, own), found) == []


@pytest.mark.long
@pytest.mark.parametrize("scene", ["heavy_top", "satellite"])
def test_any_number_of_members_at_any_address_and_results_over_inputs(scene: str) -> None:
    made, function = library_of(scene), "state_rate" if scene == "heavy_top" else "step_rk4"
    made = replace(made, functions=tuple(p for p in made.functions if p.name == function),
                   motions=tuple(p for p in made.motions if p.name == function))  # fmt: skip
    program = made[function]
    for precision in PRECISIONS:
        by = members_compiled(made, precision, Compiler((COMPILERS[0],)))
        at = supplied(made, precision, 200, "each")
        whole = over_members(made, precision, at, by, "each")[function].T
        rows = np.array([at.own[c] for q in made.setup.inputs for c in q.components])
        for many in (0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 63, 64, 65, 131):
            for off in (0, 1, 3):
                shifted = _at_an_odd_place(rows[:, :many], precision, off)
                made_, _ = by.setup(shifted)
                constants = _at_an_odd_place(made_, precision, off, stride=many + 5)
                given: dict[str, Any] = {
                    q.name: _at_an_odd_place(np.array([at.own[c][:many] for c in q.components]),
                                             precision, off, stride=many + 5)
                    for q in program.inputs if q.role != "constants"
                }  # fmt: skip
                given |= {n: at.own[n][0] for n in IN_COMMON if n in given}
                assert _same(program, constants, given, by, whole[:, :many])


def _at_an_odd_place(values: Any, precision: Precision, off: int, stride: int = 0) -> Any:
    """Return a copy that starts ``off`` numbers later than arrays do, in rows of a stride."""
    rows, many = values.shape
    stride = stride or many
    memory = np.full(rows * stride + off, 77.0, precision.dtype)
    placed = memory[off:].reshape(rows, stride)
    placed[:, :many] = values
    return placed


def _same(
    program: Program, constants: Any, given: dict[str, Any], by: MembersCompiled, whole: Any
) -> bool:
    """Tell whether results have the bits of a whole run, beside their inputs and over them."""
    many = whole.shape[1]
    like = {q.shape: given[q.name] for q in program.inputs
            if isinstance(given.get(q.name), np.ndarray)}  # fmt: skip
    found = [np.full((len(q.components), many + 5), 77.0, whole.dtype) for q in program.outputs]
    by(program.name, constants, given, found, many)
    over = [like.get(q.shape, own) for q, own in zip(program.outputs, found, strict=True)]
    right = [_holds(found, whole)]
    if len({id(own) for own in over}) == len(over):
        by(program.name, constants, given, over, many)
        right.append(_holds(over, whole))
    return all(right)


def _holds(found: list[Any], whole: Any) -> bool:
    table, many = np.concatenate(found), whole.shape[1]
    own, right = (np.ascontiguousarray(a).view(np.uint8) for a in (table[:, :many], whole))
    return np.array_equal(own, right) and bool((table[:, many:] == 77.0).all())


def loops_of(source: str) -> dict[int, str]:
    """Return the lines of loops that are to become vectors, with their functions."""
    found, name = {}, ""
    for number, line in enumerate(source.splitlines(), 1):
        if head := re.match(r"void (\w+)\(", line):
            name = head[1]
        if line.strip() == "DERIVE_MEMBERS":
            found[number + 1] = name
    return found


def vectors_reported(folder: Path, file: str, compiler: str, options: tuple[str, ...]) -> set[int]:
    """Return the lines of loops that a compiler says it made vectors of."""
    report = {"gcc": "-fopt-info-vec-optimized", "clang": "-Rpass=loop-vectorize"}[compiler]
    command = (compiler, "-std=c99", *WARNINGS[:-1], *options, report, "-c", file, "-o", "o")
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    pattern = rf"{re.escape(file)}:(\d+):\d+: (?:optimized: loop vectorized|remark: vectorized)"
    return {int(n) for n in re.findall(pattern, done.stderr)}


def _written(made: Library, folder: Path) -> Iterator[tuple[Precision, str, str]]:
    folder.mkdir(exist_ok=True)
    texts = c_files(made, ()) | members_files(made, ())
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    for precision in PRECISIONS:
        file = f"{made.scene.name}_batch_{precision.name}.c"
        yield precision, file, texts[file]


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("scene", SCENES)
def test_the_compiler_reports_that_every_loop_became_vectors(
    scene: str, compiler: str, tmp_path: Path
) -> None:
    made = library_of(scene)
    for precision, file, text in _written(made, tmp_path):
        loops = loops_of(text)
        in_vectors = [p for p in made.printed() if is_in_vectors(p)]
        assert len(loops) == sum(len(members_of(made, p, precision)) for p in in_vectors)
        reported = vectors_reported(tmp_path, file, compiler, VECTOR_OPTIONS)
        assert [name for line, name in loops.items() if line not in reported] == []


@pytest.mark.long
@pytest.mark.parametrize("compiler", COMPILERS)
def test_the_report_tells_of_loops_that_are_none(compiler: str, tmp_path: Path) -> None:
    made = library_of("heavy_top")
    for _, file, text in _written(made, tmp_path):
        slow = re.sub(r"const (\w+) angle = ", r"volatile \1 angle = ", text)
        (tmp_path / file).write_text(slow, encoding="utf-8")
        at = {n for n, name in loops_of(text).items() if "energy" in name or "momentum" in name}
        assert vectors_reported(tmp_path, file, compiler, VECTOR_OPTIONS) & {*loops_of(text)} == at
