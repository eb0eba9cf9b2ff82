"""Jacobians of accelerations come by the factors that solved these, and no solution is derived."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from bench.chains import chain
from derive.library.library import library
from derive.lower import implied as by_factors
from derive.lower.arrange.arrangement import Arrangement
from derive.lower.graph import Graph
from derive.mechanics import by_links as by_links_
from derive.mechanics.by_links import by_links
from derive.mechanics.implied import Implied, Turned
from derive.mechanics.mechanism import mechanism
from derive.scene import parse_scene
from derive.verify.prove import ProofError, prove
from tests.mechanics.chains import ON_A_CART, PUSHED

PLANAR = {2: 66, 3: 213, 4: 470, 5: 862, 6: 1415}
IN_TURN = {2: 60, 3: 434, 4: 1109, 5: 2087, 6: 3375}
"""Operations of the accelerations of equal rods with their Jacobian."""
AXES = {"parallel": ("y", PLANAR), "in turn": ("yx", IN_TURN)}
CASES = [(name, rods) for name, (_, own) in AXES.items() for rods in own]


def with_jacobian(text: str) -> str:
    return text.replace('["accelerations"]', '["accelerations_jacobian"]')


@pytest.mark.parametrize(
    ("name", "rods"),
    [case if case[1] < 3 else pytest.param(*case, marks=pytest.mark.long) for case in CASES],
)
def test_a_chain_is_linearised_by_the_factors_that_solve_it(name: str, rods: int) -> None:
    axes, most = AXES[name]
    made = library(parse_scene(with_jacobian(chain((axes * rods)[:rods])), "chain"))
    program = made["accelerations_jacobian"]
    assert program.flops() <= most[rods]
    assert program.count.get("div", 0) == rods - 1
    prove(made)


@pytest.mark.long
@pytest.mark.parametrize("text", [ON_A_CART, PUSHED], ids=["cart", "pushed"])
def test_links_that_branch_slide_and_are_pushed_are_linearised(text: str) -> None:
    made = library(parse_scene(with_jacobian(text), "chain"))
    prove(made)
    assert made["accelerations_jacobian"].sparsity


MACHINES = Path(__file__).parents[2] / "bench" / "machines"
FREE = {"satellite_with_arm": 682, "satellite_with_two_links": 2099}
"""Operations of the accelerations of links that hang on a free body, with their Jacobian."""


@pytest.mark.long
@pytest.mark.parametrize("name", ["satellite_with_arm", "satellite_with_two_links"])
def test_links_on_a_free_body_are_linearised_by_the_factors_of_the_way_that_is_taken(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (MACHINES / f"{name}.toml").read_text(encoding="utf-8")
    first, _, rest = text.partition("wanted")
    asked = f'{first}wanted = ["accelerations_jacobian"]\n{rest.partition(chr(10))[2]}'
    made = library(parse_scene(asked, "free"))
    assert made["accelerations_jacobian"].flops() <= FREE[name]
    if name == "satellite_with_arm":
        prove(made)
        monkeypatch.setattr(by_links_, "by_passes", _held_too_long)
        with pytest.raises(ProofError):
            prove(library(parse_scene(asked, "free")))


def _held_too_long(*given: Any) -> Implied:
    own = BY_PASSES(*given)
    first, *others = own.left
    return replace(own, left={first: own.left[first] / 2} | {u: own.left[u] for u in others})


BY_PASSES = by_links_.by_passes


def mutants(own: Implied) -> dict[str, Implied]:
    """Return what slopes follow from with each part of it wrong, one at a time."""
    first, *others = own.left
    pair, *_ = own.factors.below
    below = {**own.factors.below, pair: -own.factors.below[pair]}
    inverses = {u: 2 * e for u, e in own.factors.inverses.items()}
    wrong = tuple(replace(t, slopes={s: -e for s, e in t.slopes.items()}) for t in own.angles)
    alone: tuple[Turned, ...] = tuple(replace(t, parent=-1) for t in own.rates)
    return {
        "equation": replace(own, left={**own.left, first: own.left[others[0]]}),
        "factor": replace(own, factors=replace(own.factors, below=below)),
        "pivot": replace(own, factors=replace(own.factors, inverses=inverses)),
        "slope": replace(own, angles=wrong),
        "outboard": replace(own, rates=alone),
    }


@pytest.mark.parametrize("name", ["equation", "factor", "pivot", "slope", "outboard"])
def test_what_slopes_follow_from_is_not_proved_if_it_is_wrong(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = by_factors.jacobian_by_factors

    def wrong(graph: Graph, way: Arrangement, *rest):
        assert way.implied is not None
        if not way.implied.angles:
            return None
        return right(graph, replace(way, implied=mutants(way.implied)[name]), *rest)

    monkeypatch.setattr("derive.library.function.jacobian_by_factors", wrong)
    monkeypatch.setattr("derive.library.function.MANY_UNKNOWNS", 0)
    made = library(parse_scene(with_jacobian(chain("yy")), "chain"))
    with pytest.raises(ProofError):
        prove(made)


@pytest.mark.long
def test_a_chain_is_told_how_its_equations_change_with_each_absolute_angle() -> None:
    own = mechanism(parse_scene(chain("yyy"), "chain"))
    told = {how: implied for how, _, implied in by_links(own, "accelerations")}
    implied = told["absolute angles"]
    assert implied is not None
    assert [t.parent for t in implied.angles] == [t.parent for t in implied.rates] == [-1, 0, 1]
    assert told["articulated bodies"] is None
