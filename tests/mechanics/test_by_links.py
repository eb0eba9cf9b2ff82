"""Machines of links cost what they cost by hand or less, whatever they carry."""

from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import pytest

from bench.arms import arm
from bench.chains import chain
from derive.library.library import library
from derive.mechanics import balances
from derive.mechanics import by_links as ways
from derive.mechanics.by_links import by_links
from derive.mechanics.links import BASE, Link, Links
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.mechanics.survey import links
from derive.scene import parse_scene
from derive.verify.prove import prove
from tests.mechanics.chains import ON_A_CART, PUSHED, driven

PLANAR = {2: 25, 3: 71, 4: 134, 5: 187, 6: 240, 10: 452}
"""Operations of a chain of equal rods; absolute angles and L D L^T by hand take 25 to 337."""
IN_TURN = {2: 23, 3: 119, 4: 247, 5: 412, 12: 2112}
"""Operations of a chain of equal rods with axes in turn; a plain recursion takes 46 to 555."""
T = TypeVar("T")


def machine_of(text: str) -> Mechanism:
    return mechanism(parse_scene(text, "chain"))


@pytest.mark.parametrize(
    "rods", [n if n < 3 else pytest.param(n, marks=pytest.mark.long) for n in PLANAR]
)
def test_a_planar_chain_takes_the_same_for_each_rod_from_four_on(rods: int) -> None:
    made = library(parse_scene(chain("y" * rods), "chain"))
    assert made["accelerations"].flops() <= PLANAR[rods]
    prove(made)


@pytest.mark.parametrize(
    "rods", [n if n < 3 else pytest.param(n, marks=pytest.mark.long) for n in IN_TURN]
)
def test_a_chain_with_axes_in_turn_costs_less_than_a_plain_recursion(rods: int) -> None:
    made = library(parse_scene(chain(("yx" * rods)[:rods]), "chain"))
    assert made["accelerations"].flops() <= IN_TURN[rods]
    prove(made)


ARM = (Path(__file__).parent / "arm.toml").read_text(encoding="utf-8")
WAYS = {
    "arm": (ARM, 4),
    "chain": (chain("yy"), 5),
    "in turn": (chain("yx"), 3),
    "pushed": (PUSHED, 5),
    "cart": (ON_A_CART, 7),
}
"""Machines, and in how many ways they are solved: by systems, each in some orders, one by one."""


@pytest.mark.parametrize(
    "name", [n if n == "pushed" else pytest.param(n, marks=pytest.mark.long) for n in WAYS]
)
def test_links_are_solved_whatever_carries_and_pushes_them(name: str) -> None:
    text, ways_ = WAYS[name]
    assert len(list(by_links(machine_of(text), "accelerations"))) == ways_


@pytest.mark.long
def test_a_long_chain_is_solved_without_a_matrix() -> None:
    ways_ = [how for how, *_ in by_links(machine_of(chain("y" * 11)), "accelerations")]
    assert ways_ == [ways.ARTICULATED]


@pytest.mark.long
def test_the_moments_that_drive_a_chain_come_out_of_the_passes_alone() -> None:
    made = library(parse_scene(driven("yxy"), "chain"))
    assert [made[f"T_{k}"].flops() for k in (1, 2, 3)] <= [81, 30, 36]
    assert all("div" not in made[f"T_{k}"].count for k in (1, 2, 3))
    prove(made)


@pytest.mark.parametrize(
    ("axes", "most"), [("zyx", 198), pytest.param("zyzyzyz", 690, marks=pytest.mark.long)]
)
def test_the_moments_that_drive_an_arm_cost_what_recursion_in_the_best_axes_costs(
    axes: str, most: int
) -> None:
    made = library(parse_scene(arm(axes), "arm"))
    assert made["drives"].flops() <= most
    prove(made)


@pytest.mark.long
def test_a_hinge_stands_on_its_axis_nearest_to_what_carries_it() -> None:
    own = machine_of(arm("zyx"))
    sought = frozenset(own.lean("drives").problem.answers)
    found = links(own.answers.frames, sought)
    assert found is not None
    assert [k.hinge[k.axis] for k in found.links] == [0, 0, 0]
    assert len(list(by_links(own, "drives"))) == 1


@pytest.mark.long
def test_reactions_that_balances_hold_beside_what_is_sought_are_left_to_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(balances, "MOST_TOGETHER", 2)
    own = machine_of(driven("yxy"))
    assert len(own.lean("T_1").problem.unknowns) > 1
    assert len(list(by_links(own, "T_1"))) == 1


def mutants(machine: Links) -> dict[str, Links]:
    """Return a machine with each of its data wrong, one at a time."""
    first = machine.links[0]
    place, hung = next((n, k) for n, k in enumerate(machine.links) if k.parent != BASE)
    bulk = first.bulk
    ((m, drift),) = machine.carried

    def other(number: int, link: Link) -> Links:
        return replace(machine, links=changed(machine.links, number, link))

    return {
        "mass": other(0, replace(first, bulk=replace(bulk, mass=2 * bulk.mass))),
        "second": other(0, replace(first, bulk=replace(bulk, second=2 * bulk.second))),
        "sine": other(0, replace(first, sine=-first.sine)),
        "hinge": other(place, replace(hung, hinge=2 * hung.hinge)),
        "gravity": replace(machine, gravity=2 * machine.gravity),
        "carried": replace(machine, carried=((2 * m, drift),)),
        "motors": replace(machine, motors={}),
        "force": replace(machine, pushes=(*machine.pushes, machine.pushes[-1])),
        "nothing acts": replace(machine, pushes=()),
    }


def changed(values: tuple[T, ...], place: int, value: T) -> tuple[T, ...]:
    return (*values[:place], value, *values[place + 1 :])


@pytest.mark.long
def test_wrong_links_are_no_way(monkeypatch: pytest.MonkeyPatch) -> None:
    own = machine_of(ON_A_CART)
    sought = frozenset(own.lean("accelerations").problem.answers)
    right = links(own.answers.frames, sought)
    assert right is not None
    taken = {}
    for name, wrong in mutants(right).items():
        monkeypatch.setattr(ways, "links", lambda *_, wrong=wrong: wrong)
        taken[name] = len(list(by_links(own, "accelerations")))
    assert taken == dict.fromkeys(mutants(right), 0)
