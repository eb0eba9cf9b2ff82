"""Emitted formulas for attitudes are what their names mean, and a wrong sign is not."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from derive.check.attitudes import attitude_definitions
from derive.check.compiler import find_compiler
from derive.check.emitted import Emitted, Files, loaded
from derive.emit.files import scene_files
from derive.library.library import library
from derive.program.arithmetic import working
from derive.program.precision import F64
from derive.program.program import Op, Program, component_names
from derive.program.run import run
from derive.scene import parse_scene
from derive.scene.wanted import ATTITUDES
from tests.made import thinned

EVERY = 'title = "All formulas"\nwanted = [{}]\n'.format(", ".join(f'"{n}"' for n in ATTITUDES))


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> list[Emitted]:
    folder: Path = tmp_path_factory.mktemp("definitions")
    made = library(parse_scene(EVERY, "formulas"))
    texts = {path.partition("/")[2]: text for path, text in scene_files(made, ()).items()}
    return list(loaded(made, Files(texts, "made in memory"), folder, find_compiler()))


@pytest.mark.long
@pytest.mark.parametrize("place", thinned([0, 1], 2), ids=["f32", "f64"])
def test_every_formula_is_what_its_name_means(both: list[Emitted], place: int) -> None:
    found = list(attitude_definitions(both[place]))
    assert {v.function for v in found} == set(ATTITUDES)
    assert [v for v in found if v.outcome != "holds"] == []


@pytest.mark.long
@pytest.mark.parametrize("component", thinned([0, 1, 2], 3))
def test_a_component_with_the_other_sign_is_noticed(both: list[Emitted], component: int) -> None:
    def other(name: str):
        def function(given):
            found = both[1].functions[name](given)
            return {n: [-x if k == component else x for k, x in enumerate(v)]
                    for n, v in found.items()}  # fmt: skip

        return function

    spoilt = replace(both[1], functions={name: other(name) for name in ATTITUDES})
    assert {v.function for v in attitude_definitions(spoilt) if v.outcome != "FAILS"} == set()


def test_a_sum_with_the_other_sign_is_noticed(both: list[Emitted]) -> None:
    missed, count = [], 0
    for program in both[1].library.printed():
        for place in _sums_that_are_results(program)[:1]:
            alone = replace(both[1].library, motions=(program,), functions=())
            functions = {program.name: _swapped(program, place)}
            (verdict,) = attitude_definitions(replace(both[1], library=alone, functions=functions))
            missed += [program.name] if verdict.outcome != "FAILS" else []
            count += 1
    assert missed == []
    assert count >= SHOWN


SWAPPED = {"add": "sub", "sub": "add"}


SHOWN = 5  # formulas that end in a sum


def _sums_that_are_results(program: Program) -> list[int]:
    ends = [op.result in program.results if isinstance(op, Op) else False for op in program.ops]
    sums = [isinstance(op, Op) and op.operator in SWAPPED for op in program.ops]
    return [k for k, both in enumerate(zip(ends, sums, strict=True)) if all(both)]


def _swapped(program: Program, place: int):
    ops = list(program.ops)
    ops[place] = replace(ops[place], operator=SWAPPED[ops[place].operator])
    mutant = replace(program, ops=tuple(ops))

    def function(given) -> dict[str, Sequence[float]]:
        numbers = [F64.dtype(x) for q in program.inputs for x in given[q.name]]
        found = [float(x) for x in run(mutant, working(F64.dtype), numbers)]
        assert len(found) == len(component_names(program))
        return {program.outputs[0].name: found}

    return function
