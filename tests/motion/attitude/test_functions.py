"""Every formula for attitudes that a scene may ask for is there, and each says what it takes."""

import pytest

from derive.motion.attitude.functions import FUNCTIONS, attitude_program
from derive.program.program import Op
from derive.scene.wanted import ATTITUDES

each = pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.name)


def test_the_functions_are_those_that_a_scene_may_want():
    assert sorted(f.name for f in FUNCTIONS) == sorted(ATTITUDES)


@each
def test_a_program_has_a_component_of_its_own_for_every_place(function):
    quantities = (*function.inputs, *function.outputs)
    assert len({q.name for q in quantities}) == len(quantities)
    components = [c for q in quantities for c in q.components]
    assert len(set(components)) == len(components)
    assert all(len(q.components) == q.shape[0] for q in quantities)


@each
def test_every_input_is_used_and_every_result_is_a_value(function):
    program = attitude_program(function.name)
    used = {o for op in program.ops if isinstance(op, Op) for o in op.operands}
    assert {c for q in program.inputs for c in q.components} <= used
    assert all(isinstance(r, str) for r in program.results)
    assert len(program.results) == sum(len(q.components) for q in program.outputs)
