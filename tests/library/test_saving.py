"""What choosing balances saves is told of any scene, given whole or sought."""

import pytest

from derive.library.library import library
from derive.library.saving import savings
from derive.scene import parse_scene

SCENE = """
wanted = ["moment"]
parameters.k = { unit = "N m s", range = [1, 2] }
body = { kind = "principal", moments = [1, 2, 2.5] }
known.moment = @
"""


@pytest.mark.parametrize("moment", ["[0, 0, 0]", '["-k*omega_x", "0", "1"]'])
def test_a_moment_that_is_sought_and_given_by_formulas_has_its_savings(moment: str) -> None:
    (saving,) = savings(library(parse_scene(SCENE.replace("@", moment), "sought")))
    assert saving.operations > 0
