"""Links that constraints hold together: what they cost, and that a wrong way is none."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from sympy import symbols

from derive.library.library import Library, library
from derive.mechanics import held_links
from derive.mechanics.held_links import Elimination, pivot_sizes, pivots_of
from derive.scene import parse_scene
from derive.verify.prove import prove

SCENES = Path(__file__).parent / "scenes"
BY_SYMPY = {"sleigh": 40, "slider_crank_guided": 63, "four_bar_closed": 153}
"""KanesMethod with constraints, cse, LU of its matrix on symbols, counted as in bench/links.py."""
X = symbols("x:4")


def made(name: str) -> Library:
    text = (SCENES / f"{name}.toml").read_text(encoding="utf-8")
    return library(parse_scene(text, "held"))


@pytest.mark.parametrize(
    "name",
    ["sleigh", *(pytest.param(n, marks=pytest.mark.long) for n in BY_SYMPY if n != "sleigh")],
)
def test_machines_with_constraints_cost_less_than_by_kane_and_cse(name: str) -> None:
    own = made(name)
    prove(own)
    assert own["accelerations"].flops() < BY_SYMPY[name]


@pytest.mark.long
@pytest.mark.parametrize("wrong", ["_put", "_pivot_solved"])
def test_a_way_that_answers_otherwise_than_the_balances_is_none(
    wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = getattr(held_links, wrong)

    def twice(*parts: object) -> object:
        found = right(*parts)
        forms = found.values() if wrong == "_pivot_solved" else [found]
        for form in forms:
            form.update({k: 2 * x for k, x in form.items()})
        return found

    monkeypatch.setattr(held_links, wrong, twice)
    ways = made("sleigh").ways["accelerations"]
    assert "balances" in ways
    assert not any("put in" in how for how in ways)


def slopes(*each: Sequence[Sequence[float]]) -> np.ndarray:
    return np.array(each, float)


def test_what_changes_its_sign_on_the_way_is_not_divided_by() -> None:
    there_and_back = slopes([[1, 0.5]], [[-1, 0.5]])
    assert pivots_of(there_and_back, X[:2], (1, 2)) == (Elimination((0,), (X[1],)),)
    assert pivots_of(there_and_back[:, :, :1], X[:1], (1, 2)) is None


def test_two_conditions_may_be_solved_together_where_neither_is_alone() -> None:
    turns = np.linspace(0, 6, 25)
    turned = slopes(*([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]] for a in turns))
    (pivot,) = pivots_of(turned, X[:2], (1, 2)) or ()
    assert pivot == Elimination((0, 1), X[:2])
    assert min(pivot_sizes(turned, X[:2], [pivot])) >= 1
