"""A Taylor step is the same to the last bit in numpy, C and CasADi."""

import ctypes
from pathlib import Path
from random import Random
from typing import Any

import casadi as ca
import numpy as np
import pytest

from derive.check.compiler import CompilerError, compiled, find_compiler
from derive.emit.c.signature import CNames, prototype
from derive.emit.c.sines import own_sines, takes_sines
from derive.emit.c.text import float_body
from derive.emit.casadi_text import plain_lines
from derive.emit.templates import TEMPLATES
from derive.motion.taylor.series import TaylorStep, in_loops
from derive.program.arithmetic import working
from derive.program.precision import F32, F64, Precision
from tests.made import thinned
from tests.motion.solution import (
    handmade,
    run_series,
)


def c_source(step: TaylorStep, precision: Precision) -> str:
    head = prototype(in_loops(step), CNames("body"), precision)
    lines = "\n".join(f"    {line}" for line in float_body(in_loops(step), "f", precision))
    contraction_off = TEMPLATES.get_template("contraction_off.c.jinja").render()
    sines = own_sines("f", precision) if takes_sines(in_loops(step)) else ""
    return f"{contraction_off}#include <math.h>\n{sines}\n{head};\n{head}\n{{\n{lines}\n}}\n"


def samples(count: int, dtype: type) -> list[list[Any]]:
    dice = Random("taylor")
    return [[dtype(dice.uniform(0.5, 1.5)) for _ in range(count)] for _ in range(20)]


@pytest.mark.parametrize("name", thinned(["everything", "free", "top"], 3))
@pytest.mark.parametrize("precision", [F32, F64], ids=lambda p: p.name)
def test_c_gives_the_bits_of_numpy_also_over_its_inputs(
    name: str, precision: Precision, tmp_path: Path
) -> None:
    try:
        compiler = find_compiler()
    except CompilerError as error:
        pytest.skip(str(error))
    step, _, values = handmade(name)
    made = compiled({"body.c": c_source(step, precision)}, "body.c", tmp_path, compiler)
    function = getattr(ctypes.CDLL(str(made)), f"body_step_taylor_{precision.name}")
    scalar = ctypes.c_float if precision is F32 else ctypes.c_double
    for state in samples(len(values), precision.dtype):
        h = precision.dtype(0.125)
        want = [
            float(x)
            for x in run_series(step, working(precision.dtype), [*state, h], precision.bits)
        ]
        given = [(scalar * len(q.components)) for q in step.inputs[:-1]]
        memory, place = [], 0
        for array in given:
            memory.append(array(*state[place : place + len(array())]))
            place += len(array())
        passed = [m if q.shape else m[0] for m, q in zip(memory, step.inputs, strict=False)]
        function.argtypes = None
        arguments = [p if q.shape else scalar(p) for p, q in zip(passed, step.inputs, strict=False)]
        proposed = scalar()
        function(*arguments, scalar(h), *memory, ctypes.byref(proposed))
        assert [float(x) for m in memory for x in m] + [proposed.value] == want


@pytest.mark.parametrize("name", ["free", "everything"])
def test_casadi_gives_the_bits_of_numpy_and_stays_small(name: str) -> None:
    step, _, values = handmade(name)
    before = ca.GlobalOptions.getSimplificationOnTheFly()
    ca.GlobalOptions.setSimplificationOnTheFly(False)
    try:
        known = {q.name: ca.SX.sym(q.name, len(q.components)) for q in step.inputs}
        inputs = list(known.values())
        space: dict[str, Any] = {"ca": ca, **known}
        program = in_loops(step)
        place = {c: f"{q.name}[{i}]" for q in step.inputs for i, c in enumerate(q.components)}
        lines, text = plain_lines(program, place)
        exec("\n".join(lines), space)  # noqa: S102
        results = [eval(text(r), space) for r in program.results]  # noqa: S307
        built = ca.Function("step", inputs, [ca.vertcat(*results)])
    finally:
        ca.GlobalOptions.setSimplificationOnTheFly(before)
    assert built.n_nodes() < 50_000
    for state in samples(len(values), np.float64):
        parts, place = [], 0
        for q in step.inputs[:-1]:
            parts.append(state[place : place + len(q.components)])
            place += len(q.components)
        found = np.array(built(*parts, 0.125)).ravel()
        want = run_series(step, working(np.float64), [*state, np.float64(0.125)], 53)
        assert [float(x) for x in found] == [float(x) for x in want]
