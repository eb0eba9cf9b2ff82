"""A proof holds for every program as it is, and for none that differs in any operation."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from derive.check import proof
from derive.library.library import Library, library
from derive.program.arithmetic import working
from derive.program.program import Op, Program
from derive.program.run import run
from derive.scene import catalogue, parse_scene
from derive.scene.wanted import JACOBIAN
from derive.verify.prove import ProofError, lectured, prove
from tests.made import library_of, thinned

FLIPPED = {"add": "sub", "sub": "add", "mul": "div", "div": "mul", "sin": "cos", "cos": "sin"}


LARGE = (
    *("centrifuge_gondola", "gyrostat", "quadrotor", "rattleback"),
    *("reaction_wheel_satellite", "rigid_body"),
)
QUICK_FIRST = [
    pytest.param(name, marks=pytest.mark.long) if name.startswith(LARGE) or place % 3 else name
    for place, name in enumerate(catalogue())
]
"""Scenes whose mutants take a minute together are tried in the longer run."""
SMALL_SET_UPS = thinned(catalogue(), 8)


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_every_scene_of_the_catalogue_is_proved(name: str) -> None:
    made = library_of(name)
    assert proof(made).outcome == ("holds" if made.functions else "skipped")


def mutants_of(op: Op, unlike: str) -> Iterator[Op]:
    """Yield an operation flipped, without a term or factor, and with an operand exchanged."""
    if op.operator in FLIPPED:
        yield replace(op, operator=FLIPPED[op.operator])
    if op.operator == "neg":
        yield Op(op.result, "add", (op.operands[0], Fraction(0)))
    if len(op.operands) == 2:
        first, second = op.operands
        yield replace(op, operands=(first, Fraction(op.operator in ("mul", "div"))))
        yield replace(op, operands=(first, unlike if second != unlike else Fraction(7, 3)))
    if op.operator in ("sub", "div"):
        yield replace(op, operands=(op.operands[1], op.operands[0]))


def mutants(program: Program) -> Iterator[Program]:
    """Yield the program with each operation, and each result, changed in every way."""
    if not program.results:
        return
    unlike = program.inputs[-1].components[-1]
    for place, op in enumerate(program.ops):
        for other in mutants_of(op, unlike):
            if other != op and not same_value(op, other):
                yield replace(program, ops=(*program.ops[:place], other, *program.ops[place + 1 :]))
    for place, result in enumerate(program.results):
        other_result = unlike if result != unlike else Fraction(7, 3)
        changed = (*program.results[:place], other_result, *program.results[place + 1 :])
        yield replace(program, results=changed)


def same_value(op: Op, other: Op) -> bool:
    """Tell whether a mutant only says the same in other words."""
    products = op.operator in ("mul", "div") and other.operator in ("mul", "div")
    return products and op.operands[1] == 1 == other.operands[1]


@pytest.mark.parametrize("name", QUICK_FIRST)
def test_no_mutant_of_any_program_is_proved(name: str) -> None:
    made = library_of(name)
    survivors = [
        difference(program, mutant)
        for program in made.functions
        for mutant in mutants(program)
        if proved(alone(made, mutant)) and not agree(program, mutant)
    ]
    assert survivors == []


def alone(made: Library, program: Program) -> Library:
    """Return the library with one function only: the others need no second proof."""
    base = program.name.removesuffix(JACOBIAN)
    return replace(made, functions=(program,), problems={base: made.problems[base]})


@pytest.mark.long
@pytest.mark.parametrize("name", SMALL_SET_UPS)
def test_no_mutant_of_any_set_up_is_proved(name: str) -> None:
    made = library_of(name)
    made = replace(made, setup=lectured(made))  # what motions need is checked by their orders
    survivors = [
        difference(made.setup, mutant)
        for mutant in mutants(made.setup)
        if not scales(made.setup, mutant)
        and proved(replace(made, setup=mutant))
        and not agree(made.setup, mutant)
    ]
    assert survivors == []


def agree(program: Program, mutant: Program) -> bool:
    """Tell whether a mutant is none: it has the same results, as (a - b)^2 and (b - a)^2 have.

    Sums of 53 bits differ by a few parts in 10^16, mutants in the first digits.
    """
    dice = np.random.default_rng(0)
    count = sum(len(quantity.components) for quantity in program.inputs)
    for _ in range(3):
        values = list(dice.uniform(0.5, 1.5, count))
        one, other = (run(p, working(np.float64), values) for p in (program, mutant))
        if not np.allclose(one, other, rtol=1e-9, atol=0):
            return False
    return True


def scales(setup: Program, mutant: Program) -> bool:
    """Tell whether a mutant only changes the power of two that a tensor is scaled by."""
    powers = {op.result for op in setup.ops if op.operator == "power_of_two"}
    before = {r for op in setup.ops for r in op.operands if op.result in powers}
    changed = [new.result for old, new in zip(setup.ops, mutant.ops, strict=True) if old != new]
    return bool(changed) and above(setup, before) >= set(changed) | before - powers


def above(setup: Program, names: set[object]) -> set[object]:
    """Return all results that only serve to make ``names``."""
    users: dict[object, set[object]] = {}
    for op in setup.ops:
        for operand in op.operands:
            users.setdefault(operand, set()).add(op.result)
    found = {n for n in names if isinstance(n, str)}
    for op in reversed(setup.ops):
        if users.get(op.result) and users[op.result] <= found:
            found.add(op.result)
    return found


def proved(made: Library) -> bool:
    try:
        prove(made)
    except (ProofError, ZeroDivisionError):
        return False
    return True


def difference(program: Program, mutant: Program) -> tuple[str, object]:
    pairs = zip(program.ops, mutant.ops, strict=True)
    return program.name, next((pair for pair in pairs if pair[0] != pair[1]), mutant.results)


def test_a_fault_is_one_sentence_with_scene_function_step_and_gap() -> None:
    made = library_of("free_body_principal")
    program = made["moment"]
    broken = replace(program, results=(Fraction(0), *program.results[1:]))
    functions = tuple(broken if f.name == "moment" else f for f in made.functions)
    with pytest.raises(ProofError) as caught:
        prove(replace(made, functions=functions))
    words = ("'free_body_principal'", "'moment'", "'general_form'", "'moment_x'", "off by")
    assert all(word in str(caught.value) for word in words)
    assert "\n" not in str(caught.value)


def test_an_entry_missing_from_a_pattern_is_a_fault() -> None:
    made = library_of("heavy_top")
    program = made["state_rate_jacobian"]
    pattern = (program.sparsity or {})["jacobian"]
    last = pattern.colind[-1] - 1
    column = next(k for k in range(len(pattern.columns)) if pattern.colind[k + 1] > last)
    colind = tuple(min(n, last) for n in pattern.colind)
    shorter = replace(pattern, colind=colind, row=pattern.row[:-1])
    outputs = (
        *program.outputs[:-1],
        replace(program.outputs[-1], components=tuple(program.outputs[-1].components[:-1])),
    )
    broken = replace(
        program, sparsity={"jacobian": shorter}, outputs=outputs, results=program.results[:-1]
    )
    functions = tuple(broken if f is program else f for f in made.functions)
    with pytest.raises(ProofError, match=pattern.columns[column]):
        prove(replace(made, functions=functions))


PYRAMID = """
title  = "Carrier with one wheel on a slanted axis"
wanted = ["acceleration", "acceleration_jacobian", "kinetic_energy"]

[parameters]
A = { unit = "kg m^2", range = [1, 2], meaning = "transverse moment" }
B = { unit = "kg m^2", range = [1, 2], meaning = "moment about y" }
C = { unit = "kg m^2", range = [1, 2], meaning = "moment about z" }
D = { unit = "kg m^2", range = [0.01, 0.02], meaning = "axial moment of the wheel" }

[body]
kind    = "principal"
moments = ["A", "B", "C"]

[[wheels]]
name         = "1"
axis         = ["1/sqrt(3)", "1/sqrt(3)", "1/sqrt(3)"]
axial        = "D"
speed_range  = [-300, 300]
torque_range = [-0.2, 0.2]
"""


@pytest.mark.long
def test_a_scene_with_roots_is_proved_in_narrow_balls() -> None:
    made = library(parse_scene(PYRAMID, "pyramid"))
    prove(made)
    program = made["acceleration"]
    broken = replace(program, results=tuple(reversed(program.results)))
    functions = tuple(broken if f is program else f for f in made.functions)
    assert not proved(replace(made, functions=functions))
