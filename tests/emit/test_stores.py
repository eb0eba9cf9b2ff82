"""Where C stores results: soon after they are computed, and never before an input is read."""

import re
from collections.abc import Sequence

import pytest

from derive.emit.c.signature import dense
from derive.emit.c.text import function_body, is_long, result_slots
from derive.program.precision import F64
from derive.program.program import MATRIX, Program
from derive.scene import catalogue
from tests.made import library_of

MADE = re.compile(r"const double (t\w+) = ")
STORE = re.compile(r"(\*?\w+(?:\[\d+\])?) = (.*);")


def every(name: str) -> list[Program]:
    """Return the functions of a scene without loops over arrays, dense ones among them."""
    printed = [p for p in library_of(name).printed() if not p.has_arrays]
    return [*printed, *(dense(p) for p in printed if p.sparsity)]


def lines_of(program: Program) -> list[str]:
    """Return the C of a function."""
    return function_body(program, "own", F64)


def read_too_late(program: Program, lines: Sequence[str]) -> list[str]:
    """Return lines that read an array after a store, but for a Jacobian's."""
    arrays = [q.name for q in program.inputs if q.shape and q.role != "constants"]
    reads = re.compile(rf"\b(?:{'|'.join(arrays or ['none'])})\[")
    slots = {s for s in result_slots(program) if not s.startswith(f"{MATRIX}[")}
    stored, found = False, []
    for line in lines:
        store = STORE.fullmatch(line)
        if stored and reads.search(store[2] if store else line):
            found.append(line)
        stored |= store is not None and store[1] in slots
    return found


@pytest.mark.parametrize("name", catalogue())
def test_inputs_are_read_before_results_are_stored_over_them(name: str) -> None:
    for program in every(name):
        lines = lines_of(program)
        assert not read_too_late(program, lines), program.name
        stores = [found[1] for line in lines if (found := STORE.fullmatch(line))]
        assert sorted(s for s in stores if s in result_slots(program)) == sorted(
            result_slots(program)
        )


@pytest.mark.long
def test_a_store_before_an_input_is_read_is_found() -> None:
    program = library_of("rigid_body")["state_rate"]
    load, *rest = lines_of(program)
    name, value = load.removeprefix("const double ").removesuffix(";").split(" = ")
    late = [line.replace(name, value) for line in rest]
    assert not read_too_late(program, rest)
    assert read_too_late(program, late)


@pytest.mark.parametrize(
    ("name", "function", "kind"),
    [
        ("rigid_body", "state_rate_jacobian", "short"),
        ("satellite", "step_rk4_jacobian", "long"),
    ],
)
def test_a_jacobian_is_stored_where_it_is_computed(name: str, function: str, kind: str) -> None:
    program = library_of(name)[function]
    assert is_long(program) == (kind == "long")
    for one in (program, dense(program)):
        lines = lines_of(one)
        made = {x[1]: n for n, x in enumerate(map(MADE.match, lines)) if x}
        stores = [(n, x[2]) for n, x in enumerate(map(STORE.fullmatch, lines))
                  if x and x[1].startswith(f"{MATRIX}[") and x[2] in made]  # fmt: skip
        assert len(stores) > len(program.sparsity[MATRIX].row) / 2
        for n, value in stores:
            between = lines[made[value] + 1 : n]
            assert all(STORE.fullmatch(x) or "_in = " in x for x in between), lines[n]


@pytest.mark.parametrize("name", catalogue())
def test_a_dense_function_has_the_lines_of_the_sparse_one_and_zeros(name: str) -> None:
    for program in (p for p in library_of(name).printed() if p.sparsity and not p.has_arrays):
        pattern, whole = program.sparsity[MATRIX], dense(program)
        height = len(pattern.rows)
        moved = {f"{MATRIX}[{k}]": f"{MATRIX}[{column * height + row}]"
                 for k, (row, column) in enumerate(pattern.places())}  # fmt: skip
        own, other = (map(STORE.fullmatch, lines_of(p)) for p in (program, whole))
        stores = {moved.get(x[1], x[1]): x[2] for x in own if x}
        found = {x[1]: x[2] for x in other if x}
        zeros = found.keys() - stores.keys()
        assert {found[slot] for slot in zeros} <= {"0.0"}
        assert {slot: found[slot] for slot in stores} == stores
        assert len(zeros) == height * len(pattern.columns) - len(pattern.row)
        rest, again = ([x for x in lines_of(p) if not STORE.fullmatch(x)] for p in (program, whole))
        assert rest == again
