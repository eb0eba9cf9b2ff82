"""Entries of Jacobians err by what is left of their terms, not by what cancels in them."""

import pytest

from derive.library.library import library
from derive.lower import forms
from derive.scene import parse_scene
from tests.verify.gyrostats import largest_error, satellite

REMAINS = 1024
"""u of the largest term left: some ten roundings of it, each up to a hundred times larger where
moments differ by less than themselves, as 12/25 K^2 (1/B - 1/C) does."""
JACOBIAN = '["state_rate_jacobian"]'


@pytest.mark.long
@pytest.mark.whole
@pytest.mark.parametrize("seed", [1, 2, 3, 7, 9, 11, 13])
def test_wheels_askew_of_any_number_on_any_body_lose_no_more_than_their_terms(seed):
    made = library(parse_scene(satellite(seed, JACOBIAN), "walk"))
    for sample in range(3):
        error, entry = largest_error(made, f"{seed} {sample}")
        assert 0 < error < REMAINS, entry


@pytest.mark.long
@pytest.mark.whole
def test_what_cancels_is_found_in_the_errors_where_it_is_computed(monkeypatch):
    monkeypatch.setattr(forms, "what_is_left", lambda _, found: [tuple(f) for f in found])
    made = library(parse_scene(satellite(3, JACOBIAN), "walk"))
    assert max(largest_error(made, f"3 {sample}")[0] for sample in range(3)) > 4 * REMAINS
