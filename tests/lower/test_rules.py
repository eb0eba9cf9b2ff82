"""Each rule of arrangement saves operations somewhere, and a wrong one is caught by the proof."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from sympy import Matrix

from derive.library.library import library
from derive.lower.arrange import column, plan
from derive.lower.arrange.block import BlockRule, LinearSystem, Solution, Solve
from derive.lower.arrange.constant_coefficients import constant_coefficients
from derive.lower.arrange.constant_tensor import constant_tensor
from derive.lower.arrange.quaternion import quaternion_rate, turned_by_quaternion
from derive.lower.arrange.spherical_part import spherical_part
from derive.lower.arrange.turns import turns_one_by_one
from derive.scene import Scene, load
from derive.verify.prove import ProofError, prove
from tests.lower.test_long_form import CATALOGUE, LONG, operations

Either = BlockRule | column.ColumnRule
SCENES = Path(__file__).parent.parent / "mechanics" / "scenes"
CASES: dict[Either, tuple[Path, str]] = {
    constant_tensor: (LONG / "free_body.toml", "acceleration"),
    constant_coefficients: (SCENES / "hoop_pole.toml", "pin"),
    spherical_part: (LONG / "gyrostat.toml", "acceleration"),
    turns_one_by_one: (CATALOGUE / "centrifuge_gondola.toml", "M"),
    turned_by_quaternion: (LONG / "rigid_body.toml", "state_rate"),
    quaternion_rate: (LONG / "rigid_body.toml", "state_rate"),
}
AT_ONCE = (constant_tensor,)
RULES = pytest.mark.parametrize(
    "rule",
    [rule if rule in AT_ONCE else pytest.param(rule, marks=pytest.mark.long) for rule in CASES],
    ids=lambda rule: rule.__name__,
)


def shown_by(rule: Either) -> tuple[Scene, str]:
    """Return the scene and the function that a rule is shown by."""
    path, name = CASES[rule]
    scene = load(path)
    return replace(scene, wanted=(name,)), name


def exchange(patch: pytest.MonkeyPatch, rule: Either, others: tuple[Either, ...]) -> None:
    """Put other rules in the place of one."""
    for name in ("OF_COLUMNS", "OF_ANSWERS", "OF_ROWS", "OF_BLOCKS"):
        each = [others if r is rule else (r,) for r in getattr(plan, name)]
        patch.setattr(plan, name, tuple(r for group in each for r in group))


@RULES
def test_without_a_rule_a_scene_takes_more_operations(
    rule: Either, monkeypatch: pytest.MonkeyPatch
) -> None:
    with_it = operations(*shown_by(rule))
    exchange(monkeypatch, rule, ())
    assert operations(*shown_by(rule)) > with_it


def of_wrong_sign(column: Matrix) -> Matrix:
    return Matrix([-column[0], *column[1:]])


def of_wrong_index(column: Matrix) -> Matrix:
    return Matrix(column[::-1])


def wrong(rule: Callable[..., Any], change: Callable[[Matrix], Matrix]) -> Callable[..., object]:
    """Return a rule that changes the right side of a block, or the column that it gives."""

    def of_block(found: Solution, block: LinearSystem, rest: Solve) -> bool:
        return rule(found, replace(block, right=change(block.right)), rest)

    def of_column(values: Matrix, known: column.NamedColumns) -> Matrix | None:
        made = rule(values, known)
        return None if made is None else change(made)

    return of_block if rule in plan.OF_BLOCKS else of_column


@pytest.mark.parametrize(
    "change", [of_wrong_sign, pytest.param(of_wrong_index, marks=pytest.mark.long)]
)
@RULES
def test_a_wrong_rule_is_caught_by_the_proof(
    rule: Either, change: Callable[[Matrix], Matrix], monkeypatch: pytest.MonkeyPatch
) -> None:
    scene, _ = shown_by(rule)
    prove(library(scene))
    exchange(monkeypatch, rule, (wrong(rule, change),))
    with pytest.raises(ProofError, match="is off by"):
        prove(library(scene))
