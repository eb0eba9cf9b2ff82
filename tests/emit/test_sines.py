"""Sine and cosine as they are printed: the bits of a run in C and in CasADi, and true slopes."""

import ctypes
import re
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from derive.check.compiler import compiled, find_compiler
from derive.emit.c.sines import own_sines
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.emit.templates import TEMPLATES
from derive.program.arithmetic import working
from derive.program.own_sine import FITTED
from derive.program.precision import F32, F64, Precision
from tests.made import library_of

COUNTED = {"f32": 45, "f64": 52}
LOOP = """
void loop(const {0} *angle, {0} *sine, {0} *cosine, int n);
void loop(const {0} *angle, {0} *sine, {0} *cosine, int n)
{{
    for (int k = 0; k < n; ++k) {{
        const f_sines_{1} both = f_sine_cosine_{1}(angle[k]);
        sine[k] = both.sine;
        cosine[k] = both.cosine;
    }}
}}
"""


def angles(precision: Precision) -> np.ndarray:
    dice, most = np.random.default_rng(7), FITTED[precision.bits].largest
    quarters = np.arange(200) * (np.pi / 2)
    sizes = np.exp(
        dice.uniform(np.log(1e-300 if precision is F64 else 1e-37), np.log(most), 20_000)
    )
    every = np.concatenate([quarters, sizes, -sizes, [0.0, -0.0, 5e-324]])
    return every.astype(precision.dtype)


def of_c(text: str, precision: Precision, folder: Path) -> np.ndarray:
    """Return sines and cosines of the angles as a text of C gives them."""
    off = TEMPLATES.get_template("contraction_off.c.jinja").render()
    whole = f"#include <math.h>\n{off}\n{text}\n{LOOP.format(precision.scalar, precision.name)}"
    made = ctypes.CDLL(str(compiled({"s.c": whole}, "s.c", folder, find_compiler())))
    given = angles(precision)
    found = np.zeros((2, len(given)), precision.dtype)
    made.loop(*(ctypes.c_void_p(x.ctypes.data) for x in (given, found[0], found[1])), len(given))
    return found


def of_a_run(precision: Precision) -> np.ndarray:
    own = working(precision.dtype)
    return np.array([own[name](angles(precision)) for name in ("sin", "cos")])


@pytest.mark.parametrize("precision", [F32, F64], ids=lambda p: p.name)
def test_c_gives_the_bits_of_a_run(precision: Precision, tmp_path: Path) -> None:
    text = own_sines("f", precision)
    assert of_c(text, precision, tmp_path).tobytes() == of_a_run(precision).tobytes()


def test_another_order_of_a_sum_is_noticed(tmp_path: Path) -> None:
    text = own_sines("f", F64)
    changed = text.replace("((z * (z * even)) - (r * low))", "(((z * z) * even) - (r * low))")
    assert changed != text
    assert of_c(changed, F64, tmp_path).tobytes() != of_a_run(F64).tobytes()


@pytest.mark.parametrize("precision", [F32, F64], ids=lambda p: p.name)
def test_what_the_page_says_they_take_is_what_they_take(precision: Precision) -> None:
    lines = own_sines("f", precision).partition(" k = ")[2].partition("first = ")[0]
    assert len(re.findall(r" [-+*] ", lines)) == COUNTED[precision.name]
    page = (Path(__file__).parents[2] / "docs" / "code.md").read_text(encoding="utf-8")
    assert f"{COUNTED['f64']} `+ - *` in double and {COUNTED['f32']} in float" in page


@pytest.fixture(scope="module")
def module(tmp_path_factory):
    text = casadi_file(library_of("heavy_top"))
    return imported("heavy_top_casadi", text, tmp_path_factory.mktemp("sines"))


def test_casadi_gives_the_bits_of_a_run_where_it_is_built_and_inlined(module) -> None:
    def build():
        x = ca.SX.sym("x")
        return ca.Function("f", [x], [ca.vertcat(*module._sine_cosine(x))])

    given = angles(F64)
    built, x = module._built(build), ca.SX.sym("x")
    inlined = ca.Function("g", [x], [built(x)])
    for function in (built, inlined):
        found = np.array(function(given.reshape(1, -1)))
        assert (found + 0.0).tobytes() == (of_a_run(F64) + 0.0).tobytes()


def test_casadi_s_slopes_are_the_true_ones_and_far_angles_are_its_own(module) -> None:
    x = ca.SX.sym("x")
    both = module._built(lambda: ca.vertcat(*module._sine_cosine(x)))
    slope = ca.jacobian(both, x)
    own = ca.Function("own", [x], [both, slope, ca.jacobian(slope, x)])
    for angle in (0.0, 0.3, -2.0, 3.2, 700.0, 1e6, -3e9):
        value, first, second = (np.array(y).ravel() for y in own(angle))
        s, c = np.sin(angle), np.cos(angle)
        assert np.allclose(value, (s, c), rtol=3e-16, atol=0)
        assert np.allclose(first, (c, -s), rtol=3e-16, atol=0)
        assert np.allclose(second, (-s, -c), rtol=3e-16, atol=0)
    assert np.isnan(np.array(own(float("inf"))[0])).all()
