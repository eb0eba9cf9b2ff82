"""Steps on a Cortex-M4F beside CasADi's C of the same steps, in one run."""

import pytest

from bench.on_target import apart, rows

pytestmark = pytest.mark.target
PARTS = {"step_rk4": 0.88, "step_rk4_jacobian": 0.40}
"""Of CasADi's instructions, at most."""


def test_a_step_takes_fewer_instructions_than_casadis_of_the_same_step() -> None:
    taken = {(row.author, row.function): row.instructions for row in rows()}
    for function, most in PARTS.items():
        assert 0 < taken["ours", function] <= most * taken["CasADi", function], function
    assert 0 < apart(100) < 1e-14
