"""The checker itself: it sees only the reasons, notices what is wrong, lets no claim slip in."""

import re
from dataclasses import replace

import pytest
from sympy import Symbol, symbols

from derive.lecture.chapters import LECTURE
from derive.lecture.chapters.letters import F_i, I, M, Omega, P_ij, dm, l, omega, r, rho
from derive.lecture.facts import CircularError, Facts
from derive.lecture.rate import rate, seen_from_axes, seen_from_N
from derive.lecture.relations import ContradictionError, left_by_relations
from derive.lecture.step import Derivation, Step, first_fall, verify
from derive.lecture.sums import linear_map, others, reading, varies
from derive.lecture.tree import collected
from derive.lecture.vectors import cross, dot, number, scalar, tensor, total, vector, zero
from tests.made import thinned


def with_step(changed: Step, *tried: str) -> Derivation:
    """Return the lecture with a step changed, as far as it matters for that step and ``tried``."""
    kept = LECTURE.behind(changed.name, *tried)
    steps = (changed if s.name == changed.name else s for s in LECTURE.steps if s.name in kept)
    return replace(LECTURE, steps=tuple(steps))


def faults(*steps: Step) -> list[str]:
    return [row.fault for row in verify(Derivation("of the test", steps))]


def first_fault(derivation: Derivation) -> str:
    """Return the first step that does not stand, and why."""
    return next(f"{row.name}: {row.fault}" for row in verify(derivation) if not row.holds)


def test_a_wrong_step_is_named_with_what_is_left() -> None:
    wrong = replace(LECTURE["angular_momentum"], using=("inertia_tensor",))
    assert re.search(r"angular_momentum: left - right = .*l_x", first_fault(with_step(wrong)))


def test_a_step_may_use_only_steps_above_it() -> None:
    early = replace(LECTURE["mass_is_constant"], using=("mass", "constant_mass", "euler"))
    assert "uses euler, which is not a step above it" in first_fault(with_step(early))


def test_a_name_is_taken_once() -> None:
    step = Step("one", "One.", "assume", scalar("k"), number(1))
    assert faults(step, step)[1] == "this name is taken by a step above"


def test_a_definition_may_not_name_again_what_was_spoken_of() -> None:
    smuggled = replace(LECTURE["principal_axes"], kind="define", left=M, right=l)
    changed = with_step(smuggled, "moment", "body_axes_form")
    assert "principal_axes: defines M again" in first_fault(changed)


def test_a_definition_may_not_speak_of_the_rate_of_something_known() -> None:
    known = Step("known", "Known.", "assume", scalar("k"), scalar("m"))
    rates = Step("rates", "Rates.", "define", scalar("k_dot"), number(3))
    assert faults(known, rates)[1] == "defines k_dot again"


def test_a_definition_may_not_name_what_has_a_rate_that_was_spoken_of() -> None:
    known = Step("known", "Known.", "assume", vector("a_i"), zero(3))
    places = Step("places", "Places.", "define", vector("r_i"), vector("k"))
    assert faults(known, places)[1] == "defines r_i again"


def test_a_definition_may_not_use_what_it_defines() -> None:
    step = Step("odd", "Odd.", "define", scalar("k"), scalar("k") + number(1))
    assert faults(step) == ["defines k by itself"]


def test_a_definition_may_not_be_an_equation_between_expressions() -> None:
    step = Step("odd", "Odd.", "define", 2 * scalar("k"), number(1))
    assert faults(step) == ["a definition must have a bare symbol on its left"]


def test_reasons_that_contradict_one_another_prove_nothing() -> None:
    one = Step("one", "One.", "assume", scalar("k") * scalar("k"), number(1))
    two = Step("two", "Two.", "assume", scalar("k") * scalar("k"), number(2))
    three = Step("three", "Three.", "deduce", scalar("k"), number(7), ("one", "two"))
    assert "contradict" in faults(one, two, three)[2]


def test_reasons_that_explain_a_symbol_by_itself_are_refused() -> None:
    one = Step("one", "One.", "assume", scalar("k"), 2 * scalar("n"))
    two = Step("two", "Two.", "assume", scalar("n"), 3 * scalar("k"))
    three = Step("three", "Three.", "deduce", scalar("k"), zero(), ("one", "two"))
    assert "by itself" in faults(one, two, three)[2]
    with pytest.raises(CircularError):
        Facts.of([one.claims, two.claims], {}).read(scalar("k"))


