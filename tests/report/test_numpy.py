"""Without a compiler a report's motions are run by NumPy, and end where those of C do."""

from pathlib import Path

import numpy as np
import pytest

from derive.check.compiler import CompilerError
from derive.program.precision import PRECISIONS
from derive.report.driver import Driver, drivers
from derive.report.march import ended
from derive.report.price import nanoseconds
from derive.report.states import Begun, begun
from derive.verify.operators import Column
from tests.made import library_of

STEPS = 16
"""Roundings of so many steps, each of some dozens in a row, are what may differ."""
LENGTH = 1 / 256


def none() -> None:
    raise CompilerError("there is none")


@pytest.mark.long
def test_without_a_compiler_motions_end_where_those_of_c_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    library = library_of("tumbling_disc")
    start = begun(library, "without a compiler", 8)
    steps = [p.name for p in library.motions if p.name in ("step_rk4", "flow_exact")]
    compiled = drivers(library, PRECISIONS, tmp_path)
    monkeypatch.setattr("derive.report.driver.find_compiler", none)
    plain = drivers(library, PRECISIONS, tmp_path)
    assert steps
    for by_c, by_numpy in zip(compiled, plain, strict=True):
        assert by_c.shared is not None
        assert by_numpy.shared is None
        assert nanoseconds(by_numpy, "fast", library.functions, None, {}) == []
        for step in steps:
            found, should = (_end(by, step, start) for by in (by_numpy, by_c))
            largest = np.max(np.abs(should), axis=1, keepdims=True)
            u = by_c.precision.unit_roundoff
            assert np.max(np.abs(found - should) / largest) < 64 * STEPS * u
            moved = np.max(np.abs(should - _begin(by_c, start)) / largest)
            assert moved > 1e-3  # or there was nothing to compare


def _end(by: Driver, step: str, start: Begun) -> Column:
    return ended(by, step, start, LENGTH * STEPS, STEPS)


def _begin(by: Driver, start: Begun) -> Column:
    names = [c for q in by.library.vocabulary.states for c in q.components]
    return start.columns[[start.names.index(c) for c in names]]
