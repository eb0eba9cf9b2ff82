"""No figure rests on an interpreter or a library: what they round in their own way is not asked.

The built-in ``sum`` adds floats in another way from Python 3.12 on; functions of the C library and
of numpy's vector units differ in the last bit from machine to machine. Basic operations, square
roots and whatever is exact do not. The emitted files are compared under every interpreter that
there is by .ci/run; this test reads the sources, and so sees what no scene happens to run.
"""

import ast
import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.source import nodes_of, parsed

ROOT = Path(__file__).parents[2]
SOURCES = [p for room in ("derive", "bench") for p in sorted((ROOT / room).rglob("*.py"))]
EXACT = {"sqrt", "isfinite", "isnan", "isinf", "inf", "nan", "pi", "floor", "ceil", "frexp",
         "ldexp", "copysign", "gcd", "lcm", "isqrt", "factorial", "comb", "prod", "fabs", "trunc",
         "nextafter", "ulp", "fsum"}  # fmt: skip
"""Of ``math``: exact, or rounded once and correctly everywhere (prod: used of integers)."""
OF_NUMPY = {"sum", "mean", "std", "var", "dot", "vdot", "inner", "matmul", "einsum", "linalg",
            "sin", "cos", "tan", "arcsin", "arccos", "arctan", "arctan2", "exp", "exp2", "log",
            "log2", "log10", "power", "prod", "cumsum", "average", "percentile", "quantile",
            "hypot", "convolve", "fft", "random", "float128", "longdouble"}  # fmt: skip
"""Of numpy: rounded in an order or by a method of its own."""
MEASURED = ("bench", "report", "solve", "control")
"""Rooms whose figures are of one run on one machine, or answers: times, peers, roots, ways."""
ASKED = {
    "verify/operators.py: sin": "a first value, and the size of terms, rounded to two digits",
    "verify/operators.py: cos": "as sin",
    "verify/operators.py: arctan2": "a first value, corrected by pairs to what SURE says",
    "verify/draw.py: mean": "a share of those admitted, compared with a bound",
    "verify/draw.py: prod": "of whole numbers",
    "verify/draw.py: random": "raw words of Philox, the same in every version",
    "scene/functions.py: sin": "ranges and drawings only: what is measured is evaluated in balls",
    "scene/functions.py: cos": "as sin",
    "scene/functions.py: tan": "as sin",
    "verify/convergence.py: log2": "an order, compared with bounds tenths away and not printed",
    "mechanics/choice.py: linalg": "which balances tell unknowns apart, by margins of digits",
    "lower/arrange/pivots.py: linalg": "which pivots do not vanish, by margins of digits",
    "mechanics/sweep.py: linalg": "where divisors vanish, by margins of digits",
    "mechanics/follows.py: linalg": "what follows by constraints, by margins of digits",
    "mechanics/onto.py: linalg": "states on constraints at which divisors and ranks are looked at",
    "mechanics/independence.py: linalg": "what constraints clearly say; else exactly",
    "mechanics/held_links.py: linalg": "which pivots stay clear of zero, by margins of digits",
    "mechanics/held_links.py: prod": "which pivots stay clear of zero, by margins of digits",
    "verify/cloud/fulfilled.py: linalg": "which constraints are independent, by margins of digits",
    "scene/numbers.py: hypot": "a length in a sentence of refusal, to ten digits",
    "check/attitudes.py: atan": "verdicts against a bound of many u",
    "check/attitudes.py: atan2": "as atan",
    "check/attitudes.py: cos": "as atan",
    "check/attitudes.py: sin": "as atan",
    "check/attitudes.py: hypot": "as atan",
}
"""What is asked all the same, and why no figure changes by it."""
WHOLE = {
    "library/admission.py: _eased": "values that are recorded",
    "bench/motion/case.py: _exact": "digits counted",
    "bench/motion/case.py: rate": "fractions",
    "bench/show.py: bench": "problems counted",
    "control/arcs.py: refined": "formulas of CasADi",
    "bench/truth.py: _add": "balls",
    "check/admission.py: _joined": "entries counted",
    "check/derivatives.py: _differentiated": "whole numbers",
    "check/target/build.py: _taken": "bytes",
    "check/target/harness.py: count_of": "values counted",
    "bench/nmpc.py: flown": "seconds of this run",
    "lower/wording.py: _names_in": "names counted",
    "bench/links.py: staged": "operations counted",
    "bench/links.py: machines_beside": "components counted",
    "emit/package/tested.py: _function": "values counted",
    "command/lecture.py: _verified": "seconds of this run",
    "lower/expand.py: degree": "powers",
    "motion/compensated.py: normalising_increment": "values that are recorded",
    "motion/exact/tumbling.py: _turn": "values that are recorded",
    "lower/homogeneous.py: _fewest": "degrees, which are whole",
    "lower/arrange/tidy.py: term_count": "terms counted",
    "lower/arrange/tidy.py: tidied": "expressions",
    "lower/arrange/tidy.py: _operations": "operations counted",
    "lower/arrange/turns.py: turns_one_by_one": "operations counted",
    "lower/arrange/spherical_part.py: _pair": "powers",
    "mechanics/contradiction.py: _contradicted": "arrays of long floats",
    "mechanics/valued.py: force": "arrays of long floats",
    "mechanics/valued.py: moment": "arrays of long floats",
    "mechanics/sweep.py: _valued": "arrays, which no interpreter compensates",
    "emit/c/external.py: sizes": "components counted",
    "emit/notation/glyph.py: glyph": "dots counted",
    "emit/page/equation.py: written_names": "quaternions counted",
    "emit/notation/symbolic.py: _degree": "powers",
    "emit/notation/symbolic.py: _term_key": "powers",
    "mechanics/by_links.py: _pairs": "links counted",
    "program/program.py: flops": "operations counted",
    "report/courses.py: followed_to_the_end": "operations and states counted",
    "report/extrapolation.py: rule_for": "operations counted",
    "report/price.py: price_of": "operations counted",
    "verify/solution.py: _through": "balls",
    "bench/report/code_size.py: code_size": "bytes",
    "lower/share.py: _negations": "signs counted",
    "solve/sweep/engine.py: _room": "threads counted",
    "solve/sweep/ensemble.py: _chunks_done": "members counted",
    "solve/sweep/ensemble.py: _planned": "columns counted",
    "solve/sweep/ensemble.py: unfinished": "members counted",
    "lower/arrange/spherical_part.py: terms_of": "terms counted",
    "lecture/tree.py: size": "symbols counted",
    "lower/wording.py: spelling": "powers",
}
"""Sums of whole numbers, fractions, balls or expressions, which are exact: file and function."""


