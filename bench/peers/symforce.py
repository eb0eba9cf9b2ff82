"""SymForce: vector equations written with its geometry types, C++ by its code generator.

The Eigen headers that the generated file includes are those that travel with CasADi.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.candidate import Candidate, Source, sizes
from bench.problem import Problem

AUTHOR = "SymForce"
Equations = Callable[[Any, list[Any], list[Any]], list[Any]]
GLUE = """\
#include <algorithm>
#include "candidate.h"
{sizes}
struct arguments {{
    Eigen::Matrix<double, PARAMETERS, 1> p;
    Eigen::Matrix<double, INPUTS, 1> x;
}};
struct results {{
    Eigen::Matrix<double, {outputs}, 1> rate;
{more}}};

static void load(const double *p, const double *x, arguments *given)
{{
    std::copy(p, p + PARAMETERS, given->p.data());
    std::copy(x, x + INPUTS, given->x.data());
}}

static void store(const results *r, double *y)
{{
    std::copy(r->rate.data(), r->rate.data() + {outputs}, y);
{stored}}}

static inline void call(const arguments *given, results *r)
{{
    {call};
}}
"""


def candidate(problem: Problem, equations: Equations | None = None) -> Candidate:
    """Return SymForce's answer to a problem. Raises ImportError where it is not installed.

    equations : of the problem, from (symforce, parameters, inputs); ``EQUATIONS`` has them if None
    """
    stated = equations or EQUATIONS[problem.scene]
    sf = _symbolic()
    from symforce.codegen import Codegen, CppConfig
    from symforce.values import Values

    p = sf.Matrix(len(problem.parameters), 1).symbolic("p")
    x = sf.Matrix(len(problem.inputs), 1).symbolic("x")
    outputs = Values(rate=sf.Matrix(stated(sf, list(p), list(x))))
    if problem.pattern:
        outputs["jacobian"] = _jacobian(sf, problem, outputs["rate"], x)
    generator = Codegen(
        inputs=Values(p=p, x=x),
        outputs=outputs,
        config=CppConfig(explicit_template_instantiation_types=["double"]),
        name="candidate",
        return_key=None if problem.pattern else "rate",
    )
    return _wrapped(problem, _files(generator))


@cache
def _symbolic() -> Any:
    """Return SymForce's symbols, with its epsilon set as it asks, once and before their import."""
    import symforce

    symforce.set_epsilon_to_symbol()
    from symforce import symbolic

    return symbolic


def _jacobian(sf: Any, problem: Problem, rate: Any, x: Any) -> Any:
    dense = rate.jacobian(x)
    places = [(problem.outputs.index(r), problem.inputs.index(c)) for r, c in problem.pattern]
    return sf.Matrix([dense[place] for place in places])


def _files(generator: Any) -> tuple[Source, ...]:
    with TemporaryDirectory() as folder:
        made = generator.generate_function(output_dir=folder).generated_files
        return tuple(Source(Path(p).name, Path(p).read_text(encoding="utf-8")) for p in made)


def _wrapped(problem: Problem, sources: tuple[Source, ...]) -> Candidate:
    import casadi

    count, nonzeros = len(problem.outputs), len(problem.pattern)
    jacobian = f"    Eigen::Matrix<double, {nonzeros}, 1> jacobian;\n"
    copied = f"r->jacobian.data(), r->jacobian.data() + {nonzeros}, y + {count}"
    glue = GLUE.format(
        sizes=sizes(problem),
        outputs=count,
        more=jacobian if nonzeros else "",
        stored=f"    std::copy({copied});\n" if nonzeros else "",
        call="sym::Candidate<double>(given->p, given->x, &r->rate, &r->jacobian)"
        if nonzeros
        else "r->rate = sym::Candidate<double>(given->p, given->x)",
    )
    eigen = str(Path(casadi.__file__).parent / "include" / "eigen3")
    counted = ("candidate.h", ("Candidate",))
    return Candidate(AUTHOR, problem, sources, glue, counted, "unit", folders=(eigen,))


def _tensor(sf: Any, p: list[Any]) -> Any:
    xx, yy, zz, xy, xz, yz = p
    return sf.M33([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]])


def _spin_rate(inertia: Any, w: Any, moment: Any) -> list[Any]:
    return list(inertia.inv() * (moment - w.cross(inertia * w)))


def _free_body(sf: Any, p: list[Any], x: list[Any]) -> list[Any]:
    return _spin_rate(_tensor(sf, p), sf.V3(*x[:3]), sf.V3(*x[3:6]))


def _principal(sf: Any, p: list[Any], x: list[Any]) -> list[Any]:
    return _spin_rate(sf.M33.diag(p), sf.V3(*x[:3]), sf.V3(*x[3:6]))


def _heavy_top(sf: Any, p: list[Any], x: list[Any]) -> list[Any]:
    A, C, m, g, length = p
    inertia, w = sf.M33.diag([A, A, C]), sf.V3(*x[3:6])
    precession = w[1] / sf.sin(x[1])
    axes = sf.V3(w[0], w[1], precession * sf.cos(x[1]))
    moment = sf.V3(m * g * length * sf.sin(x[1]), 0, 0)
    rates = inertia.inv() * (moment - axes.cross(inertia * w))
    return [precession, w[0], w[2] - axes[2], *rates]


def _gyrostat(sf: Any, p: list[Any], x: list[Any]) -> list[Any]:
    inertia, axial = _tensor(sf, p[:6]), p[6:9]
    w, s, moment, torque = (sf.V3(*x[start : start + 3]) for start in (3, 6, 9, 12))
    wheels = sf.M33.diag(axial)
    momentum = inertia * w + wheels * s
    rates = (inertia - wheels).inv() * (moment - torque - w.cross(momentum))
    wheel_rates = wheels.inv() * torque - rates
    across = sf.sin(x[0]) * w[1] + sf.cos(x[0]) * w[2]
    turning = [
        w[0] + across * sf.tan(x[1]),
        sf.cos(x[0]) * w[1] - sf.sin(x[0]) * w[2],
        across / sf.cos(x[1]),
    ]
    return [*turning, *rates, *wheel_rates]


def _rigid_body(sf: Any, p: list[Any], x: list[Any]) -> list[Any]:
    attitude = sf.Quaternion(xyz=sf.V3(*x[4:7]), w=x[3])
    v, w, force, moment = (sf.V3(*x[start : start + 3]) for start in (7, 10, 13, 16))
    turning = attitude * sf.Quaternion(xyz=w / 2, w=0)
    acceleration = sf.Rot3(attitude) * force / p[0]
    rates = _spin_rate(_tensor(sf, p[1:]), w, moment)
    return [*v, turning.w, turning.x, turning.y, turning.z, *acceleration, *rates]


EQUATIONS: dict[str, Equations] = {
    "free_body": _free_body,
    "free_body_principal": _principal,
    "heavy_top": _heavy_top,
    "gyrostat": _gyrostat,
    "rigid_body": _rigid_body,
}
