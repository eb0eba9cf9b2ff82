"""The best form known by hand, with everything that depends on parameters only in a set-up."""

from importlib.resources import files

from bench.candidate import Candidate, Source, sizes
from bench.problem import Problem

AUTHOR = "min"
TAKES = {
    "free_body": ("given->x", "given->x + 3", "r->y"),
    "free_body_principal": ("given->x", "given->x + 3", "r->y"),
    "heavy_top": ("given->x", "r->y"),
    "gyrostat": ("given->x", "given->x + 9", "given->x + 12", "r->y"),
    "rigid_body": ("given->x", "given->x + 13", "given->x + 16", "r->y"),
    "rigid_body_jacobian": ("given->x", "given->x + 13", "given->x + 16", "r->y", "r->y + 13"),
}
DENSE = {"rigid_body_jacobian_dense": "rigid_body_jacobian"}
"""Whole matrices, and the file that has them where DENSE is defined."""
PARTS = {"rigid_body": ("attitude_rate", "velocity_rate", "spin_rate")}
ROTATION = {"rigid_body": "unit"}
GLUE = """\
#include <string.h>
#include "{name}.h"
{sizes}
typedef struct {{ constants k; double x[INPUTS]; }} arguments;
typedef struct {{ double y[OUTPUTS]; }} results;

static void load(const double *p, const double *x, arguments *given)
{{
    setup(p, &given->k);
    memcpy(given->x, x, sizeof given->x);
}}

static void store(const results *r, double *y) {{ memcpy(y, r->y, sizeof r->y); }}

static inline void call(const arguments *given, results *r)
{{
    evaluate(&given->k, {passed});
}}
"""


def text(name: str) -> str:
    """Return a file of the folder ``minimum``."""
    return (files("bench") / "minimum" / name).read_text(encoding="utf-8")


def candidate(problem: Problem) -> Candidate:
    """Return the hand-written function of a problem."""
    name = DENSE.get(problem.name, problem.name)
    macros = ("DENSE",) if problem.name in DENSE else ()
    sources = (
        Source(f"{name}.c", text(f"{name}.c")),
        Source(f"{name}.h", text(f"{name}.h")),
        Source("inverse.h", text("inverse.h")),
    )
    glue = GLUE.format(name=name, sizes=sizes(problem), passed=", ".join(TAKES[name]))
    counted = (f"{name}.c", ("evaluate", *PARTS.get(name, ())))
    rotation = ROTATION.get(name, "homogeneous")
    return Candidate(AUTHOR, problem, sources, glue, counted, rotation, macros)
