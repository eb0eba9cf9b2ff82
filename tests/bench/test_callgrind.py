"""Instruction counts: callgrind's file is read right, and a known loop costs what it must."""

import shutil

import pytest

from bench.build import O2, build
from bench.callgrind import instructions
from bench.candidate import SAMPLES, Argument, Candidate, Source, pointer_glue
from bench.problem import FREE_BODY
from bench.sample import SETS, samples
from derive.check.callgrind import CallgrindError, total

FILE = """\
# callgrind format
version: 1
creator: callgrind-3.19.0
cmd: ./driver 4
desc: Trigger: Program termination
positions: line
events: Ir
summary: 189137

ob=(1) /tmp/driver
fn=(1) main
0 7
calls=1 0
0 189130
totals: 189137
"""


def test_the_total_of_a_callgrind_file_is_read() -> None:
    assert total(FILE) == 189137


@pytest.mark.parametrize("lost", ["events: Ir", "189137"])
def test_a_file_without_its_total_is_refused(lost: str) -> None:
    with pytest.raises(CallgrindError, match="without a total"):
        total(FILE.replace(lost, ""))


def chain(divisions: int) -> Candidate:
    """Return a function whose divisions the compiler can neither drop nor join."""
    body = "".join("a = a / b;\n" for _ in range(divisions))
    head = "void f(const double *x, double *y)"
    text = f"{head}\n{{\ndouble a = x[0], b = x[1];\n{body}*y = a;\n}}\n"
    takes = [Argument("inputs", 0), Argument("outputs", 0)]
    glue = pointer_glue(FREE_BODY, f"{head};\n", "f", takes)
    return Candidate("chain", FREE_BODY, (Source("f.c", text),), glue, ("f.c", ("f",)))


@pytest.mark.long
@pytest.mark.skipif(
    not (shutil.which("gcc") and shutil.which("valgrind")), reason="needs gcc and valgrind"
)
def test_twenty_more_divisions_cost_twenty_more_instructions(tmp_path) -> None:
    rows = samples(FREE_BODY, SETS[0], SAMPLES)
    few = instructions(build(chain(5), O2, tmp_path / "few"), rows)
    many = instructions(build(chain(25), O2, tmp_path / "many"), rows)
    assert many - few == pytest.approx(20, abs=0.5)
