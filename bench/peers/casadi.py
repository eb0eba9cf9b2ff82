"""CasADi: vector equations in SX, common subexpressions shared, C by its own generator.

The Jacobian is CasADi's own, sparse; ``Function.generate`` prints the file.
"""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.candidate import LOAD, STORE, Candidate, Source, sizes
from bench.problem import Problem

AUTHOR = "CasADi"
Equations = Callable[[list[Any], list[Any]], list[Any]]
GLUE = """\
#include <string.h>
#include "candidate.h"
{sizes}
typedef struct {{ double p[PARAMETERS], x[INPUTS]; const double *arg[2]; }} arguments;
typedef struct {{ double y[OUTPUTS]; double *res[2]; }} results;
{load}{store}
static inline void call(arguments *given, results *r)
{{
    given->arg[0] = given->p;
    given->arg[1] = given->x;
    r->res[0] = r->y;
    r->res[1] = r->y + {outputs};
    candidate(given->arg, r->res, 0, 0, 0);
}}
"""


def candidate(problem: Problem, equations: Equations | None = None) -> Candidate:
    """Return CasADi's answer to a problem. Raises ImportError where it is not installed.

    equations : of the problem, from (parameters, inputs); ``EQUATIONS`` has them if None
    """
    import casadi as ca

    stated = equations or EQUATIONS[problem.scene]

    p = ca.SX.sym("p", len(problem.parameters))
    x = ca.SX.sym("x", len(problem.inputs))
    rate: Any = ca.vertcat(*stated(ca.vertsplit(p), ca.vertsplit(x)))
    results = [rate]
    if problem.pattern:
        jacobian = ca.jacobian(rate, x)
        whole = len(problem.pattern) == jacobian.numel()
        results.append(ca.densify(jacobian) if whole else jacobian)
    sources = _files(ca.Function("candidate", [p, x], ca.cse(results)))
    glue = GLUE.format(sizes=sizes(problem), load=LOAD, store=STORE, outputs=len(problem.outputs))
    counted = ("candidate.c", ("casadi_f0",))
    return Candidate(AUTHOR, problem, sources, glue, counted, "unit")


def _files(function: Any) -> tuple[Source, ...]:
    import casadi as ca

    with TemporaryDirectory() as folder:
        generator = ca.CodeGenerator("candidate.c", {"with_header": True})
        generator.add(function)
        generator.generate(f"{folder}/")
        made = [Path(folder) / name for name in ("candidate.c", "candidate.h")]
        return tuple(Source(path.name, path.read_text(encoding="utf-8")) for path in made)


def _tensor(p: list[Any]) -> Any:
    import casadi as ca

    xx, yy, zz, xy, xz, yz = p
    return ca.blockcat([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]])


def _spin_rate(inertia: Any, w: Any, moment: Any) -> Any:
    import casadi as ca

    return ca.solve(inertia, moment - ca.cross(w, inertia @ w))


def _column(entries: list[Any]) -> Any:
    import casadi as ca

    return ca.vertcat(*entries)


def _free_body(p: list[Any], x: list[Any]) -> list[Any]:
    return [_spin_rate(_tensor(p), _column(x[:3]), _column(x[3:6]))]


def _principal(p: list[Any], x: list[Any]) -> list[Any]:
    import casadi as ca

    return [_spin_rate(ca.diag(_column(p)), _column(x[:3]), _column(x[3:6]))]


def _heavy_top(p: list[Any], x: list[Any]) -> list[Any]:
    import casadi as ca

    A, C, m, g, length = p
    inertia, w = ca.diag(_column([A, A, C])), _column(x[3:6])
    precession = w[1] / ca.sin(x[1])
    axes = ca.vertcat(w[0], w[1], precession * ca.cos(x[1]))
    moment = ca.vertcat(m * g * length * ca.sin(x[1]), 0, 0)
    rates = ca.solve(inertia, moment - ca.cross(axes, inertia @ w))
    return [precession, w[0], w[2] - axes[2], rates]


def _gyrostat(p: list[Any], x: list[Any]) -> list[Any]:
    import casadi as ca

    inertia, axial = _tensor(p[:6]), _column(p[6:9])
    w, s, moment, torque = (_column(x[start : start + 3]) for start in (3, 6, 9, 12))
    momentum = inertia @ w + axial * s
    rates = ca.solve(inertia - ca.diag(axial), moment - torque - ca.cross(w, momentum))
    across = ca.sin(x[0]) * w[1] + ca.cos(x[0]) * w[2]
    turning = [
        w[0] + across * ca.tan(x[1]),
        ca.cos(x[0]) * w[1] - ca.sin(x[0]) * w[2],
        across / ca.cos(x[1]),
    ]
    return [*turning, rates, torque / axial - rates]


def _rigid_body(p: list[Any], x: list[Any]) -> list[Any]:
    import casadi as ca

    q_w, q_v = x[3], _column(x[4:7])
    v, w, force, moment = (_column(x[start : start + 3]) for start in (7, 10, 13, 16))
    turned = force + 2 * ca.cross(q_v, ca.cross(q_v, force) + q_w * force)
    vector = (q_w * w + ca.cross(q_v, w)) / 2
    return [v, -ca.dot(q_v, w) / 2, vector, turned / p[0], _spin_rate(_tensor(p[1:]), w, moment)]


EQUATIONS: dict[str, Equations] = {
    "free_body": _free_body,
    "free_body_principal": _principal,
    "heavy_top": _heavy_top,
    "gyrostat": _gyrostat,
    "rigid_body": _rigid_body,
}
