"""CasADi's Functions keep what rounding leaves wherever they are put, and miss no input in silence.

CasADi simplifies (a + b) - a to b where a Function is called with SX, or expanded: then the pairs
of set-up and the remainders of compensated steps would be gone. Bits are the same in MX; where
CasADi makes the expressions anew, products with inverses are quotients, and last places differ.
"""

import re
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import product
from pathlib import Path
from tempfile import mkdtemp
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from numpy.typing import NDArray

from derive.check.inlined import inlined
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import library
from derive.program.precision import F64
from derive.scene import load, parse_scene
from derive.verify.draw import with_motion
from derive.verify.sample import samples
from tests.made import thinned

U = 2.0**-53
LAST = 2 * U  # of each constant: its own rounding, once here and once there
CONDITIONS = (1e6, 1e9)
STEP = 2.0**-10
COMPENSATED = """
title  = "Compensated steps"
wanted = ["step_rk4_compensated", "step_split_compensated"]
[axes]
attitude = "quaternion"
[body]
kind    = "principal"
moments = [1, 2, 3]
[known]
moment = [0, 0, 0]
"""
Numbers = list[NDArray[Any]]


def called_with_sx(f: Any) -> Any:
    given = [ca.SX.sym(f"x{k}", f.sparsity_in(k)) for k in range(f.n_in())]
    return ca.Function("again", given, f.call(given))


def in_mx(f: Any) -> Any:
    given = [ca.MX.sym(f"x{k}", f.sparsity_in(k)) for k in range(f.n_in())]
    return ca.Function("outer", given, f.call(given))


def expanded(f: Any) -> Any:
    return in_mx(f).expand()


def expanded_map(f: Any) -> Any:
    """Return the function by a map of two calls that is expanded, the second left out again."""
    given = [ca.MX.sym(f"x{k}", f.sparsity_in(k)) for k in range(f.n_in())]
    twice = f.map(2).call([ca.horzcat(x, x) for x in given])
    first = [y[:, : f.size2_out(k)] for k, y in enumerate(twice)]
    return ca.Function("mapped", given, first).expand()


ANEW = (called_with_sx, expanded, expanded_map)


def module(text: str, name: str) -> ModuleType:
    return imported(f"{name}_casadi", text, Path(mkdtemp()))


@cache
def free_body(form: str) -> ModuleType:
    whole = load("free_body").text
    wanted = re.sub(r"wanted = \[.*?\]", 'wanted = ["acceleration"]', whole, flags=re.DOTALL)
    text = f'form = "{form}"\n{wanted}'
    return module(casadi_file(library(parse_scene(text, "free_body"))), "free_body")


@cache
def steps() -> ModuleType:
    return module(casadi_file(library(parse_scene(COMPENSATED, "steps"))), "steps")


def values(f: Any, *given: Any) -> Numbers:
    return [np.array(y.nonzeros()) for y in f.call([ca.DM(x) for x in given])]


def slender(condition: float) -> list[float]:
    """Return a tensor of moments 1, 1 and 1 / condition along axes that nobody chose."""
    axes = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    full = axes @ np.diag([1.0, 1.0, 1 / condition]) @ axes.T
    return [*np.diag(full), -full[0, 1], -full[0, 2], -full[1, 2]]


def apart(found: Numbers, true: Numbers) -> float:
    """Return the largest difference, each number's over itself."""
    pairs = zip(np.concatenate(found), np.concatenate(true), strict=True)
    return max(abs(a - b) / abs(b) if b else abs(a) for a, b in pairs)


@pytest.mark.parametrize("form", ["fast", "accurate"])
@pytest.mark.parametrize("condition", CONDITIONS)
@pytest.mark.parametrize("way", ANEW)
def test_pairs_stay_pairs_where_casadi_builds_them_anew(
    way: Callable[[Any], Any], condition: float, form: str
) -> None:
    made, tensor = free_body(form), slender(condition)
    if form == "fast":
        tried, given = made.setup(), [tensor]
    else:
        tried, given = made.acceleration(), [tensor, [1.0, -2.0, 3.0], [0.1, 0.2, 0.3]]
    assert apart(values(way(tried), *given), values(tried, *given)) <= LAST


@pytest.mark.parametrize("name", ["step_rk4_compensated", "step_split_compensated"])
@pytest.mark.parametrize("way", ANEW)
def test_a_remainder_stays_what_rounding_left(way: Callable[[Any], Any], name: str) -> None:
    """What differs by u of the step's change is rounding of the change, in state and remainder."""
    f = getattr(steps(), name)()
    given = [1.0, 0, 0, 0], [1.5, -2.5, 0.75], STEP, [0.0] * 7
    names = f.name_in()
    order = {"attitude": given[0], "omega": given[1], "time_step": STEP, "remainder": given[3]}
    found, true = (values(g, *(order[n] for n in names)) for g in (way(f), f))
    ends = f.name_out()
    rest = ends.index("remainder_next")
    assert np.max(np.abs(found[rest])) > U * STEP
    sums = [np.concatenate([y for k, y in enumerate(x) if k != rest]) for x in (found, true)]
    total = (sums[0] - sums[1]) + (found[rest] - true[rest])
    assert np.max(np.abs(total)) <= 16 * U * STEP * 4  # rad: the change of the fastest state


