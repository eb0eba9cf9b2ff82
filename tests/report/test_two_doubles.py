"""Motions followed in C end where those of 128 bits do, and rates take no more than they need."""

from dataclasses import replace
from pathlib import Path

import pytest
from flint import arb, ctx

from derive.check.compiler import CompilerError
from derive.library.library import Library, library
from derive.report.extrapolation import extrapolated, rule_for
from derive.report.rate import RateOfState, rate_of_state
from derive.report.reference import BITS, end_of
from derive.report.states import begun
from derive.report.two_doubles import extrapolation_made, taken_in_c
from derive.scene import parse_scene
from derive.verify.convergence import unit_attitude
from tests.made import library_of

TURN = 0.002
"""s: of the catalogue's fastest scenes here, a small part of a turn."""
SAME = 1e-27
"""Relative: sums of two doubles have 32 digits, of which products that cancel take some."""
BODY = """
wanted = ["step_rk4"]
axes = {{ attitude = "quaternion" }}
body = {{ kind = "principal", moments = ["A", "{0}", "C"] }}
known = {{ moment = [0, 0, 0] }}
[parameters]
A = {{ unit = "kg m^2", range = [1, 2], meaning = "moment about x" }}
C = {{ unit = "kg m^2", range = [2, 2.5], meaning = "moment about z" }}
"""


def moving(own: Library) -> tuple[RateOfState, list[arb]]:
    """Return the rate of a state of a scene, and that state."""
    given = unit_attitude(own, {c: arb(x) for c, x in begun(own, "test", 4).values(1).items()})
    state = [given[c] for q in own.vocabulary.states for c in q.components]
    return rate_of_state(own, given), state


def gap(found: list[arb], should: list[arb]) -> float:
    size = max(abs(float(x)) for x in should)
    return max(abs(float(a - b)) for a, b in zip(found, should, strict=True)) / size


# sines; blocks of several unknowns; a quaternion; rotors
@pytest.mark.parametrize("name", ["heavy_top", "acrobot", "rattleback", "tumbling_body"])
def test_a_length_in_c_ends_where_one_in_long_floats_does(name: str, tmp_path: Path) -> None:
    made = extrapolation_made(tmp_path)
    assert made is not None
    with ctx.workprec(BITS):
        rate, state = moving(library_of(name))
        by_c = taken_in_c(made, rate)
        assert by_c is not None
        found, left = by_c(state, TURN)
        should, more = extrapolated(rule_for(rate, state, 100.0).begun(state), TURN)
        assert gap(found, should) < SAME + max(left, more)
        assert max(left, more) < 1e-19
        other = replace(rate, numbers=[x if x is None else x * (1 + arb(1e-20)) for x in
                                       rate.numbers])  # fmt: skip
        changed = taken_in_c(made, other)
        assert changed is not None
        assert gap(changed(state, TURN)[0], should) > 10 * SAME


@pytest.mark.long
def test_a_motion_in_c_ends_where_one_in_long_floats_does(tmp_path: Path) -> None:
    own = library_of("sleeping_top")
    values = begun(own, "test", 4).values(1)
    made = extrapolation_made(tmp_path)
    plain, by_c = (end_of(own, values, 0.5, 30.0, by) for by in (None, made))
    with ctx.workprec(BITS):
        ends = ([arb(a) + arb(b) for a, b in end.state.values()] for end in (plain, by_c))
        assert gap(*ends) < 1e-19  # a length leaves 1e-20
    assert 0 < by_c.work < 2 * plain.work


@pytest.mark.long
def test_equations_that_c_is_not_told_are_left_to_long_floats(tmp_path: Path) -> None:
    made = extrapolation_made(tmp_path)
    assert made is not None
    with ctx.workprec(BITS):
        rate, _ = moving(library_of("sleeping_top"))
    assert taken_in_c(made, replace(rate, lines=(*rate.lines, ("tanh", (0, 0))))) is None
    many = ("solve", (0, 100, *range(100 * 102)))
    assert taken_in_c(made, replace(rate, lines=(*rate.lines, many))) is None


def test_without_a_compiler_no_lengths_are_taken_in_c(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def none() -> None:
        raise CompilerError("there is none")

    monkeypatch.setattr("derive.report.two_doubles.find_compiler", none)
    assert extrapolation_made(tmp_path) is None


@pytest.mark.long
def test_what_rests_on_held_numbers_alone_is_worked_out_once() -> None:
    with ctx.workprec(BITS):
        few, many = (moving(library(parse_scene(BODY.format(b), "body")))[0]
                     for b in ("(A + C)/2", "sqrt(A*C) + A/8 - C/16"))  # fmt: skip
    assert few.count == many.count > 10
