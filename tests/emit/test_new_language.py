"""An output language is a file and its template, which print every program as it is meant."""

import math
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from derive.emit.casadi_module import imported
from derive.program.arithmetic import OPERATORS, extended, paired, working
from derive.program.indexed import (
    Arrays,
    Assign,
    Element,
    Even,
    Index,
    Integers,
    Loop,
    Row,
    Same,
    Term,
    Whole,
)
from derive.program.program import Op, Program, Quantity, component_names
from derive.program.run import run
from tests.emit.plain_python import OWN, python_file
from tests.made import library_of

ACCURATE = str(Path(__file__).parents[2] / "bench" / "motion" / "scenes" / "accurate.toml")
QUICK = ("attitude", "heavy_body", "skewed_disc", ACCURATE)
LONG = ("tumbling_body", "rigid_body_steps", "heavy_top", "rolling_cone")
CALLED = {n: getattr(math, n) for n, row in OPERATORS.items() if row.libc and hasattr(math, n)}
"""What Python calls; tables of a run round sines correctly, which no platform promises."""
GIVEN = Quantity("x", ("x",), (), "1", "", Fraction(-1), Fraction(1), "")


def outputs(*names: str) -> tuple[Quantity, ...]:
    """Return a quantity a name."""
    return tuple(Quantity(n, (n,), (), "1", "", None, None, "") for n in names)


def at(counter: str, plus: int = 0, table: str = "") -> Index:
    """Return a place of an array."""
    return Index(counter, plus, table)


EVERY_KIND = Program(
    "every_kind", "", (GIVEN,), outputs("power", "sum", "last", "root", "carried"),
    (
        Integers("order", (2, 0, 1)),
        Arrays((("a", (5,)), ("b", (3, 3)))),
        Row("r", ("x", Fraction(1, 3), Fraction(2))),
        Loop("k", at(""), at("", 5), (
            Assign(Element("a", (at("k"),)), Term("div", ("x", Whole(at("k", 1))))),
            Even("k", "half", (
                Assign(Element("a", (at("k"),)),
                       Term("mul", (Element("r", (at("half"),)), Term("sub", ("x", Fraction(1))))),
                       "add"),
            )),
        )),
        Loop("i", at("", 2), at("", -1), (
            Loop("j", at(""), at("", 3), (
                Assign(Element("b", (at("i"), at("j"))),
                       Term("sub", (Same(at("i"), at("j")), Term("add", ("x", "x"))))),
            )),
        ), -1),
        Assign("total", Fraction(0), "", "variable"),
        Loop("n", at(""), at("", 3), (
            Assign("total", Element("b", (at("n"), at("n", 0, "order"))), "sub"),
        )),
        Loop("p", at("", 1), at("", 5), (
            Assign("total", Term("mul", tuple(Element("a", (at(c),)) for c in "pm")), "add"),
        ), 1, "m", meets=True),
        Op("start", "mul", ("x", Fraction(3))),
        Loop("", at(""), at("", 9), (
            Op("w", "mul", ("y", "z")), Op("small", "less", ("w", Fraction(1, 100))),
        ), carried=("y", "z"), start=("start", Fraction(1)), then=("z", "w"), done="small"),
        Loop("k", at("", 1), at("", 5), (
            Assign(Element("a", (at("k"),)), Term("mul", (Element("a", (at("k", -1),)), "s"))),
            Op("t", "add", ("s", "c")),
        ), carried=("c", "s"), start=("x", Fraction(1, 2)), then=("s", "t")),
        Op("size", "abs", ("y",)),
        Op("root", "sqrt", ("size",)),
    ),
    ("z", "total", "a[4]", "root", "s"),
)  # fmt: skip


def printed(programs: tuple[Program, ...], own: Mapping[str, str], folder: Path) -> ModuleType:
    """Return the module that programs become."""
    return imported("plain", python_file(programs, own), folder)


def ends(program: Program, given: Mapping[str, float]) -> dict[str, float]:
    """Return what a run gives, in the floats of a double or in pairs of them."""
    names = [c for q in program.inputs for c in q.components]
    values = np.array([given[c] for c in names], float)
    if program.arithmetic == "pairs":
        found = [pair[0] for pair in run(program, extended(np.float64), paired(values))]
    else:
        found = run(program, {**working(np.float64), **CALLED}, list(values))
    return dict(zip(component_names(program), map(float, found), strict=True))


def place(q: Quantity, k: int) -> Any:
    """Return a value within the range of a component, or near 0.5 if it has none."""
    low, high = (0, 1) if q.low is None or q.high is None else (float(q.low), float(q.high))
    return low + (high - low) * (0.53 + 0.11 * k)


@pytest.mark.parametrize(
    "name", [*QUICK, *(pytest.param(name, marks=pytest.mark.long) for name in LONG)]
)
def test_every_program_of_a_scene_gives_the_same_bits_in_it(name: str, tmp_path: Path) -> None:
    of = library_of(name)
    programs = (of.setup, *of.printed())
    module = printed(programs, OWN, tmp_path)
    given: dict[str, float] = {}
    for program in programs:
        given |= {
            c: place(q, k)
            for q in program.inputs
            for k, c in enumerate(q.components)
            if c not in given
        }
        found = getattr(module, program.name)(given)
        assert found == pytest.approx(ends(program, given), rel=0, abs=0, nan_ok=True)
        given |= {c: found[c] for q in program.outputs if not q.is_value for c in q.components}


@pytest.mark.parametrize("x", [-0.75, 0.25, 1.0])
def test_every_kind_of_line_means_in_it_what_a_run_means(x: float, tmp_path: Path) -> None:
    module = printed((EVERY_KIND,), OWN, tmp_path)
    assert module.every_kind({"x": x}) == ends(EVERY_KIND, {"x": x})


def test_a_pattern_that_says_something_else_is_seen(tmp_path: Path) -> None:
    module = printed((EVERY_KIND,), {**OWN, "sub": "{1} - {0}"}, tmp_path)
    assert module.every_kind({"x": 0.25}) != ends(EVERY_KIND, {"x": 0.25})
