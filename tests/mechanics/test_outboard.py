"""Balances of outboard bodies say what the vectors of all these bodies do, and enough of them."""

from dataclasses import replace
from pathlib import Path

import pytest

from bench.chains import chain
from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.choice import chosen
from derive.mechanics.mechanism import mechanism
from derive.mechanics.outboard import outboard, write_out
from derive.mechanics.probe import NOTHING, independent, random_probe
from derive.scene import parse_scene
from tests.mechanics.chains import ON_A_CART

ARM = (Path(__file__).parent / "arm.toml").read_text(encoding="utf-8")
MACHINES = {"arm": ARM, "cart": ON_A_CART, "in turn": chain("yxy")}
CHAIN = chain("yyyyyyyy")


def balances_of(text: str) -> Balances:
    return mechanism(parse_scene(text, "machine")).answers.balances


def untrue(balances: Balances, rows: list[ValuedBalance]) -> list[str]:
    """Return balances whose coefficients, as written, have other values at the trial point."""
    sheet = balances.frames.sheet
    probe = random_probe(balances.frames.words, 0)
    probe.define(sheet.definitions)
    found = []
    for row in rows:
        rest, slopes = sheet.split(balances.written(row))
        written = [rest, *(slopes.get(u, 0 * rest) for u in balances.unknowns)]
        size = max(map(abs, row.values[0]))
        pairs = zip(map(probe.value, written), row.values[0], strict=True)
        if any(abs(one - other) > NOTHING * size for one, other in pairs):
            found.append(str(row.balance))
    return found


@pytest.mark.parametrize(
    "name", [n if n == "in turn" else pytest.param(n, marks=pytest.mark.long) for n in MACHINES]
)
def test_balances_written_by_two_passes_say_what_vectors_do(name: str) -> None:
    balances = balances_of(MACHINES[name])
    of = outboard(balances)
    write_out(balances, [*of], of)
    assert not untrue(balances, [*of])


def test_a_load_that_is_left_out_or_a_body_that_is_moved_is_seen() -> None:
    right = balances_of(MACHINES["in turn"])
    of, efforts = outboard(right), right.sides.efforts
    last, moment = "rod3", 2 * efforts["rod3"].moment
    heavier = {**efforts, last: replace(efforts[last], moment=moment)}
    wrong = (
        replace(right.sides, wrenches=right.sides.wrenches[1:]),
        replace(right.sides, efforts=heavier),
    )
    for sides in wrong:
        own = Balances(right.frames)
        own.sides = sides
        write_out(own, [*of], of)
        assert untrue(own, [*of])


@pytest.mark.long
def test_the_balances_of_single_bodies_span_all_others() -> None:
    balances = balances_of(MACHINES["in turn"])

    def rank(rows: tuple[ValuedBalance, ...]) -> int:
        return len(independent([dict(enumerate(row.values[0])) for row in rows], 1000))

    assert rank(balances.spanning) == rank((*balances.spanning, *balances.rows)) == 18
    assert rank(balances.spanning[1:]) < 18


@pytest.mark.long
def test_a_long_chain_has_a_balance_a_joint_and_no_others_valued() -> None:
    balances = balances_of(CHAIN)
    free = [f"q_{k}_ddot" for k in range(1, 9)]
    wanted = frozenset(balances.unknowns.index(balances.frames.sheet.symbols[n]) for n in free)
    rows, unknowns = chosen(balances, wanted)
    assert unknowns == wanted
    assert sorted(len(row.balance.bodies) for row in rows) == [1, 2, 3, 4, 5, 6, 7, 8]
    assert "rows" not in balances.__dict__
