"""The C text that calls every function of a scene on numbers from its ranges."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from math import prod

from derive.emit.c.signature import CNames, dense, parameters
from derive.emit.operators import literal
from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Program, Quantity

CALLS = 100
PAINTED = 4
LEFT_BY_ROUNDING = (Fraction(-1, 10**8), Fraction(1, 10**8))
"""What rounding may have left of earlier steps."""


def all_of(library: Library) -> list[Program]:
    """Return what a scene's C has, in its order, the dense forms among them."""
    found: list[Program] = []
    for program in library.emitted():
        found += [program, dense(program)] if program.sparsity else [program]
    return found


def count_of(program: Program) -> int:
    """Return how many values a function returns a call, the status of set-up among them."""
    return sum(numbers_in(q) for q in program.outputs) + program.makes("constants")


def numbers_in(q: Quantity) -> int:
    """Return how many numbers a quantity has."""
    return len(q.components) or prod(q.shape)


def calling(library: Library, precision: Precision) -> dict[str, str]:
    """Return calls.h and calls.c of a scene."""
    names, every = CNames(library.scene.name), all_of(library)
    single = "#define SINGLE\n" if precision.name == "f32" else ""
    head = (
        f'#include "{names.file(precision, "h")}"\ntypedef {precision.scalar} scalar;\n{single}'
        f"#define ROUNDS {CALLS}\n#define PAINTED {PAINTED}\n#define FUNCTIONS {len(every)}\n"
    )
    lines = [f"static found all[{len(every)}];"]
    if library.constants:
        lines.append(f"static {names.scene}_constants_{precision.name} ready;")
    made = {q.name: numbers_in(q) for p in every for q in p.outputs if q.role != "constants"}
    passed_on = {q.name: made[q.name] for p in every for q in p.inputs if _passed_on(q, made)}
    lines += [f"static scalar last_{name}[{n}];" for name, n in passed_on.items()]
    for place, program in enumerate(every):
        lines += _caller(place, program, names, precision, set(passed_on))
    calls = "".join(f"    call_{place}(round);\n" for place in range(len(every)))
    lines.append(f"static void calls(int round)\n{{\n{calls}}}")
    return {"calls.h": head, "calls.c": "\n".join(lines) + "\n"}


def _passed_on(q: Quantity, made: dict[str, int]) -> bool:
    """Tell whether an input is what another function returns: nobody has a range for it."""
    return q.low is None and q.role == "plan" and made.get(q.name) == numbers_in(q)


def _caller(
    place: int, program: Program, names: CNames, precision: Precision, passed_on: set[str]
) -> Iterator[str]:
    result = "int" if program.makes("constants") else "void"
    arguments = ", ".join(parameters(program, names.scene, precision)) or "void"
    empty, symbol = f"empty_{place}", names.symbol(program.name, precision)
    yield f"EMPTY {result} {empty}({arguments})"
    yield '{\n    __asm__ volatile("");' + ("\n    return 0;" if result == "int" else "") + "\n}"
    yield f"static void call_{place}(int round)\n{{"
    yield f"    {result} (*const pick[2])({arguments}) = {{{empty}, {symbol}}};"
    for q in (*program.inputs, *program.outputs):
        if q.role != "constants":
            yield f"    scalar own_{q.name}[{numbers_in(q)}];"
    for q in program.inputs:
        if q.role != "constants":
            yield f"    {_drawn(q, precision, passed_on)}"
    passed = ", ".join(["", *_passed(program)])
    yield f"    CALL(&all[{place}], round, pick{passed});"
    if result == "int":
        yield f"    const scalar status = (scalar){symbol}({', '.join(_passed(program))});"
        yield f"    take(&all[{place}], &status, 1);"
    for q in program.outputs:
        at = "(const scalar *)&ready" if q.role == "constants" else f"own_{q.name}"
        yield f"    take(&all[{place}], {at}, {numbers_in(q)});"
        if q.name in passed_on:
            yield f"    memcpy(last_{q.name}, own_{q.name}, sizeof own_{q.name});"
    yield "}"


def _passed(program: Program) -> Iterator[str]:
    outputs = {q.name for q in program.outputs}
    for q in (*program.inputs, *program.outputs):
        if q.role == "constants":
            yield "&ready"
        else:
            yield f"own_{q.name}" if q.shape or q.name in outputs else f"own_{q.name}[0]"


def _drawn(q: Quantity, precision: Precision, passed_on: set[str]) -> str:
    if q.name in passed_on and q.low is None:
        return f"memcpy(own_{q.name}, last_{q.name}, sizeof own_{q.name});"
    if q.is_quaternion:
        return f"attitude(own_{q.name});"
    if q.low is None or q.high is None:
        q = replace(q, low=LEFT_BY_ROUNDING[0], high=LEFT_BY_ROUNDING[1])
    low, high = (literal(end, precision) for end in q.ends)
    ranges = ", ".join([f"{{{low}, {high}}}"] * numbers_in(q))
    return (
        f"static const scalar range_{q.name}[{numbers_in(q)}][2] = {{{ranges}}};\n"
        f"    draw(own_{q.name}, range_{q.name}, {numbers_in(q)});"
    )
