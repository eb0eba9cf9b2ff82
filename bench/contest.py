"""The contest: every author's candidate for every problem, counted, timed and checked alike."""

import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from bench import handwritten, own
from bench.accuracy import Accuracy, accuracy
from bench.build import O2, O3_CONTRACTED, O3_NATIVE, BuildError, answers, build
from bench.callgrind import instructions
from bench.candidate import SAMPLES, Argument, Candidate, Source, pointer_glue
from bench.flops import Flops, count
from bench.peers import casadi, kane, symforce
from bench.problem import FREE_BODY, HEAVY_TOP, PROBLEMS, Problem
from bench.sample import SETS, samples
from bench.truth import truth

COLUMNS = (O2, O3_NATIVE, O3_CONTRACTED)


@dataclass(frozen=True)
class Author:
    """Who answers which problems."""

    name: str
    answer: Callable[[Problem], Candidate]
    problems: tuple[Problem, ...] = PROBLEMS


@dataclass(frozen=True)
class Entry:
    """What was found for one author and problem; ``missing`` says why something was not run."""

    author: str
    problem: str
    flops: Flops | None
    instructions: dict[str, float]
    accuracy: dict[str, Accuracy]
    missing: str = ""


def authors(generated: Path) -> tuple[Author, ...]:
    """Return all authors, ours first; ours stands in the folder ``generated``."""
    return (
        Author(own.AUTHOR, partial(own.candidate, generated)),
        Author(handwritten.AUTHOR, handwritten.candidate),
        Author(kane.AUTHOR, kane.candidate),
        Author(kane.SIMPLIFIED, kane.simplified, (HEAVY_TOP,)),
        Author(symforce.AUTHOR, symforce.candidate),
        Author(casadi.AUTHOR, casadi.candidate),
    )


def contest(
    who: Sequence[Author], problems: Sequence[Problem], number: int, folder: Path
) -> Iterator[Entry]:
    """Yield the entry of every author for every problem.

    number : samples in each set, for the accuracy     folder : where programs are built
    """
    for problem in problems:
        for author in who:
            if problem in author.problems:
                yield entry(author, problem, number, folder / problem.name / author.name)


def entry(author: Author, problem: Problem, number: int, folder: Path) -> Entry:
    """Return one author's entry, with a sentence for what could not be run."""
    try:
        candidate = author.answer(problem)
    except (ImportError, FileNotFoundError, LookupError) as absent:
        return Entry(author.name, problem.name, None, {}, {}, f"not run: {absent}")
    flops = operations(candidate)
    try:
        programs = {c.name: build(candidate, c, folder / c.name) for c in COLUMNS}
        cost = _cost(problem, programs)
        errors = {kind: _accuracy(candidate, programs[O2.name], kind, number) for kind in SETS}
    except (BuildError, FileNotFoundError) as failed:
        return Entry(author.name, problem.name, flops, {}, {}, f"not run: {failed}")
    return Entry(author.name, problem.name, flops, cost, errors)


def operations(candidate: Candidate) -> Flops:
    """Return the operations in the text of a candidate."""
    name, functions = candidate.counted
    return count({s.name: s.text for s in candidate.sources}[name], functions)


def _cost(problem: Problem, programs: dict[str, Path]) -> dict[str, float]:
    if not shutil.which("valgrind"):
        return {}
    rows = samples(problem, SETS[0], SAMPLES)
    return {name: round(instructions(path, rows), 1) for name, path in programs.items()}


def _accuracy(candidate: Candidate, program: Path, kind: str, number: int) -> Accuracy:
    rows = samples(candidate.problem, kind, number)
    true = [truth(candidate.problem, row, candidate.rotation) for row in rows]
    return accuracy(candidate.problem, answers(program, rows, candidate.problem.width), true)


def overhead(folder: Path) -> float | None:
    """Return the instructions of the loop around a call, measured on a function that does nothing.

    None if there is no valgrind or no compiler.
    """
    declared = "void evaluate(const double *x, double *y);"
    body = "void evaluate(const double *x, double *y) { (void)x; (void)y; }"
    takes = [Argument("inputs", 0), Argument("outputs", 0)]
    glue = pointer_glue(FREE_BODY, f"{declared}\n", "evaluate", takes)
    empty = Candidate("loop", FREE_BODY, (Source("empty.c", body),), glue, ("empty.c", ()))
    try:
        found = _cost(FREE_BODY, {O2.name: build(empty, O2, folder / "loop")})
    except (BuildError, FileNotFoundError):
        return None
    return found.get(O2.name)
