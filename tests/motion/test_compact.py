"""A step in loops is the same step: as exact, the same bits in C and numpy, and small."""

import ctypes
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derive.check.compiler import CompilerError, compiled, find_compiler
from derive.emit.c.signature import CNames, prototype
from derive.emit.c.sines import own_sines, takes_sines
from derive.emit.c.text import float_body
from derive.emit.templates import TEMPLATES
from derive.motion.runge_kutta import step
from derive.motion.runge_kutta.compact import compact
from derive.motion.runge_kutta.system import System
from derive.program.arithmetic import working
from derive.program.indexed import Assign, Element, Integers, Loop, Row
from derive.program.precision import F32, F64, Precision
from derive.program.program import Line, Op, Program
from derive.program.run import run
from tests.made import thinned
from tests.motion.slopes import with_slopes
from tests.motion.systems import EVERY, Values, at, mpf, start, system, without_slopes
from tests.motion.test_step_jacobian import EXACTLY, rounding

KINDS = {"step": "step_rk4", "jacobian": "step_rk4_jacobian", "tangent": "step_rk4_tangent"}


def pair(name: str, kind: str) -> tuple[Program, Program]:
    """Return a step as it is fast, and in loops."""
    given = system(name) if kind != "step" else without_slopes(system(name))
    fast = step(given, KINDS[kind])
    return fast, compact(given, fast)


def apart(small: Program, fast: Program, name: str) -> Any:
    """Return how far what a step in loops gives is from what the fast one does."""
    found, expected = at(small, start(name)), at(fast, start(name))
    return max(abs(a - b) for a, b in zip(found, expected, strict=True))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", thinned(EVERY, 3))
def test_the_step_in_loops_is_the_same_step(name: str, kind: str) -> None:
    if kind == "tangent" and system(name).quaternion is None:
        pytest.skip("no quaternion, no tangent space")
    fast, small = pair(name, kind)
    assert apart(small, fast, name) < EXACTLY


def test_states_that_stand_alone_go_back_without_a_loop() -> None:
    given = system("principal")
    each = [
        replace(q, name=c, components=(c,), shape=(), role="value")
        for q in given.states
        for c in q.components
    ]
    alone = replace(given, states=tuple(each))
    fast = step(alone, KINDS["jacobian"])
    assert apart(compact(alone, fast), fast, "principal") < EXACTLY


def mutants(lines: Sequence[Line]) -> Iterator[tuple[Line, ...]]:
    """Yield lines with one thing wrong: a sign, a weight, a place, where rows begin or go on."""
    for place, line in enumerate(lines):
        for other in _wrong(line):
            yield (*lines[:place], other, *lines[place + 1 :])


def _wrong(line: Line) -> Iterator[Line]:
    match line:
        case Op() if line.operator in ("add", "sub"):
            yield replace(line, operator={"add": "sub", "sub": "add"}[line.operator])
        case Row():
            yield replace(line, values=(*line.values[1:], line.values[0]))
        case Integers():
            yield replace(line, values=(*line.values[1:], line.values[0]))
        case Assign(value=Element()):
            *before, last = line.value.places
            more = replace(last, plus=last.plus - 1 if last.plus else 1)
            if not last.counter:
                yield replace(line, value=replace(line.value, places=(*before, more)))
        case Loop():
            yield from (replace(line, body=body) for body in mutants(line.body))
            if line.then:
                yield replace(line, then=(line.then[-1], *line.then[1:]))


@pytest.mark.long
@pytest.mark.parametrize("kind", ["jacobian", "tangent"])
def test_a_wrong_chain_rule_is_noticed(kind: str) -> None:
    fast, small = pair("principal", kind)
    every = [replace(small, ops=ops) for ops in mutants(small.ops)]
    kept = [k for k, wrong in enumerate(every) if apart(wrong, fast, "principal") < EXACTLY]
    assert len(every) > 100
    assert kept == []


def test_derivatives_by_parameters_are_the_same_in_loops() -> None:
    given = system("principal")
    constants = ["one_over_I_xx", "one_over_I_yy", "one_over_I_zz"]
    sensitive = System(
        given.states, given.rate, with_slopes(given.rate, [*given.names, *constants])
    )
    fast = step(sensitive, "step_rk4_sensitivity")
    found, expected = at(compact(sensitive, fast), start("principal")), at(fast, start("principal"))
    assert max(abs(a - b) for a, b in zip(found, expected, strict=True)) < EXACTLY


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("name", ["principal", "heavy_top"])
def test_rounding_in_loops_is_as_small(name: str, dtype: type) -> None:
    _, small = pair(name, "jacobian")
    assert rounding(small, start(name), dtype) <= 16  # as the unrolled step


def c_source(program: Program, precision: Precision) -> str:
    """Return a file with one function: the struct of constants, and the step in loops."""
    kind, head = precision.scalar, prototype(program, CNames("body"), precision)
    fields = [c for q in program.inputs if q.role == "constants" for c in q.components]
    lines = "\n".join(f"    {line}" for line in float_body(program, "f", precision))
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
