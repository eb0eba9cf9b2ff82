"""Reactions beside accelerations, and some accelerations alone, come by the links as well."""

import pytest

from bench.chains import chain
from derive.library.library import Library, library
from derive.mechanics import beside, by_links
from derive.scene import parse_scene
from derive.verify.prove import prove

PINS = chain("yyy").replace('"?j', '"?pin')


def made(wanted: str, text: str = PINS) -> Library:
    return library(parse_scene(text.replace('["accelerations"]', f'["{wanted}"]'), "chain"))


@pytest.mark.parametrize(
    ("wanted", "name", "most", "before"),
    [
        ("q_1_ddot", "q_1_ddot", 61, 157),
        pytest.param(
            "both: accelerations, pin1, pin2, pin3", "both", 139, 200, marks=pytest.mark.long
        ),
        pytest.param("pin1", "pin1", 137, 212, marks=pytest.mark.long),
    ],
)
def test_what_is_asked_of_links_is_solved_by_their_masses(
    wanted: str, name: str, most: int, before: int
) -> None:
    own = made(wanted)
    prove(own)
    assert own.ways[name]["balances"] == before
    assert own[name].flops() <= most


@pytest.mark.long
def test_reactions_change_with_what_is_given_as_their_proof_says() -> None:
    own = made("both_jacobian: accelerations, pin1, pin2", chain("yy").replace('"?j', '"?pin'))
    prove(own)
    assert own["both_jacobian"].sparsity


@pytest.mark.long
def test_a_reaction_of_the_wrong_sign_is_no_way(monkeypatch: pytest.MonkeyPatch) -> None:
    right = beside.reactions

    def wrong(*of):
        found = right(*of)
        last = [*found][-1]
        return {**found, last: -found[last]}

    monkeypatch.setattr(by_links, "reactions", wrong)
    assert [*made("both: accelerations, pin1, pin2", chain("yy").replace('"?j', '"?pin'))
            .ways["both"]] == ["balances"]  # fmt: skip
