"""Units: coherent SI only, and every sum agrees in dimension."""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.scene.grammar import parse
from derive.scene.unit import UnitError, dimension, dimension_of, spelled

DIMENSIONS = {
    "m": dimension("kg"),
    "r": dimension("m"),
    "W": dimension("rad/s"),
    "theta": dimension("rad"),
}


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("N", "kg m/s^2"),
        ("N m", "J"),
        ("W", "J/s"),
        ("Pa", "N/m^2"),
        ("rad/s", "1/s"),
        ("kg·m^2", "kg m2"),
        ("kg*m^2", "kg m^2"),
        ("m/s/s", "m s^-2"),
        ("N m/rad", "N m"),
    ],
)
def test_two_spellings_of_a_unit_are_one_dimension(one: str, other: str) -> None:
    assert dimension(one) == dimension(other)


@pytest.mark.parametrize(
    ("unit", "says"),
    [
        ("deg", "unit 'deg' is not coherent SI: give 'rad', not 'deg'"),
        ("rpm", "unit 'rpm' is not coherent SI: give 'rad/s', not 'rpm'"),
        ("N mm", "unit 'N mm' is not coherent SI: give 'm', not 'mm'"),
        ("g", "unit 'g' is not coherent SI: give 'kg', not 'g'"),
        ("foo", "unit 'foo' has an unknown part 'foo' (known: 1, rad, m, kg, s, N, J, W, Pa)"),
        ("", "unit '' cannot be read at 1"),
        ("kg  m^", "unit 'kg  m^' cannot be read at 6"),
        ("kg/", "unit 'kg/' cannot be read at 4"),
        ("J/kg m", "unit 'J/kg m' is ambiguous: divide by each factor with its own '/'"),
    ],
)
def test_a_unit_that_is_not_coherent_si_is_refused(unit: str, says: str) -> None:
    with pytest.raises(UnitError) as refusal:
        dimension(unit)
    assert str(refusal.value) == says


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("m*r^2/2", "kg m^2"),
        ("sqrt(m*r^2/m)", "m"),
        ("m*r*W^2", "N"),
        ("-r*sin(theta/2)", "m"),
        ("m/r^-1", "kg m"),
        ("W*theta + W", "rad/s"),
        ("1/2", "1"),
    ],
)
def test_a_formula_has_the_dimension_that_its_factors_have(text: str, unit: str) -> None:
    assert dimension_of(parse(text), DIMENSIONS) == dimension(unit)


def test_zero_agrees_with_every_dimension() -> None:
    assert dimension_of(parse("0"), DIMENSIONS) is None


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("m + r", "'m + r' joins 'm' in kg and 'r' in m"),
        ("r - 1", "'r - 1' joins 'r' in m and '1' in 1"),
        ("sin(W)", "'sin(W)' needs an angle or a plain number, not rad/s"),
        ("cos(r)*m", "'cos(r)' needs an angle or a plain number, not m"),
    ],
)
def test_terms_that_do_not_agree_are_refused(text: str, says: str) -> None:
    with pytest.raises(UnitError) as refusal:
        dimension_of(parse(text), DIMENSIONS)
    assert str(refusal.value) == says


@given(st.tuples(*[st.integers(-4, 4)] * 3))
def test_a_dimension_that_is_spelled_and_read_again_is_the_same(powers: tuple[int, ...]) -> None:
    unit = " ".join(f"{name}^{power}" for name, power in zip(("m", "kg", "s"), powers, strict=True))
    assert dimension(spelled(dimension(unit))) == dimension(unit)


@given(st.text())
def test_any_text_is_a_unit_or_a_unit_error(text: str) -> None:
    with suppress(UnitError):
        assert len(dimension(text)) == len(dimension("1"))
