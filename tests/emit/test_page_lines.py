"""Pages write the equations of short functions as by hand, and those of long ones as they come."""

from typing import Any

import pytest
from sympy import Expr

from derive.emit.page import equation
from tests.made import library_of


@pytest.mark.long
def test_only_functions_of_few_lines_are_written_as_by_hand(monkeypatch: Any) -> None:
    """Of as many lines as are neat both sides of each are tidied; with one more, none."""
    mechanism, tidied = library_of("acrobot").mechanism, list[Expr]()

    def kept(value: Expr) -> Expr:
        tidied.append(value)
        return value

    monkeypatch.setattr(equation, "neatened", kept)
    lines = [line for each in equation.passages(mechanism, "state_rate") for line in each.lines]
    assert len(tidied) == 2 * len(lines) > 0
    for most, sides in ((len(lines), 2), (len(lines) - 1, 0)):
        monkeypatch.setattr(equation, "NEAT", most)
        tidied.clear()
        equation.passages(mechanism, "state_rate")
        assert len(tidied) == sides * len(lines)
