"""Slopes of exact flows and plans in CasADi: nowhere lost, whichever way a Function is called."""

from collections.abc import Callable
from functools import cache
from math import inf, nan
from pathlib import Path
from tempfile import mkdtemp
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from numpy.typing import NDArray

from derive.check.derivatives import compared
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import load, parse_scene
from derive.verify.draw import with_motion
from derive.verify.sample import samples
from tests.check.test_casadi_inlined import called_with_sx, expanded
from tests.made import thinned

SAME = 1e-9
"""Relative: the same formulas, simplified or not; second derivatives are sums of large terms."""
FREE = """
title  = "Any body, free"
wanted = ["flow_exact", "step_dmv"]
[axes]
attitude = "quaternion"
[body]
kind = "{kind}"
{tensor}
[known]
angular_velocity = {{ range = [-5, 5] }}
moment = [0, 0, 0]
[motion]
time = {{ range = [0, 100] }}
"""
BODIES = {
    "principal": "moments = [1, 2, 2.5]",
    "sphere": "moments = [2, 2, 2]",
    "general": "moments = [2, 2.5, 3]\nproducts = [0.1, 0.2, 0.3]",
}
AT = [1.0, 0.0, 0.0, 0.0], [0.3, -2.0, 0.7], 3.0


@cache
def made(name: str) -> tuple[Library, ModuleType]:
    kind = "general" if name == "general" else "principal"
    text = FREE.format(kind=kind, tensor=BODIES.get(name, ""))
    found = library(parse_scene(text, "free") if name in BODIES else load(name))
    return found, imported("free_casadi", casadi_file(found), Path(mkdtemp()))


@pytest.mark.long
@pytest.mark.parametrize("function", ["flow_exact", "plan_dmv"])
@pytest.mark.parametrize("name", thinned([*BODIES, "tumbling_disc"], 4))
def test_no_slope_is_wrong_or_lost(name: str, function: str) -> None:
    """At rest, about and beside each axis, for no time, with equal moments, and elsewhere."""
    found, module = made(name)
    each = with_motion(found, samples(found.mechanism, F64, 4, 0).each, F64)
    plain = [s for s in each if s.kind == "ordinary"][:2]
    wrong, missing = compared(found, found[function], getattr(module, function)(), plain)
    assert (wrong, missing) == ([], [])


@pytest.mark.long
@pytest.mark.parametrize("way", [called_with_sx, expanded])
def test_slopes_are_the_same_where_casadi_builds_a_flow_anew(way: Callable[[Any], Any]) -> None:
    flow = made("principal")[1].flow_exact()
    both = slopes(flow), slopes(way(flow))
    for omega in ((0.0, 2.0, 0.0), (0.0, 0.0, 0.0), (1e-13, 2.0, 1e-13)):
        true, anew = (of([AT[0], omega, AT[2]]) for of in both)
        for one, other in zip(true, anew, strict=True):
            assert np.max(np.abs(one - other)) < SAME * np.max(np.abs(one))


def slopes(f: Any) -> Callable[[Any], list[NDArray[Any]]]:
    """Return first derivatives in both ways and second ones, as a function of the state."""
    x = ca.MX.sym("x", 8)
    ends = ca.vertcat(*f.call([x[:4], x[4:7], x[7]]))
    first = ca.jacobian(ends, x)
    back = ca.jtimes(ends, x, ca.DM(np.arange(1.0, 8.0)), True)  # noqa: FBT003  CasADi's own
    every = [first, back, ca.jacobian(back, x)]
    found = ca.Function("slopes", [x], list(map(ca.densify, every)))
    return lambda at: [np.array(y) for y in found.call([ca.vertcat(*map(ca.DM, at))])]


@pytest.mark.long
def test_third_slopes_of_a_turn_are_no_numbers() -> None:
    x = ca.MX.sym("x", 3)
    end = made("principal")[1].flow_exact()(AT[0], x, AT[2])[0][1]
    third = ca.jacobian(ca.jacobian(ca.gradient(end, x), x)[:], x)
    found = np.array(ca.Function("third", [x], [ca.densify(third)])(AT[1]))
    assert not np.any(np.isfinite(found))


def test_slopes_after_a_million_turns_are_no_numbers() -> None:
    of = slopes(made("principal")[1].flow_exact())
    assert np.all(np.isfinite(of([*AT[:2], 1e4])[0]))
    assert not np.any(np.isfinite(of([*AT[:2], 1e7])[1]))


def test_a_number_without_its_slope_has_its_bits() -> None:
    """Of every exponent that a double may have, both signs, and what is no finite number."""
    still, x = made("principal")[1]._still, ca.SX.sym("x")
    made_still = ca.Function("still", [x], [still(x), ca.jacobian(still(x), x)])
    dice = np.random.default_rng(3)
    sizes = dice.uniform(1, 2, 2097) * 2.0 ** np.arange(-1073, 1024)
    given = [*sizes, *-sizes, 0.0, 5e-324, inf, -inf]
    assert [float(made_still(v)[0]) for v in given] == given
    assert np.isnan(float(made_still(nan)[0]))
    assert float(made_still(0.3)[1]) == 0
