"""Euler's theorem finds the quantities that trying all of them would find, in few steps."""

from fractions import Fraction
from itertools import combinations, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derive.lower.homogeneous import degrees_that_sum
from tests.made import library_of


def by_trying_all(rows):
    """Return the first choice that holds: fewest quantities, first of these, lowest powers."""
    for size in range(1, len(rows[0]) + 1):
        for chosen in combinations(range(len(rows[0])), size):
            for each in product((1, 2), repeat=size):
                if all(adds_up([row[q] for q in chosen], each) for row in rows):
                    return dict(zip(chosen, each, strict=True))
    return None


def adds_up(degrees, each):
    if None in degrees:
        return False
    return sum(Fraction(d, k) for d, k in zip(degrees, each, strict=True)) == 1


DEGREES = st.sampled_from([0, 0, 0, 1, 1, 2, 3, None])
"""Degrees of a monomial in a quantity; None where it is divided by."""


@st.composite
def homogeneous(draw):
    """Return rows of degrees of which one choice, at least, holds."""
    share = [Fraction(draw(st.integers(0, 2)), 2) for _ in range(draw(st.integers(1, 5)))]
    rows = product(range(3), repeat=len(share))
    held = [r for r in rows if sum(d * x for d, x in zip(r, share, strict=True)) == 1]
    return draw(st.lists(st.sampled_from(held), min_size=1, max_size=6)) if held else [(0,)]


@given(st.integers(1, 5).flatmap(
    lambda n: st.lists(st.tuples(*[DEGREES] * n), min_size=1, max_size=5)))  # fmt: skip
def test_any_degrees_give_the_choice_of_trying_all(rows):
    assert degrees_that_sum(rows) == by_trying_all(rows)


@pytest.mark.long
@given(homogeneous())
def test_degrees_that_a_choice_holds_for_give_the_choice_of_trying_all(rows):
    assert degrees_that_sum(rows) == by_trying_all(rows)


def row(*places):
    """Return the degrees of a product of the quantities at ``places``, of sixteen."""
    return tuple(places.count(q) for q in range(16))


SIXTEEN = {
    "all apart": [row(q, q) for q in range(16)],
    "in pairs": [row(q, q + 1) for q in range(0, 16, 2)],
    "in a chain": [row(q, q + 1) for q in range(15)],
    "each of eight by each of eight": [row(a, 8 + b) for a in range(8) for b in range(8)],
    "in a ring of an odd number, and a cube": [row(q, (q + 1) % 15) for q in range(15)]
    + [row(15, 15, 15)],
    "every two, and a third": [row(a, b) for a in range(16) for b in range(a)] + [row(0, 1, 2)],
}


@pytest.mark.parametrize("case", SIXTEEN)
def test_sixteen_quantities_take_at_most_a_hundred_steps(case):
    assert degrees_that_sum(SIXTEEN[case], 100) == degrees_that_sum(SIXTEEN[case])


def test_a_search_that_takes_too_many_steps_finds_nothing():
    assert degrees_that_sum(SIXTEEN["in a chain"]) == dict.fromkeys(range(0, 16, 2), 1)
    assert degrees_that_sum(SIXTEEN["in a chain"], 8) is None


@pytest.mark.long
def test_a_body_of_thirteen_states_and_its_loads_has_a_cheap_jacobian():
    """Sixteen inputs move its rate: to try each with each power takes hours."""
    program = library_of("tests/data/long_form/rigid_body.toml")["state_rate_jacobian"]
    assert program.flops() <= 210