@pytest.mark.long
def test_a_theorem_may_not_be_carried_to_a_body_whose_sums_differ() -> None:
    step = LECTURE["wheel_obeys_the_same_law"]
    moment = LECTURE["moment_on_wheel"]
    other = replace(moment, right=(moment.claims[0][1], total(cross(rho, F_i), "wheel")))
    assert "M_w is not defined as M is" in first_fault(with_step(other, step.name))
    partly = replace(step, instance=tuple(p for p in step.instance if p[0] != "M"))
    assert "does not say what M is" in first_fault(with_step(partly))


def test_a_dropped_assumption_shows_the_first_step_that_falls_and_what_is_left() -> None:
    fall = first_fall(LECTURE, "strong_third_law")
    assert fall is not None
    step, leftover = fall
    assert step.name == "internal_moments_vanish"
    assert leftover == total(cross(r - vector("r_j"), P_ij), "pairs")
    dropped = LECTURE.without("strong_third_law")
    assert any(dropped.gap(dropped["internal_moments_vanish"]))


ASSUMED = [step.name for step in LECTURE.steps if step.kind == "assume"]


@pytest.mark.parametrize("name", thinned(ASSUMED, 5))
def test_every_assumption_carries_something(name: str) -> None:
    assert first_fall(LECTURE, name)


def test_a_sum_over_all_others_runs_over_every_pair_both_ways() -> None:
    pair_sum = reading(total(cross(r, others(P_ij))))
    swapped = total(cross(r, P_ij) + cross(vector("r_j"), vector("P_ji")), "pairs")
    assert (pair_sum - reading(swapped)).applyfunc(lambda entry: entry.expand()).is_zero_matrix


def test_a_product_of_sums_is_not_a_sum_of_products() -> None:
    mass, first = total(dm), total(dm * dot(vector("k"), rho))
    assert (reading(mass * first) - reading(total(dm * dm * dot(vector("k"), rho)))).expand() != 0


def test_a_sum_keeps_what_belongs_to_the_whole_body_outside() -> None:
    m, x = Symbol("m", real=True), Symbol("rho_i_x", real=True)
    assert linear_map(3 * m * x, "body") == 3 * m * Symbol("sum_body(rho_i_x)", real=True)
    assert varies("C", "wheels")
    assert not varies("C", "body")


def test_rates_obey_the_product_and_the_chain_rule() -> None:
    spin = scalar("s") * cross(omega, l)
    expected = (
        scalar("s_dot") * cross(omega, l)
        + scalar("s") * cross(vector("omega_dot"), l)
        + scalar("s") * cross(omega, vector("l_dot"))
    )
    assert collected(rate(spin, seen_from_axes) - expected).operator == "zero"
    assert rate(tensor("R") @ rho, seen_from_N).operator == "add"
    assert rate(number(3) * scalar("k")).operands[1].name == "k_dot"


def test_rates_seen_from_n_and_from_the_axes_obey_the_same_product_rule() -> None:
    transport = Facts.of([LECTURE["transport_of_any_vector"].claims], {})
    product = cross(omega, l)
    seen = transport.read(rate(product, seen_from_N))
    expected = transport.read(rate(product, seen_from_axes) + cross(Omega, product))
    assert (seen - expected).expand().is_zero_matrix


def test_a_remainder_is_zero_only_for_what_follows() -> None:
    c, s, t = symbols("c s t")
    assert left_by_relations([c**4 - s**4 - c**2 + s**2, s], [c**2 + s**2 - 1]) == (0, s)
    with pytest.raises(ContradictionError):
        left_by_relations([t], [s * t - 1, s])


def test_the_tensor_of_a_step_is_the_one_that_was_defined() -> None:
    wrong = replace(LECTURE["inertia_tensor"], right=total(dm * dot(rho, rho)) * tensor("E"))
    assert "angular_momentum" in first_fault(with_step(wrong, "angular_momentum"))
    assert I.shape == (3, 3)
