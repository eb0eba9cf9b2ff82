"""A candidate: one tool's code for one problem, and the glue by which the driver calls it."""

from collections.abc import Sequence
from dataclasses import dataclass

from bench.problem import Problem

SAMPLES = 16


@dataclass(frozen=True)
class Source:
    """One file of a candidate; headers are written beside the units that are compiled."""

    name: str
    text: str


@dataclass(frozen=True)
class Candidate:
    """What a tool answers to a problem.

    sources : its files, as it wrote them      glue : text of glue.h, ours
    counted : (file, functions) whose operations are counted
    rotation : how its R depends on q away from unit length, "unit" or "homogeneous"
    macros : names defined when its files are compiled     folders : include folders it needs
    """

    author: str
    problem: Problem
    sources: tuple[Source, ...]
    glue: str
    counted: tuple[str, tuple[str, ...]]
    rotation: str = "homogeneous"
    macros: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()


@dataclass(frozen=True)
class Argument:
    """A pointer that the function takes: into the parameters, the inputs or the outputs."""

    role: str
    start: int


def sizes(problem: Problem) -> str:
    """Return the lines of glue.h that give the sizes of a problem."""
    return (
        f"#define PARAMETERS {len(problem.parameters)}\n#define INPUTS {len(problem.inputs)}\n"
        f"#define OUTPUTS {problem.width}\n#define SAMPLES {SAMPLES}\n"
    )


LOAD = """\
static void load(const double *p, const double *x, arguments *given)
{
    memcpy(given->p, p, sizeof given->p);
    memcpy(given->x, x, sizeof given->x);
}
"""

STORE = """\
static void store(const results *r, double *y) { memcpy(y, r->y, sizeof r->y); }
"""


def pointer_glue(problem: Problem, prologue: str, name: str, takes: Sequence[Argument]) -> str:
    """Return glue.h for a function whose arguments are all pointers to doubles."""
    roots = {"parameters": "given->p", "inputs": "given->x", "outputs": "r->y"}
    passed = ", ".join(f"&{roots[a.role]}[{a.start}]" for a in takes)
    return (
        f"#include <string.h>\n{prologue}{sizes(problem)}"
        "typedef struct { double p[PARAMETERS], x[INPUTS]; } arguments;\n"
        "typedef struct { double y[OUTPUTS]; } results;\n"
        f"{LOAD}{STORE}"
        f"static inline void call(arguments *given, results *r) {{ {name}({passed}); }}\n"
    )
