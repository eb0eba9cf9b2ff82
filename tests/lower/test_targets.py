"""The hot functions cost no more than the best hand-written forms known, and do nothing twice."""

import pytest

from derive.program.arithmetic import TRUTHS
from derive.program.indexed import Loop
from derive.program.program import Op, Program, every_op, read_by
from derive.scene import catalogue
from tests.made import library_of, scene_of, thinned

# Flops (+ - * /), divisions, calls of sin and cos of the best forms written by hand.
TARGETS = {
    ("free_body", "acceleration"): (40, 0, 0),
    ("free_body_principal", "acceleration"): (12, 0, 0),
    ("heavy_top", "state_rate"): (9, 1, 2),
    ("gyrostat", "state_rate"): (64, 1, 4),
    ("rigid_body", "state_rate"): (96, 0, 0),
    ("rigid_body", "state_rate_jacobian"): (172, 0, 0),
}


EVERY = [
    pytest.param(name, wanted, marks=[] if place % 4 == 0 else pytest.mark.long)
    for place, name in enumerate(catalogue())
    for wanted in scene_of(name).wanted
]
"""Functions of every fourth scene at once, of the others in the longer run."""


@pytest.mark.long
@pytest.mark.parametrize(("scene", "function"), TARGETS)
def test_a_hot_function_costs_at_most_its_target(scene, function):
    program = library_of(scene)[function]
    count = program.count
    calls = count.get("sin", 0) + count.get("cos", 0)
    assert (program.flops(), count.get("div", 0), calls) <= TARGETS[scene, function]


@pytest.mark.long
def test_the_free_body_has_sixty_six_nonzeros():
    pattern = library_of("rigid_body")["state_rate_jacobian"].sparsity["jacobian"]
    assert (len(pattern.rows), len(pattern.columns), len(pattern.row)) == (13, 19, 66)


@pytest.mark.parametrize(("scene", "function"), EVERY)
def test_no_operation_works_on_parameters_only(scene, function):
    library_ = library_of(scene)
    program = library_[function]
    fixed = {c for q in program.inputs if q.role == "constants" for c in q.components}
    for op in every_op(program.ops):
        if op.operator in TRUTHS:
            continue  # a truth is no constant: it is told from one where it is needed
        known = [not isinstance(o, str) or o in fixed for o in op.operands]
        assert not known or not all(known), op  # pi and its like have no operands


@pytest.mark.parametrize(("scene", "function"), EVERY)
def test_no_operation_is_done_twice_and_none_is_idle(scene, function):
    program = library_of(scene)[function]
    loops = [line.body for line in program.ops if isinstance(line, Loop) and line.carried]
    for ops in ([line for line in program.ops if isinstance(line, Op)], *loops):
        assert len({(op.operator, op.operands) for op in ops}) == len(ops)
    assert {op.result for op in every_op(program.ops)} <= read_by(program)


@pytest.mark.parametrize(("scene", "function"), EVERY)
def test_every_input_is_used(scene, function):
    program = library_of(scene)[function]
    read = read_by(program)
    assert all(read & set(q.components) for q in program.inputs)


@pytest.mark.parametrize("scene", thinned(catalogue(), 4))
def test_every_constant_is_used(scene):
    library_ = library_of(scene)
    read = {name for p in library_.printed() for name in read_by(p)}
    assert library_.constants.keys() <= read


def names(program: Program) -> list[str]:
    return [q.name for q in program.inputs]


@pytest.mark.long
def test_inputs_that_do_not_matter_are_not_asked_for():
    assert names(library_of("heavy_top")["state_rate"]) == ["constants", "theta", "omega"]
    assert "position" not in names(library_of("rigid_body")["state_rate"])
    assert "psi" not in names(library_of("gyrostat")["state_rate"])
