"""Columns of doubles and balls tell the same errors: one steers the search, the other is stated."""

import numpy as np
import pytest

from derive.program.precision import PRECISIONS, Precision
from derive.scene import catalogue
from derive.verify.columns import arithmetics, supplied
from derive.verify.draw import Sampled
from derive.verify.sample import samples
from derive.verify.search import errors_at
from derive.verify.stated import at_samples
from tests.made import library_of, thinned

SAMPLES = 12
SAME = 1e-6
CASES = [(name, precision) for name in catalogue() for precision in PRECISIONS]


@pytest.mark.long
@pytest.mark.parametrize("case", thinned(CASES, 12), ids=lambda case: f"{case[0]}-{case[1].name}")
def test_errors_in_columns_are_those_in_balls(case: tuple[str, Precision]) -> None:
    name, precision = case
    made = library_of(name)
    if not made.functions:
        pytest.skip(f"{name} wants formulas of motion alone")
    each = samples(made.mechanism, precision, SAMPLES, 0).each[:SAMPLES]
    of = Sampled(made, precision)
    columns = {n: np.array([s.values[n] for s in each], precision.dtype) for n in each[0].values}
    at = supplied(of.setup, columns, arithmetics(precision.dtype))
    compared = 0
    for plan in (p for p in of.plans if p.program in made.functions):
        exact = at_samples(of, plan.program, each)
        for quick, slow in zip(errors_at(of, plan, at), exact, strict=True):
            wanted = np.array(slow.largest(), float)
            assert np.max(quick, axis=0) == pytest.approx(wanted, rel=SAME, abs=SAME)
            compared += 1
    assert compared