def text_of(source: Path) -> str:
    return source.read_text(encoding="utf-8")


def judged() -> list[Path]:
    return [s for s in SOURCES if name(s).split("/")[0] not in MEASURED]


def asked(tree: ast.Module) -> Iterator[str]:
    """Yield what a module takes from ``math``, ``statistics`` and numpy that is not the same
    everywhere."""
    for node in nodes_of(tree):
        match node:
            case ast.ImportFrom(module="math", names=names):
                yield from (n.name for n in names if n.name not in EXACT)
            case ast.ImportFrom(module="statistics", names=names):
                yield from (n.name for n in names if n.name != "median")
            case ast.Attribute(value=ast.Name(id="math"), attr=name) if name not in EXACT:
                yield name
            case ast.Attribute(value=ast.Name(id="np"), attr=name) if name in OF_NUMPY:
                yield name
            case ast.Import(names=names) if any(n.name in ("statistics", "cmath") for n in names):
                yield "import"
            case ast.BinOp(op=ast.Pow(), right=ast.Constant(value=float())):
                yield "a power that is not whole"


def sums(tree: ast.AST, within: str = "") -> Iterator[str]:
    """Yield the function around each call of ``sum`` that may be of floats."""
    for node in ast.iter_child_nodes(tree):
        inside = node.name if isinstance(node, ast.FunctionDef) else within
        called = node.func if isinstance(node, ast.Call) else None
        if isinstance(called, ast.Name) and called.id == "sum" and not exact(node):
            yield inside
        yield from sums(node, inside)


def exact(call: ast.AST) -> bool:
    """Tell whether a sum counts, or begins with an exact number or an expression."""
    assert isinstance(call, ast.Call)
    if len(call.args) == 2:
        return isinstance(call.args[1], ast.Call | ast.Name)
    terms = call.args[0]
    counted = terms.elt if isinstance(terms, ast.GeneratorExp) else None
    one = isinstance(counted, ast.Constant) and isinstance(counted.value, int)
    return one or isinstance(counted, ast.Compare | ast.BoolOp)


def name(source: Path) -> str:
    return source.relative_to(ROOT).as_posix().removeprefix("derive/")


@pytest.mark.long
def test_no_module_asks_for_what_is_rounded_differently_elsewhere() -> None:
    found = {f"{name(s)}: {what}" for s in judged() for what in asked(parsed(text_of(s)))}
    assert found == set(ASKED)


def test_floats_are_added_by_no_sum_of_the_interpreter() -> None:
    texts = {name(s): text for s in SOURCES if "sum(" in (text := text_of(s))}
    found = {f"{page}: {where}" for page, text in texts.items() for where in sums(parsed(text))}
    assert found == set(WHOLE)


@pytest.mark.parametrize(
    ("source", "seen"),
    [
        ("from math import hypot", ["hypot"]),
        ("import math\nx = math.pow(2.0, 0.5)", ["pow"]),
        ("from statistics import fmean", ["fmean"]),
        ("import numpy as np\nnp.sum([0.1, 0.2])", ["sum"]),
        ("x = y ** 0.5", ["a power that is not whole"]),
        ("from math import sqrt\nx = sqrt(y) + y**2", []),
    ],
)
def test_what_differs_is_seen(source: str, seen: list[str]) -> None:
    assert list(asked(ast.parse(source))) == seen


@pytest.mark.parametrize(
    ("call", "seen"),
    [
        ("sum(x * x for x in values)", ["length"]),
        ("sum(values, 0.0)", ["length"]),
        ("sum(x > 0 for x in values)", []),
        ("sum(values, Fraction(0))", []),
    ],
)
def test_a_sum_that_may_be_of_floats_is_seen(call: str, seen: list[str]) -> None:
    assert list(sums(ast.parse(f"def length(values): return {call}"))) == seen


def test_every_name_of_math_that_is_let_pass_exists() -> None:
    assert {n for n in EXACT if not hasattr(math, n)} == set()
