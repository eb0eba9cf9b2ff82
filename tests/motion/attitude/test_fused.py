"""Printed as C and compiled with fused products and sums, the formulas keep their promises.

Without -ffast-math a compiler may still fuse; what rests on exact sums must not depend on it.
"""

import ctypes
import subprocess
from fractions import Fraction
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from derive.check.compiler import find_compiler
from derive.emit.c.sines import own_sines
from derive.emit.c.text import float_body
from derive.motion.attitude.functions import FUNCTIONS
from derive.program.precision import F32, F64, Precision
from derive.program.program import Op, Program, Quantity
from tests.made import thinned
from tests.motion.attitude import cases, truth
from tests.motion.attitude.measured import PRECISIONS, error, program, promise
from tests.motion.attitude.truth import plain

FUSING = ("-O2", "-march=native", "-ffp-contract=fast", "-fPIC", "-shared")
X, POWER = (
    Quantity(name, (f"{name}_x",), (1,), "1", "", Fraction(0), Fraction(1), "a number")
    for name in ("x", "power")
)
POWER_OF_TWO = Program(
    "power_of_two", "", (X,), (POWER,), (Op("p", "power_of_two", ("x_x",)),), ("p",)
)


def text(one: Program, precision: Precision) -> str:
    kind = precision.scalar
    inputs = [f"const {kind} {q.name}[{len(q.components)}]" for q in one.inputs]
    outputs = [f"{kind} {q.name}[{len(q.components)}]" for q in one.outputs]
    head = f"void {one.name}_{precision.name}({', '.join(inputs + outputs)})"
    return "\n".join([head, "{", *float_body(one, "f", precision), "}"])


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    folder: Path = tmp_path_factory.mktemp("fused")
    every = [POWER_OF_TWO, *(program(f.name) for f in FUNCTIONS)]
    lines = ["#include <math.h>", *(own_sines("f", which) for which in (F32, F64))]
    lines += [text(p, which) for p in every for which in (F32, F64)]
    (folder / "fused.c").write_text("\n".join(lines), encoding="utf-8")
    command = (*find_compiler().command, *FUSING, "fused.c", "-o", "fused.so", "-lm")
    subprocess.run(command, cwd=folder, check=True)
    return ctypes.CDLL(str(folder / "fused.so"))


def called(library, one: Program, *given: np.ndarray) -> np.ndarray:
    dtype = given[0].dtype.type
    function = getattr(library, f"{one.name}_{'f32' if dtype is np.float32 else 'f64'}")
    found = np.zeros(len(one.results), dtype)
    arrays = [np.ascontiguousarray(g) for g in given]
    function(*(ctypes.c_void_p(a.ctypes.data) for a in (*arrays, found)))
    return found


def attitudes(dtype):
    return np.concatenate([cases.units(dtype, 40), cases.hard_units(dtype)[::3]])


SAMPLES = {
    "exp": (truth.exp, cases.rotation_vectors),
    "log": (truth.log, lambda dtype: cases.of_any_length(4, dtype)[::2]),
    "normalise": (truth.unit, partial(cases.of_any_length, 4)),
    "from_mrp": (truth.from_mrp, partial(cases.of_any_length, 3)),
    "to_mrp": (truth.mrp, attitudes),
    "to_matrix": (truth.by_column, attitudes),
    "from_euler_zyx": (partial(truth.from_euler, "zyx"), partial(cases.vectors, 40)),
    "to_euler_zyx": (partial(truth.to_euler, "zyx"), partial(cases.units, count=60)),
    "to_euler_zxz": (partial(truth.to_euler, "zxz"), partial(cases.units, count=60)),
}


@pytest.mark.parametrize("dtype", PRECISIONS)
@pytest.mark.parametrize("name", thinned(SAMPLES, 3))
def test_a_fused_formula_keeps_its_promise(name, dtype, library):
    true, samples = SAMPLES[name]
    one = program(f"quaternion_{name}")
    for given in samples(dtype):
        assert error(called(library, one, given), plain(true, given), dtype) <= promise(one.name)


@pytest.mark.parametrize("dtype", PRECISIONS)
def test_a_power_of_two_stays_one_when_it_is_fused(dtype, library):
    sizes = [s for s in cases.scales(dtype) if s < 2.0**100]
    for size in (s * k for s in sizes for k in (1, 1.3, 1.9999, 3)):
        x = np.array([size], dtype)
        assert called(library, POWER_OF_TWO, x)[0] == np.ldexp(0.5, int(np.frexp(x)[1][0]))
