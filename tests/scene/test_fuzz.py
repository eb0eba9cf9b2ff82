"""Whatever is changed in a scene, it is read or refused in one sentence: there is no third way."""

from collections.abc import Callable
from typing import Any

import pytest

from derive.check import proof
from derive.library.library import library
from derive.scene import SceneError, parse_scene
from tests.scene import fuzzed

TEXTS = fuzzed.texts()
SMALL = sorted(TEXTS, key=lambda name: (len(TEXTS[name]), name))[:45]
ROOT_OF_A_SQUARE = """
wanted = ["moment"]
parameters = { m = { unit = "kg m^2", range = [1, 2] } }
body = { kind = "spherical", moment = "sqrt(m^2)" }
"""
LONG_FORMULA = """
wanted = ["moment"]
parameters = { m = { unit = "kg m^2", range = [1, 2] } }
body = { kind = "spherical", moment = "@" }
"""


def faults(seeds: range, then: Callable[[Any], Any], names: list[str] = SMALL) -> dict[str, str]:
    """Return the seeds of changed scenes that are neither read nor refused in a sentence."""
    each = [(names[k % len(names)], f"{names[k % len(names)]} {k}") for k in seeds]
    texts = {seed: (fuzzed.changed(TEXTS[name], seed), name) for name, seed in each}
    found = {seed: fuzzed.fault(*text, then) for seed, text in texts.items()}
    return {seed: says for seed, says in found.items() if says}


def test_a_changed_scene_is_read_or_refused_in_one_sentence() -> None:
    assert faults(range(60), str) == {}
    assert faults(range(60, 75), library) == {}


@pytest.mark.long
@pytest.mark.parametrize("start", range(1000, 6000, 1000))
def test_thousands_of_changed_scenes_are_read_or_refused_in_one_sentence(start: int) -> None:
    assert faults(range(start, start + 1000), str, sorted(TEXTS)) == {}


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("start", range(10_000, 11_000, 100))
def test_programs_of_changed_scenes_are_made_or_refused_in_one_sentence(start: int) -> None:
    assert faults(range(start, start + 100), library) == {}


@pytest.mark.parametrize(
    "text",
    [
        TEXTS["rotor_whirl"].replace('"-k*y"', '"sqrt((-k*y)^2)"'),
        TEXTS["rolling_ball"].replace("[bodies.ball]", "[bodies]").replace("mass =", "# "),
    ],
)
def test_what_changes_of_scenes_brought_to_light_is_refused_in_one_sentence(text: str) -> None:
    assert fuzzed.fault(text, "odd") == ""
    with pytest.raises(SceneError):
        library(parse_scene(text, "odd"))


def test_the_root_of_the_square_of_what_is_positive_is_that() -> None:
    assert proof(library(parse_scene(ROOT_OF_A_SQUARE, "odd"))).outcome == "holds"


@pytest.mark.parametrize(
    "formula", [f"1/({'1 + m*(' * 25}m{')' * 26}", "m*1e300*1e300", "m + q" + "0" * 900]
)
def test_a_long_formula_does_not_hide_the_rule_that_it_breaks(formula: str) -> None:
    assert fuzzed.fault(LONG_FORMULA.replace("@", formula), "odd") == ""


def test_a_fault_and_a_refusal_without_a_sentence_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    long = SceneError(f"scene 'a': {'m' * fuzzed.MOST}")
    for error in (KeyError("m"), SceneError("no scene"), SceneError("scene 'a': b\nc"), long):

        def broken(text: str, name: str, error: Exception = error) -> None:
            raise error

        monkeypatch.setattr(fuzzed, "parse_scene", broken)
        assert fuzzed.fault("", "a")


def test_a_scene_that_takes_too_long_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def endless(text: str, name: str) -> None:
        while True:
            pass

    monkeypatch.setattr(fuzzed, "parse_scene", endless)
    monkeypatch.setattr(fuzzed, "SECONDS", 0.01)
    assert fuzzed.fault("", "a") == "not done within 0.01 s"
