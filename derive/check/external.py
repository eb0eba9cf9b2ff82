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
from derive.emit.c.external import external_name
from derive.library.library import Library
from derive.verify.sample import Sample

STEPS = 3
PARTS = ("values", *["Jacobian"] * 3, *["Hessian"] * 3)
"""Derivatives are by states and inputs, by the length of the step, by parameters: each apart."""
CLOSE = 1e-13
"""Of the largest entry: some hundreds of roundings of 1e-16, by which two ways may differ."""
HorizonInputs = tuple[
    NDArray[np.float64], NDArray[np.float64], float, NDArray[np.float64], NDArray[np.float64]
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
    parts = zip(
        PARTS,
        _parts(own, given := _given(module, made, [s for s in each if s.kind == "ordinary"])),
        _parts(of_module(module, STEPS), given),
        strict=True,
    )
    gaps, same, within = dict.fromkeys(PARTS, 0.0), True, True
    for name, ours, theirs in parts:
        gaps[name] = max(gaps[name], _apart(ours, theirs))
        same = same and ours.sparsity() == theirs.sparsity()
        within = within and ours.sparsity().is_subset(theirs.sparsity())
    says = ", ".join(f"{name} {gap:.1g}" for name, gap in gaps.items())
    outcome = JUDGED[within and max(gaps.values()) <= CLOSE]
    says += "; the same patterns" if same else "; fewer entries" if within else "; other patterns"
    return Verdict(scene, "steps", "f64", "CasADi's own derivatives", outcome, says)


def _apart(ours: Any, theirs: Any) -> float:
    """Return the largest difference over the largest entry; of what has none 0."""
    if theirs.numel() == 0:
        return 0.0
    largest = max(1e-300, float(ca.norm_inf(ca.vec(theirs))))
    gap = float(ca.norm_inf(ca.vec(ours - theirs))) / largest
    return gap if gap == gap else float("inf")


def built(scene: str, texts: Mapping[str, str], steps: int, at: tuple[Path, Compiler]) -> Path:
    """Return the library of so many steps, made with every warning an error."""
    folder, with_ = at
    lines = [f"#define STEPS {steps}", *(f'#include "{scene}_{e}.c"' for e in ("f64", "external"))]
    unit = f"{scene}_steps.c"
    own = {n: t for n, t in texts.items() if n.endswith((".c", ".h"))}
    return compiled(own | {unit: "\n".join(lines) + "\n"}, unit, folder, with_)


def of_module(module: ModuleType, steps: int) -> Any:
    """Return the steps of all columns by the module's Function, called in a loop."""
    x, u = (ca.MX.sym(n, len(c), steps) for n, c in (("x", module.STATES), ("u", module.INPUTS)))
    h, step = ca.MX.sym("time_step"), module.step()
    p = ca.MX.sym("parameters", step.size1_in("parameters"))
    columns = [step(x[:, k], u[:, k], h, p) for k in range(steps)]
    return ca.Function("twin", [x, u, h, p], [ca.horzcat(*columns)])


def _given(module: ModuleType, made: Library, each: Sequence[Sample]) -> HorizonInputs:
    """Return x, u, the length of the step, the parameters, and weights of the states after."""

    def columns(wanted: Sequence[str]) -> NDArray[np.float64]:
        rows = [[float(each[k % len(each)].values[n]) for k in range(STEPS)] for n in wanted]
        return np.array(rows, dtype=np.float64).reshape(len(wanted), STEPS)

    first, count = each[0].values, len(module.STATES)
    weights = np.array([[1 - 0.3 * i + 0.7 * k for k in range(STEPS)] for i in range(count)])
    own = np.array([[float(first[c])] for q in made.setup.inputs for c in q.components])
    h = float(first["time_step"])
    return columns(module.STATES), columns(module.INPUTS), h, own.reshape(-1, 1), weights


def _parts(function: Any, given: HorizonInputs) -> list[Any]:
    """Return values, the Jacobian, and the Hessian of the weighed sum, as ``PARTS`` has them."""
    weights = given[-1]
    values: list[Any] = [ca.DM(v) for v in given[:-1]]
    x, u, h, p = (ca.MX.sym("v", *v.shape) for v in values)
    xn, both = function(x, u, h, p), ca.veccat(x, u, h, p)
    first = ca.jacobian(ca.vec(xn), both)
    second = ca.hessian(ca.dot(weights, xn), both)[0]
    ends = [0, x.numel() + u.numel(), x.numel() + u.numel() + 1, both.numel()]
    own = ca.horzsplit(first, ends) + ca.horzsplit(second, ends)
    every = ca.Function("every", [x, u, h, p], [xn, *own])
    return list(every(*values))
