"""Links about parallel axes cost what their mass matrix in absolute angles costs by hand."""

from dataclasses import replace
from typing import TypeVar

import pytest

from derive.library.library import library
from derive.lower.arrange import by_links as ways
from derive.lower.arrange.by_links import by_links
from derive.mechanics.links import BASE, Link, Links, links
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.scene import parse_scene
from derive.verify.prove import prove
from tests.lower.chains import ON_A_CART, chain

BY_HAND = {2: 25, 3: 68, 4: 133, 5: 222, 6: 337}
"""Operations of a chain of equal rods in absolute angles, solved by L D L^T."""
MARGIN = 1.1
T = TypeVar("T")


def machine_of(text: str) -> Mechanism:
    return mechanism(parse_scene(text, "chain"))


@pytest.mark.parametrize(
    "rods", [n if n < 3 else pytest.param(n, marks=pytest.mark.long) for n in BY_HAND]
)
def test_a_planar_chain_costs_no_more_than_by_hand(rods: int) -> None:
    made = library(parse_scene(chain("y" * rods), "chain"))
    assert made["accelerations"].flops() <= MARGIN * BY_HAND[rods]
    prove(made)


@pytest.mark.parametrize("text", [chain("yy"), ON_A_CART], ids=["chain", "cart"])
def test_links_are_solved_whatever_carries_and_pushes_them(text: str) -> None:
    assert list(by_links(machine_of(text), "accelerations"))


def mutants(machine: Links) -> dict[str, Links]:
    """Return a machine with each of its data wrong, one at a time."""
    first = machine.links[0]
    place, hung = next((n, k) for n, k in enumerate(machine.links) if k.parent != BASE)
    x, y, z = hung.hinge
    at, driven = next((n, p) for n, p in enumerate(machine.pushes) if p.couple != 0)
    ((m, drift),) = machine.carried

    def other(number: int, link: Link) -> Links:
        return replace(machine, links=changed(machine.links, number, link))

    return {
        "mass": other(0, replace(first, mass=2 * first.mass)),
        "second": other(0, replace(first, second=2 * first.second)),
        "sine": other(0, replace(first, sine=-first.sine)),
        "hinge": other(place, replace(hung, hinge=(-x, y, z))),
        "gravity": replace(machine, gravity=machine.gravity[::-1]),
        "carried": replace(machine, carried=((2 * m, drift),)),
        "couple": replace(
            machine, pushes=changed(machine.pushes, at, replace(driven, couple=2 * driven.couple))
        ),
        "force": replace(machine, pushes=(*machine.pushes, machine.pushes[-1])),
        "nothing acts": replace(machine, pushes=()),
    }


def changed(values: tuple[T, ...], place: int, value: T) -> tuple[T, ...]:
    return (*values[:place], value, *values[place + 1 :])


def test_wrong_links_are_no_way(monkeypatch: pytest.MonkeyPatch) -> None:
    own = machine_of(ON_A_CART)
    sought = frozenset(own.lean("accelerations").problem.unknowns)
    right = links(own.answers.frames, sought)
    assert right is not None
    taken = {}
    for name, wrong in mutants(right).items():
        monkeypatch.setattr(ways, "links", lambda *_, wrong=wrong: wrong)
        taken[name] = len(list(by_links(own, "accelerations")))
    assert taken == dict.fromkeys(mutants(right), 0)


def test_what_does_not_turn_about_parallel_axes_is_left_to_others() -> None:
    own = machine_of(chain("yx"))
    assert not list(by_links(own, "accelerations"))
