"""A machine that cannot be answered is refused by one sentence that names what is wrong."""

import tomllib
from pathlib import Path

import pytest

from derive.library.library import library
from derive.mechanics.contradiction import _contradicted as contradicted
from derive.mechanics.contradiction import _least as least
from derive.mechanics.contradiction import contradiction
from derive.mechanics.mechanism import mechanism
from derive.scene import CATALOGUE, SceneError, parse_scene

EDITS = tomllib.loads((Path(__file__).parent / "refusals.toml").read_text(encoding="utf-8"))["edit"]
EDGE = (CATALOGUE / "edge_runner_flat.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("edit", EDITS, ids=[e["says"][:50] for e in EDITS])
def test_an_edit_that_breaks_a_rule_is_refused_by_its_sentence(edit: dict[str, str]) -> None:
    assert edit["old"] in EDGE
    text = EDGE.replace(edit["old"], edit["new"])
    with pytest.raises(SceneError) as refusal:
        library(parse_scene(text, "edge_runner_flat"))
    assert str(refusal.value).startswith(f"scene 'edge_runner_flat': {edit['says']}")


def test_the_balances_that_are_named_contradict_each_other_and_no_fewer_do() -> None:
    machine = parse_scene(EDGE.replace('"?friction", "?N"', '"0.1*?N", "?N"'), "edge")
    balances = mechanism(machine).answers.balances
    together = least(contradicted(balances.rows, 0), 0)
    assert contradicted(together, 0)
    for one in together:
        assert str(one.balance) in contradiction(balances)
        assert not contradicted([row for row in together if row is not one], 0)


def test_a_parameter_that_nothing_uses_is_a_warning() -> None:
    text = EDGE.replace("[speeds]", 'idle = { unit = "m", range = [1, 2] }\n\n[speeds]')
    assert parse_scene(text, "edge").warnings == ("parameter 'idle' is not used",)
    assert parse_scene(EDGE, "edge").warnings == ()
