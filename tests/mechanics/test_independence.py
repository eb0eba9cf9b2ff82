"""What constraints say is compared exactly: equal ones are told from nearly equal ones."""

from collections.abc import Sequence

import pytest
from flint import arb

from derive.library.library import Library, library
from derive.mechanics import held, independence
from derive.mechanics.independence import Independent
from derive.mechanics.mechanism import mechanism
from derive.mechanics.onto import Doubles, Onto
from derive.scene import SceneError, parse_scene
from derive.verify.measure import results
from derive.verify.prove import prove

TWO = """
wanted = ["accelerations"]
parameters.m = { unit = "kg", range = [1, 2] }
parameters.tiny = { unit = "m", value = 1e-13 }
parameters.gap = { unit = "m", value = 1e-9 }
coordinates.x = { unit = "m", range = [-1, 1] }
coordinates.y = { unit = "m", range = [-1, 1] }
frames.a.origin = ["x", "0", "0"]
frames.b.origin = ["y", "0", "0"]
bodies.a = { frame = "a", shape = "point", mass = "m" }
bodies.b = { frame = "b", shape = "point", mass = "m" }
loads.on_a = { on = "a", force = ["3", "?a_y", "?a_z"] }
loads.on_b = { on = "b", force = ["0", "?b_y", "?b_z"] }
constraints.one = { zero = "x - y" }
constraints.two = { zero = "OTHER" }
"""
ALIKE = ("x - y", "2*x - 2*y", "x^2 - y^2")
NEARLY = ("x - 1.00000001*y", "x - 1.001*y", "x - 1.5*y")


def made(other: str) -> Library:
    return library(parse_scene(TWO.replace("OTHER", other), "two"))


@pytest.mark.parametrize("other", ALIKE)
def test_what_another_says_in_other_words_is_left_out(other: str) -> None:
    own = made(other)
    rule = "says nothing that the others do not, and is left out: 'two' is 0"
    assert own.mechanism.redundant == (f"constraint 'two' {rule}",)
    at = {"m": arb(1.5)}
    assert float(results(own, own["accelerations"], at)["x_ddot"]) == pytest.approx(1, rel=1e-15)


@pytest.mark.parametrize("other", NEARLY)
def test_what_nearly_says_the_same_is_kept_and_holds_both_still(other: str) -> None:
    own = made(other)
    prove(own)
    assert own.mechanism.redundant == ()
    found = results(own, own["accelerations"], {"m": arb(1.5)})
    assert [float(x) for x in found.values()] == [0, 0]


@pytest.mark.long
@pytest.mark.parametrize("other", ["x - y - tiny", "x - 1.0000000000000001*y"])
def test_what_rounding_may_have_put_beside_another_is_left_out_and_said_to_be_off(
    other: str,
) -> None:
    (says,) = made(other).mechanism.redundant
    assert says.startswith("constraint 'two' is off where the others hold by ")
    assert says.endswith(" of a range, as rounded numbers are, and is left out: 'two' is 0")


@pytest.mark.long
def test_what_contradicts_another_is_refused() -> None:
    with pytest.raises(SceneError, match="no state of the declared ranges was found that fulfils"):
        made("x - y - gap")


def by_doubles(brings: Onto, states: Sequence[Doubles]) -> Independent:
    rows = independence._kept([brings.slopes(s) for s in states], independence.TOLD_BY_DOUBLES)
    return Independent(tuple(rows), {})


def test_doubles_take_what_nearly_says_the_same_for_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(held, "independent_conditions", by_doubles)
    own = mechanism(parse_scene(TWO.replace("OTHER", NEARLY[0]), "two"))
    assert len(own.redundant) == 1


@pytest.mark.long
@pytest.mark.parametrize("other", ["(x - y)^2", "(x - y)*(x^3 - y^3)"])
def test_a_square_that_others_hold_is_left_out_and_alone_it_is_refused(other: str) -> None:
    (says,) = made(other).mechanism.redundant
    assert "'two' says nothing that the others do not" in says
    with pytest.raises(SceneError, match="constraint 'one' changes with nothing where it is 0"):
        library(parse_scene(TWO.replace('"x - y"', f'"{other}"').replace("OTHER", "x - x"), "two"))


BENT = "sin(x/l) - sin(y/l)", "(x^2 - y^2 + 3*l*(x - y))/l + sin(x/l - y/l)*l"


@pytest.mark.parametrize(("constant", "wrong"), [("ROUNDS", 1), ("NOTHING_LEFT", 0)])
def test_a_state_that_is_followed_less_far_tells_less(
    constant: str, wrong: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = TWO.replace('zero = "x - y"', f'zero = "{BENT[0]}"').replace("OTHER", BENT[1])
    text = text.replace("parameters.m", 'parameters.l = { unit = "m", value = 1.7 }\nparameters.m')
    assert len(mechanism(parse_scene(text, "two")).held.dropped) == 1
    monkeypatch.setattr(independence, constant, wrong)
    found = mechanism(parse_scene(text, "two")).held
    assert len(found.kept) == 2 or found.off