@pytest.mark.parametrize("way", [in_mx, lambda f: in_mx(f.map(1))])
def test_bits_are_the_same_in_mx(way: Callable[[Any], Any]) -> None:
    setup, tensor = free_body("fast").setup(), slender(1e9)
    assert np.array_equal(values(way(setup), tensor)[0], values(setup, tensor)[0])


def test_opti_is_given_what_set_up_makes() -> None:
    """An optimiser that expands finds the parameter at which a constant has its value."""
    setup, tensor = free_body("fast").setup(), slender(1e6)
    opti = ca.Opti()
    x = opti.variable()
    opti.minimize((x - setup(ca.MX(tensor))[0]) ** 2)
    opti.solver("ipopt", {"print_time": False, "expand": True}, {"print_level": 0, "sb": "yes"})
    true = float(setup(tensor)[0])
    assert abs(opti.solve().value(x) / true - 1) < 4 * U  # a Newton step of a parabola


@pytest.mark.parametrize("left_out", ["parameters", "omega", "moment"])
def test_an_input_that_is_left_out_shows(left_out: str) -> None:
    f = free_body("fast").acceleration()
    given = {"parameters": slender(10.0), "omega": [1, 2, 3], "moment": [0.1, 0.2, 0.3]}
    assert np.all(np.isfinite(np.array(f(**given)["omega_dot"])))
    assert np.array_equal(values(f, *given.values())[0], np.array(f(**given)["omega_dot"])[:, 0])
    del given[left_out]
    assert np.all(np.isnan(np.array(f(**given)["omega_dot"])))


def inlined_rows(name: str, old: str, new: str) -> list[str]:
    """Return the outcomes of ``derive check`` on a CasADi file with a change in its text."""
    source = parse_scene(COMPENSATED, "steps") if name == "steps" else load(name)
    found = library(source)
    text = casadi_file(found)
    assert old in text
    each = samples(found.mechanism, F64, 2, 0).each
    given = with_motion(found, each, F64)
    return [v.outcome for v in inlined(found, module(text.replace(old, new), name), given)]


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(["free_body", "steps", "attitude", "tumbling_disc"], 2))
def test_every_function_is_the_same_where_it_is_called_with_sx(name: str) -> None:
    assert set(inlined_rows(name, "", "")) == {"holds"}


@pytest.mark.long
@pytest.mark.parametrize("name", ["free_body", "steps"])
def test_pairs_that_casadi_sees_through_are_noticed(name: str) -> None:
    rows = inlined_rows(name, 'return ca.remainder(x, float("inf"))', "return x")
    assert "FAILS" in rows


def shapes(x: Any, y: Any) -> dict[str, Any]:
    """Return what a number of a pair may be made of: CasADi's rules turn on signs and factors."""
    return {
        "x": x, "-x": -x, "2 x": 2.0 * x, "-2 x": -(2.0 * x), "x + y": x + y, "x - y": x - y,
        "-x - y": -(x + y), "x y": x * y, "x / y": x / y, "1 / x": 1.0 / x, "x^2": x * x,
        "1.3": 1.3, "2": 2.0, "-1": -1.0, "0": 0.0,
    }  # fmt: skip


PAIRS = [*product(shapes(1.0, 1.0), repeat=2)]
CLOSE = 2.0**-96


def exactly(operation: str, a: Fraction, b: Fraction) -> Fraction:
    match operation:
        case "_add":
            return a + b
        case "_sub":
            return a - b
        case "_mul":
            return a * b
    return a / b


@pytest.mark.parametrize(
    "operation",
    ["_mul", *(pytest.param(o, marks=pytest.mark.long) for o in ("_add", "_sub", "_div"))],
)
def test_pairs_of_whatever_expressions_stay_pairs(operation: str) -> None:
    made, worst = free_body("fast"), dict[str, float]()
    x, y = 1.2345678901234567, 0.9876543210987654
    for p, q in PAIRS:
        if operation == "_div" and q == "0":
            continue

        def build(p: str = p, q: str = q) -> Any:
            at = ca.SX.sym("x"), ca.SX.sym("y")
            a, b = ((shapes(*at)[shape], 0.0) for shape in (p, q))
            found = getattr(made, operation)(a, made._neg(b))
            return ca.Function("pair", at, [ca.vertcat(a[0], b[0], *found)])

        for way in ANEW[:2]:
            first, second, high, low = map(Fraction, values(way(made._built(build)), x, y)[0])
            true = exactly(operation, first, -second)
            size = max(abs(first), abs(second)) if operation in ("_add", "_sub") else abs(true)
            if size:
                error = float(abs(high + low - true) / size)
                worst[f"{p}, {q}"] = max(error, worst.get(f"{p}, {q}", 0.0))
    assert len(worst) > len(PAIRS) / 2
    assert {case: error for case, error in worst.items() if error > CLOSE} == {}
