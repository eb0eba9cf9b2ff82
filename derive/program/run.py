"""A program run in an arithmetic: floats, exact fractions, balls, CasADi."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from derive.program.indexed import Assign, Even, Integers, Loop, Row, value_at
from derive.program.program import Line, Op, Operand, Program, component_names
from derive.scene.formula import Arithmetic

NOWHERE: Mapping[str, int] = MappingProxyType({})


def run(program: Program, arithmetic: Arithmetic, values: Sequence[Any]) -> list[Any]:
    """Run ``program`` in an arithmetic: floats, exact fractions, intervals, CasADi.

    ``values`` are the input components in declared order. The arithmetic maps each operator,
    and "number" for constants, to a callable; loops need its "select" and "either".
    """
    names = [name for quantity in program.inputs for name in quantity.components]
    with np.errstate(all="ignore"):  # an overflow is seen in the results, as it is in C
        known = dict(zip(names, values, strict=True)) | numbers_of(program, arithmetic)
        run_lines(program.ops, arithmetic, known)
        return values_of(program.results, arithmetic, known)


def results_by_name(
    program: Program, arithmetic: Arithmetic, known: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the results of ``program`` by component, from values known by name."""
    given = [known[c] for q in program.inputs for c in q.components]
    return dict(zip(component_names(program), run(program, arithmetic, given), strict=True))


def numbers_of(program: Program, arithmetic: Arithmetic) -> dict[str, Any]:
    """Return the numbers of a program that rest on the precision of the arithmetic, by name."""
    if not program.numbers:
        return {}
    unit = arithmetic["unit_roundoff"]()
    bits = 24 if float(unit[0] if isinstance(unit, tuple) else unit) == 2.0**-24 else 53
    return {name: arithmetic["number"](q[bits]) for name, q in program.numbers.items()}


def values_of(
    operands: Sequence[Operand], arithmetic: Arithmetic, known: Mapping[str, Any]
) -> list[Any]:
    """Return the values of operands: known by name, or exact numbers."""
    return [known[o] if isinstance(o, str) else arithmetic["number"](o) for o in operands]


def run_lines(
    lines: Sequence[Line],
    arithmetic: Arithmetic,
    known: dict[str, Any],
    at: Mapping[str, int] = NOWHERE,
) -> None:
    """Add the values that operations and loops give to what is known by name.

    at : the counters of the loops that the lines stand in
    """
    for line in lines:
        match line:
            case Op():
                operands = values_of(line.operands, arithmetic, known)
                known[line.result] = arithmetic[line.operator](*operands)
            case Integers():
                known[line.name] = line.values
            case Row():
                for k, value in enumerate(values_of(line.values, arithmetic, known)):
                    known[f"{line.name}[{k}]"] = value
            case Assign():
                name = line.target if isinstance(line.target, str) else line.target.at(at, known)
                found = value_at(line.value, arithmetic, known, at)
                known[name] = arithmetic[line.adds](known[name], found) if line.adds else found
            case Even():
                for turn in line.turns(at, known):
                    run_lines(line.body, arithmetic, known, {**at, **turn})
            case Loop():
                _run_loop(line, arithmetic, known, at)


def _run_loop(
    loop: Loop, arithmetic: Arithmetic, known: dict[str, Any], at: Mapping[str, int]
) -> None:
    known.update(zip(loop.carried, values_of(loop.start, arithmetic, known), strict=True))
    done: Any = None
    for turn in loop.turns(at, known):
        run_lines(loop.body, arithmetic, known, {**at, **turn})
        new = values_of(loop.then, arithmetic, known)
        if done is not None:
            old = [known[name] for name in loop.carried]
            new = [arithmetic["select"](done, o, n) for o, n in zip(old, new, strict=True)]
        known.update(zip(loop.carried, new, strict=True))
        if loop.done is not None:
            (now,) = values_of((loop.done,), arithmetic, known)
            done = now if done is None else arithmetic["either"](done, now)
