"""Links that slide, roll and carry wheels, and what is free in space, cost less than balances."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from sympy import zeros

from derive.library.library import library
from derive.mechanics import by_links as ways
from derive.mechanics.by_links import by_links
from derive.mechanics.links import Drift, Links
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.mechanics.survey import links
from derive.scene import load
from derive.verify.prove import prove

MACHINES = Path("bench/machines")
GOVERNOR = Path(__file__).parent / "scenes" / "governor_full.toml"
COST = {"chaos_pendulum": 20, "segway": 18, "gimbals": 33, "polar_arm": 57, "unicycle": 165,
        "satellite_with_arm": 170}  # fmt: skip
"""Operations of accelerations; SymPy's method takes 31 to 282 for each."""
SHORT = ("chaos_pendulum", "segway")


@pytest.mark.parametrize(
    "name", [n if n in SHORT else pytest.param(n, marks=pytest.mark.long) for n in COST]
)
def test_what_slides_rolls_and_spins_costs_what_recursion_does(name: str) -> None:
    made = library(load(MACHINES / f"{name}.toml"))
    assert made["accelerations"].flops() <= COST[name]
    prove(made)


@pytest.mark.long
def test_angles_that_follow_one_another_by_formulas_are_one_unknown() -> None:
    made = library(load(GOVERNOR))
    assert made["theta_ddot"].flops() <= 77
    assert made["theta_ddot"].count["div"] == 1
    prove(made)


def known(name: str) -> tuple[Mechanism, Links]:
    """Return a machine and the links that it is."""
    own = mechanism(load(MACHINES / f"{name}.toml"))
    found = links(own.answers.frames, frozenset(own.lean("accelerations").problem.answers))
    assert found is not None
    return own, found


def wheel(**other: object) -> Callable[[Links], Links]:
    return lambda m: replace(m, wheels=(replace(m.wheels[0], **other), *m.wheels[1:]))


def link(place: int, **other: object) -> Callable[[Links], Links]:
    return lambda m: replace(m, links=tuple(
        replace(k, **other) if n == place else k for n, k in enumerate(m.links)
    ))  # fmt: skip


MUTANTS: dict[str, dict[str, Callable[[Links], Links]]] = {
    "unicycle": {
        "no wheel": lambda m: replace(m, wheels=()),
        "inertia": lambda m: wheel(inertia=2 * m.wheels[0].inertia)(m),
        "spin": wheel(spin=zeros(3, 1)),
        "nothing acts on the wheel": lambda m: replace(m, acting={}),
        "gravity": lambda m: replace(m, gravity=2 * m.gravity),
        "gravity along the axes of what leans": lambda m: replace(m, level=1),
        "rolling hinge is at rest": lambda m: link(
            2, drift=replace(m.links[2].drift, rest=zeros(3, 1))
        )(m),
        "spin of a frame": link(0, spin=zeros(3, 1)),
    },
    "polar_arm": {
        "sliding turns nothing aside": link(2, going=zeros(3, 1)),
        "slide": lambda m: link(2, hinge=2 * m.links[2].hinge)(m),
    },
    "satellite_with_arm": {
        "free hinge is at rest": link(1, drift=Drift(zeros(3, 1), {})),
    },
    "segway": {
        "no wheel": lambda m: replace(m, wheels=()),
        "nothing acts on the wheel": lambda m: replace(m, acting={}),
    },
}  # fmt: skip


@pytest.mark.parametrize(
    "name", [n if n in SHORT else pytest.param(n, marks=pytest.mark.long) for n in MUTANTS]
)
def test_wrong_wheels_and_slides_are_no_way(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    own, right = known(name)
    assert list(by_links(own, "accelerations"))
    taken = {}
    for what, mutant in MUTANTS[name].items():
        wrong = mutant(right)
        monkeypatch.setattr(ways, "links", lambda *_, wrong=wrong: wrong)
        taken[what] = len(list(by_links(own, "accelerations")))
    assert taken == dict.fromkeys(MUTANTS[name], 0)
