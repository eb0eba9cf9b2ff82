"""The compiled steps that CasADi calls, beside its own derivatives of the module's step.

Two of CasADi's ways meet here: what the C states of itself, and SX differentiated twice. They
share the numbers of the step and none of the derivatives.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from derive.check.compiler import Compiler, compiled
from derive.check.emitted import Files
from derive.check.verdict import JUDGED, Verdict
from derive.emit.c.external import external_name, input_components
from derive.library.external import STEP
from derive.library.library import Library
from derive.verify.sample import Sample

STEPS = 3
PARTS = ("values", "Jacobian", "Hessian")
CLOSE = 1e-13
"""Of the largest entry: some hundreds of roundings of 1e-16, by which two ways may differ."""
HorizonInputs = tuple[
    NDArray[np.float64], NDArray[np.float64], float, list[float], NDArray[np.float64]
]


def compiled_steps(
    made: Library,
    found: Files,
    module: ModuleType,
    each: Sequence[Sample],
    at: tuple[Path, Compiler],
) -> Verdict:
    """Return whether values, Jacobian and Hessian of the C are CasADi's, and their patterns."""
    scene = made.scene.name
    library = built(scene, found.texts, STEPS, at)
    own = ca.external(external_name(scene), str(library))
    twin = of_module(made, module, STEPS)
    given = _given(made, [s for s in each if s.kind == "ordinary"])
    gaps, same = dict[str, float](), True
    for name, ours, theirs in zip(PARTS, _parts(own, given), _parts(twin, given), strict=True):
        largest = max(1e-300, float(ca.norm_inf(ca.vec(theirs))))
        gap = float(ca.norm_inf(ca.vec(ours - theirs))) / largest
        gaps[name] = gap if gap == gap else float("inf")
        same = same and ours.sparsity() == theirs.sparsity()
    says = ", ".join(f"{name} {gap:.1g}" for name, gap in gaps.items())
    outcome = JUDGED[same and max(gaps.values()) <= CLOSE]
    says += "; the same patterns" if same else "; other patterns"
    return Verdict(scene, "steps", "f64", "CasADi's own derivatives", outcome, says)


def built(scene: str, texts: Mapping[str, str], steps: int, at: tuple[Path, Compiler]) -> Path:
    """Return the library of so many steps, made with every warning an error."""
    folder, with_ = at
    lines = [f"#define STEPS {steps}", *(f'#include "{scene}_{e}.c"' for e in ("f64", "external"))]
    unit = f"{scene}_steps.c"
    own = {n: t for n, t in texts.items() if n.endswith((".c", ".h"))}
    return compiled(own | {unit: "\n".join(lines) + "\n"}, unit, folder, with_)


def of_module(made: Library, module: ModuleType, steps: int) -> Any:
    """Return the steps of all columns by the module's Function, called in a loop."""
    states, inputs = made.vocabulary.states, input_components(made)
    names = [c for q in states for c in q.components]
    x, u = ca.MX.sym("x", len(names), steps), ca.MX.sym("u", len(inputs), steps)
    h, p = (
        ca.MX.sym("time_step"),
        ca.MX.sym("parameters", sum(len(q.components) for q in made.setup.inputs)),
    )
    function = getattr(module, STEP)()
    columns = []
    for k in range(steps):
        rows = {n: x[i, k] for i, n in enumerate(names)}
        rows |= {n: u[i, k] for i, n in enumerate(inputs)} | {"time_step": h}
        given = {
            q.name: ca.vertcat(*(rows[c] for c in q.components))
            for q in made[STEP].inputs
            if q.role != "constants"
        }
        if "parameters" in function.name_in():
            given["parameters"] = p
        found = function(**given)
        columns.append(ca.vertcat(*(found[n] for n in function.name_out())))
    return ca.Function("twin", [x, u, h, p], [ca.horzcat(*columns)])


def _given(made: Library, each: Sequence[Sample]) -> HorizonInputs:
    """Return x, u, the length of the step, the parameters, and weights of the states after."""
    names = [c for q in made.vocabulary.states for c in q.components]

    def columns(wanted: Sequence[str]) -> NDArray[np.float64]:
        rows = [[float(each[k % len(each)].values[n]) for k in range(STEPS)] for n in wanted]
        return np.array(rows, dtype=np.float64).reshape(len(wanted), STEPS)

    first = each[0].values
    parameters = [float(first[c]) for q in made.setup.inputs for c in q.components]
    weights = np.array([[1 - 0.3 * i + 0.7 * k for k in range(STEPS)] for i in range(len(names))])
    h = float(first["time_step"])
    return columns(names), columns(input_components(made)), h, parameters, weights


def _parts(function: Any, given: HorizonInputs) -> tuple[Any, ...]:
    """Return values, Jacobian and Hessian of the weighed sum, by x and u."""
    x_, u_, h, p, weights = given
    x, u = ca.MX.sym("x", *x_.shape), ca.MX.sym("u", *u_.shape)
    xn, both = function(x, u, h, p), ca.veccat(x, u)
    hessian = ca.hessian(ca.dot(weights, xn), both)[0]
    every = ca.Function("every", [x, u], [xn, ca.jacobian(ca.vec(xn), both), hessian])
    return tuple(every(x_, u_))
