"""What functions divide by keeps away from zero in ranges that are proved, and what tries them."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from derive.check import eva
from derive.check.eva import shown_by_eva
from derive.check.told import escaped, with_ranges
from derive.emit.c.source import c_files
from derive.program.arithmetic import working
from derive.program.precision import F32, PRECISIONS
from derive.verify.proved import divisors as made
from derive.verify.proved.bounds import ends_in_floats
from derive.verify.proved.divisors import ProvedRange, divisors
from derive.verify.proved.scaled import scaling
from tests.made import library_of

NAME, FUNCTION = "cart_pendulum", "rail"
SCALED = "tumbling_disc"


def proved(name: str, function: str, **ends: tuple[float, float]) -> tuple[ProvedRange, ...]:
    """Return the divisors of a function that are proved, over other ranges of some inputs."""
    library = library_of(name)
    program = library[function]
    own = [q for q in (*library.setup.inputs, *program.inputs) if q.role != "constants"]
    quantities = {c: q for q in own for c in q.components}
    box = {c: ends_in_floats(quantities, c, F32) for c in quantities}
    return divisors(library, program, box | ends, F32)


@pytest.mark.parametrize(("name", "function"), [
    (NAME, FUNCTION), ("gyrostat", "state_rate"), ("rolling_disc", "state_rate"),
    (SCALED, "flow_exact"), (SCALED, "plan_dmv"),
    pytest.param("acrobot", "state_rate", marks=pytest.mark.long),
])  # fmt: skip
def test_no_sample_leaves_a_range_that_is_proved(name: str, function: str) -> None:
    library, ranges = library_of(name), proved(name, function)
    for precision in PRECISIONS:
        assert escaped(library, library[function], ranges, precision) == ""
    assert ranges
    assert all(d.low > 0 or d.high < 0 or d.quotient for d in ranges)


@pytest.mark.long
def test_a_wrong_range_is_noticed() -> None:
    """Half of one, or one of the other sign: samples say what they found."""
    library, (whole,) = library_of(NAME), proved(NAME, FUNCTION)
    middle = (whole.low + whole.high) / 2
    wrong = (replace(whole, low=middle), replace(whole, high=middle),
             replace(whole, low=-whole.high, high=-whole.low))  # fmt: skip
    for mutant in wrong:
        assert "beyond what is proved" in escaped(library, library[FUNCTION], [mutant], F32)


@pytest.mark.parametrize("function", ["flow_exact", "plan_dmv"])
def test_wrong_ranges_of_quotients_are_noticed(function: str) -> None:
    """A quarter of each: rates over a power of two at or below the largest of them reach 2."""
    library = library_of(SCALED)
    every = [d for d in proved(SCALED, function) if d.quotient]
    assert every
    for d in every:
        mutant = replace(d, low=d.low / 4, high=d.high / 4)
        assert "beyond what is proved" in escaped(library, library[function], [mutant], F32)


def test_a_power_of_two_of_any_float_grows_as_the_float_does() -> None:
    """All floats between 1 and 2, and all that are too small to have as many digits."""
    power = working(np.float32)["power_of_two"]
    whole = np.arange(1 << 23, dtype=np.uint32)
    small, near = whole[1:].view(np.float32), (whole | 127 << 23).view(np.float32)
    assert (power(near) == 1).all()
    assert (power(near * np.float32(2.0**-60)) == np.float32(2.0**-60)).all()
    assert (power(small) == np.exp2(np.floor(np.log2(small.astype(float))))).all()


def test_what_grows_with_the_scale_has_no_range_of_all_scales() -> None:
    """Time over the scale grows with it; rates over it do not; nor does a value that is rounded."""
    library = library_of(SCALED)
    function = library["flow_exact"]
    steps, divided, places = made._recorded(library, function, F32)
    own = [q for q in (*library.setup.inputs, *function.inputs) if q.role != "constants"]
    quantities = {c: q for q in own for c in q.components}
    box = {c: ends_in_floats(quantities, c, F32) for c in quantities}
    first = divided[0]
    (of,) = scaling(steps, places[str(first.operands[-1])], box, F32)
    assert of.names == ("omega_x", "omega_y", "omega_z")
    assert of.ends(places[first.result]) is not None
    assert of.ends(places[str(first.operands[-1])]) is None
    assert of.ends(places["t14"]) is None


def test_what_vanishes_is_not_proved_not_to() -> None:
    """A top that stands upright has no rate of its precession."""
    assert proved("heavy_top", "state_rate")
    assert proved("heavy_top", "state_rate", theta=(-0.5, 0.5)) == ()


def test_parts_that_are_lost_are_missed(monkeypatch: Any) -> None:
    """Where carts of more than the mean mass are forgotten, samples find what is not proved."""
    whole = made.Walk._cells

    def lighter(of: made.Walk, place: int, pieces: int) -> made.Slivers:
        cells = whole(of, place, pieces)
        (low, high), k = cells.whole, cells.names.index("M")
        high[k] = (low[k] + high[k]) / 2
        return cells

    monkeypatch.setattr(made.Walk, "_cells", lighter)
    library = library_of(NAME)
    assert escaped(library, library[FUNCTION], proved(NAME, FUNCTION), F32)


def test_c_is_told_of_a_value_after_it_is_made_and_in_its_function_alone() -> None:
    text = c_files(library_of(NAME), ())[f"{NAME}_f32.c"]
    told = with_ranges(text, f"{NAME}_{FUNCTION}_f32", [ProvedRange("t13", -1.5, -0.25)])
    (line,) = [n for n, row in enumerate(told.splitlines()) if "admit" in row]
    assert re.match(r"    const float t13 = ", told.splitlines()[line - 1])
    assert "1.0F / t13" in told.splitlines()[line + 1]
    assert told.replace("    /*@ admit -1.5 <= t13 <= -0.25; */\n", "") == text


def test_c_has_the_range_of_a_quotient_that_is_proved_in_its_place() -> None:
    text = c_files(library_of(NAME), ())[f"{NAME}_f32.c"]
    (asked,) = re.findall(r"    const float (\w+) = 1.0F / t13;", text)
    told = with_ranges(
        text, f"{NAME}_{FUNCTION}_f32", [ProvedRange(asked, -4.0, 4.0, quotient=True)]
    )
    says = f"= Frama_C_float_interval(-4.0, 4.0);\n    /*@ admit -4.0 <= {asked} <= 4.0; */"
    assert told.replace(says, "= 1.0F / t13;") == text
    assert told != text


@pytest.mark.target
def test_a_range_that_contradicts_what_eva_finds_fails(monkeypatch: Any) -> None:
    """What is told of a value holds nothing that it can be: no call returns, nothing is shown."""
    library = library_of(NAME)
    monkeypatch.setattr(eva, "all_of", lambda of: [of[FUNCTION]])
    monkeypatch.setattr(eva, "escaped", lambda *_: "")
    monkeypatch.setattr(eva, "divisors", lambda *_: (ProvedRange("t13", 1e6, 2e6),))
    rows = [v for v in shown_by_eva(library) if v.function == FUNCTION]
    assert [v.outcome for v in rows] == ["FAILS", "FAILS"]
    assert all("does not return" in v.says for v in rows)


@pytest.mark.target
def test_eva_takes_what_is_proved_and_the_verdict_names_it(monkeypatch: Any) -> None:
    library = library_of(NAME)
    monkeypatch.setattr(eva, "all_of", lambda of: [of[FUNCTION]])
    rows = [v for v in shown_by_eva(library) if v.function == FUNCTION]
    assert [v.outcome for v in rows] == ["holds", "holds"]
    assert all("given what derive proves, not Eva: t13 in" in v.says for v in rows)
