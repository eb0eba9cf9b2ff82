"""A step in loops is the same step: as exact, the same bits in C and numpy, and small."""

import ctypes
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derive.check.compiler import CompilerError, compiled, find_compiler
from derive.emit.c.signature import CNames, prototype
from derive.emit.c.sines import own_sines, takes_sines
from derive.emit.c.text import body
from derive.emit.templates import TEMPLATES
from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.compact import compact
from derive.motion.runge_kutta.system import System
from derive.program.arithmetic import working
from derive.program.precision import F32, F64, Precision
from derive.program.program import Program
from derive.program.run import run
from tests.made import thinned
from tests.motion.slopes import with_slopes
from tests.motion.systems import EVERY, Values, at, mpf, start, system, without_slopes
from tests.motion.test_step_jacobian import EXACTLY, rounding

TEXT_OF_CORTEX_M4F = 3 * 1024  # bytes, tables and rates included
KINDS = {"step": "step_rk4", "jacobian": "step_rk4_jacobian"}
CORTEX_M4F = (
    *("arm-none-eabi-gcc", "-std=c99", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16"),
    *("-mfloat-abi=hard", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Werror"),
)


def pair(name: str, kind: str) -> tuple[Program, Program]:
    """Return a step as it is fast, and in loops."""
    given = system(name) if kind == "jacobian" else without_slopes(system(name))
    fast = step(given, KINDS[kind])
    return fast, compact(given, fast)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", thinned(EVERY, 3))
def test_the_step_in_loops_is_the_same_step(name: str, kind: str) -> None:
    fast, small = pair(name, kind)
    found, expected = at(small, start(name)), at(fast, start(name))
    assert max(abs(a - b) for a, b in zip(found, expected, strict=True)) < EXACTLY


def test_derivatives_by_parameters_are_the_same_in_loops() -> None:
    given = system("principal")
    constants = ["one_over_I_xx", "one_over_I_yy", "one_over_I_zz"]
    sensitive = System(
        given.states, given.rate, with_slopes(given.rate, [*given.names, *constants])
    )
    fast = step(sensitive, "step_rk4_sensitivity")
    found, expected = at(compact(sensitive, fast), start("principal")), at(fast, start("principal"))
    assert max(abs(a - b) for a, b in zip(found, expected, strict=True)) < EXACTLY


def test_a_tangent_space_has_no_loops_yet() -> None:
    fast = step(system("principal"), "step_rk4_tangent")
    assert compact(system("principal"), fast) == fast


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("name", ["principal", "heavy_top"])
def test_rounding_in_loops_is_as_small(name: str, dtype: type) -> None:
    _, small = pair(name, "jacobian")
    assert rounding(small, start(name), dtype) <= 16  # as the unrolled step


def c_source(program: Program, precision: Precision) -> str:
    """Return a file with one function: the struct of constants, and the step in loops."""
    assert program.has_arrays
    kind, head = precision.scalar, prototype(program, CNames("body"), precision)
    fields = [c for q in program.inputs if q.role == "constants" for c in q.components]
    lines = "\n".join(f"    {line}" for line in body(program, "f", precision))
    struct = " ".join(f"{kind} {field};" for field in fields)
    typedef = f"typedef struct {{ {struct} }} body_constants_{precision.name};"
    contraction_off = TEMPLATES.get_template("contraction_off.c.jinja").render()
    sines = own_sines("f", precision) if takes_sines(program) else ""
    before = f"{contraction_off}#include <math.h>\n{sines}\n{typedef}\n"
    return f"{before}{head};\n{head}\n{{\n{lines}\n}}\n"


def called(library: Path, program: Program, values: dict[str, Any], precision: Precision) -> Any:
    """Return what the compiled function returns, its states stored over those it is given."""
    scalar = ctypes.c_float if precision is F32 else ctypes.c_double
    memory = {
        q.name: (scalar * len(q.components))(*(values[c] for c in q.components))
        for q in program.inputs
    }
    memory |= {
        q.name: memory.get(q.name.removesuffix("_next")) or (scalar * len(q.components))()
        for q in program.outputs
    }
    given = [memory[q.name] if q.shape else scalar(memory[q.name][0]) for q in program.inputs]
    taken = [memory[q.name] for q in program.outputs]
    getattr(ctypes.CDLL(str(library)), f"body_{program.name}_{precision.name}")(*given, *taken)
    return [float(x) for array in taken for x in array]


def floats(values: Values, precision: Precision) -> dict[str, Any]:
    """Return values rounded to a precision."""
    return {c: precision.dtype(float(v)) for c, v in values.items()}


@pytest.mark.parametrize("precision", [F32, F64], ids=lambda p: p.name)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", thinned(["principal", "rigid_body"], 2))
def test_c_gives_the_bits_of_numpy_also_over_its_inputs(
    name: str, kind: str, precision: Precision, tmp_path: Path
) -> None:
    try:
        compiler = find_compiler()
    except CompilerError as error:
        pytest.skip(str(error))
    _, small = pair(name, kind)
    library = compiled({"body.c": c_source(small, precision)}, "body.c", tmp_path, compiler)
    for seed in (2, 3):
        values = floats(start(name, seed), precision)
        names = [c for q in small.inputs for c in q.components]
        want = run(small, working(precision.dtype), [values[c] for c in names])
        assert called(library, small, values, precision) == [float(x) for x in want]


def text_bytes(source: str, folder: Path, optimised: str) -> int:
    """Return the bytes of code and tables of a file for a Cortex-M4F."""
    (folder / "body.c").write_text(source, encoding="utf-8")
    made = (*CORTEX_M4F, optimised, "-c", "body.c", "-o", "body.o")
    subprocess.run(made, cwd=folder, check=True)
    size = subprocess.run(
        ("arm-none-eabi-size", "body.o"), cwd=folder, check=True, capture_output=True, text=True
    )
    found = re.search(r"^\s*(\d+)", size.stdout.splitlines()[1])
    assert found
    return int(found[1])


@pytest.mark.target
@pytest.mark.parametrize("optimised", ["-Os", "-O2"])
def test_thirteen_states_with_sensitivities_take_at_most_three_kilobytes(
    optimised: str, tmp_path: Path
) -> None:
    if shutil.which(CORTEX_M4F[0]) is None:
        pytest.skip("no cross compiler")
    _, small = pair("rigid_body", "jacobian")
    assert text_bytes(c_source(small, F32), tmp_path, optimised) <= TEXT_OF_CORTEX_M4F


@pytest.mark.parametrize("name", thinned(EVERY, 3))
def test_what_is_run_is_counted(name: str) -> None:
    _, small = pair(name, "jacobian")
    counted = dict.fromkeys(small.count, 0)
    table = dict(working(np.float64))

    def counting(operator: str, counted: dict[str, int] = counted, table: Any = table) -> Any:
        def operate(*given: Any) -> Any:
            counted[operator] += 1
            return table[operator](*given)

        return operate

    values = [float(mpf(start(name)[c])) for q in small.inputs for c in q.components]
    assert run(small, table | {o: counting(o) for o in counted}, values)
    assert counted == small.count
