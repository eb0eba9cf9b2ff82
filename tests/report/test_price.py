"""What a call takes is what its batch takes more than one without calls, at lengths of use."""

import pytest

from derive.report.price import FEWEST, MOST, STEPS, _quartiles
from derive.report.whole import lengths_of_use
from tests.report.test_sentence import made_up

CALL, BATCH = 1e-8, 1e-4
"""s of a call, and of what comes before it."""


@pytest.mark.parametrize("most", [FEWEST, MOST])
def test_what_a_batch_takes_without_calls_is_not_counted(
    most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken = {"first": 1.0}  # as where another process comes between

    def timed(_: object, rounds: int) -> float:
        return taken.pop("first", BATCH + CALL * rounds)

    monkeypatch.setattr("derive.report.price._timed", timed)
    for ns in _quartiles(lambda _: None, 1, most):
        assert ns == pytest.approx(CALL * 1e9)


def test_steps_are_timed_at_the_length_that_they_are_used_at() -> None:
    found = made_up(step_a=[1.0] * 10 + [1e-7] * 4, step_b=[1e-7] * 4)
    assert lengths_of_use(found, "f64") == {"step_a": 1 / 1024, "step_b": 1 / FEWEST}
    none = made_up(step_a=[1.0, 1e-7, 1e-7, 1e-7, 1e-3])
    assert lengths_of_use(none, "f32") == {"step_a": 1 / STEPS}
    assert lengths_of_use(None, "f32") == {}


def test_a_call_takes_time_though_other_work_comes_between(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def busy(_: object, rounds: int) -> float:
        return 0.5 if rounds == 0 else 0.02

    monkeypatch.setattr("derive.report.price._timed", busy)
    low, middle, high = _quartiles(lambda _: None, 1, 1000)
    assert 0 < low <= middle <= high
