"""A recommendation follows from the points alone, and never from a lucky one."""

from dataclasses import replace

from bench.report.recommend import SAME, advice, choice, cut, keeping, overall, says, sentence
from tests.bench.report.made_up import curve, peer, point, wrong


def test_the_cheapest_stepper_that_keeps_to_the_error_is_recommended() -> None:
    points = [*curve("step_rk4", 4, 100.0), *curve("step_dmv", 10, 400.0)]
    # 0.5^4 = 0.06 with 100 a step, 1/2^10 = 1e-3 with 400: what is coarse is cheap
    loose, tight = (advice("case", points, "f64", e).point for e in (0.1, 1e-9))
    assert loose is not None
    assert tight is not None
    assert (loose.method, loose.value) == ("step_rk4", 0.5)
    assert (tight.method, tight.value) == ("step_dmv", 0.125)


def test_a_step_whose_finer_steps_are_worse_is_not_recommended() -> None:
    lucky = point("step_lie", 1.0, 1e-15, 1.0)
    points = [lucky, point("step_lie", 0.5, 1e-3, 2.0), point("step_lie", 0.25, 1e-5, 4.0)]
    assert [p.value for p in keeping(points, 1e-4)] == [0.25]


def test_a_point_that_is_no_number_keeps_to_nothing() -> None:
    assert keeping([point("step_lie", 1.0, float("nan"), 1.0)], 1e9) == []


def test_a_package_is_never_recommended() -> None:
    assert advice("case", [peer()], "f64", 1e-3).point is None


def test_the_advice_names_stepper_and_step() -> None:
    points = curve("step_rk4", 4, 100.0)
    assert sentence(advice("c", points, "f64", 0.1)) == "step_rk4 with steps of 0.5 s (0.5 rad)"
    assert sentence(advice("c", points, "f64", 1e-30)) == "no stepper keeps to 1e-30 in this case"


def test_the_stepper_that_serves_most_cases_comes_first() -> None:
    easy = [*curve("step_rk4", 4, 100.0), *curve("step_dmv", 10, 400.0)]
    rows = overall("free", {"a": easy, "b": curve("step_dmv", 10, 400.0)}, "f64", 1e-3)
    assert [(r.method, r.reached, r.asked) for r in rows] == [
        ("step_dmv", 2, 2),
        ("step_rk4", 1, 2),
    ]


def test_the_step_that_is_named_is_right_for_every_case() -> None:
    other = [point("step_dmv", p.value, 100 * p.wrong.state, 1 / p.value)
             for p in curve("step_dmv", 10, 1.0)]  # fmt: skip
    (row,) = overall("free", {"a": curve("step_dmv", 10, 1.0), "b": other}, "f64", 1e-9)
    assert row.radians == 2.0**-4  # 100 * 2^-30 is above 1e-9 / 10, 100 * 2^-40 below


def test_a_case_that_no_stepper_serves_counts_and_is_named() -> None:
    lost = [replace(p, wrong=wrong(1.0)) for p in curve("step_dmv", 10, 400.0)]
    (row,) = overall("free", {"a": curve("step_dmv", 10, 400.0), "b": lost}, "f64", 1e-3)
    assert (row.reached, row.asked, row.missed) == (1, 2, ("b",))
    assert says(row) == "step_dmv with steps of 0.5 rad: 1 of 2 cases, not b"


def test_a_case_is_served_only_if_every_scene_that_describes_it_is() -> None:
    good = curve("step_dmv", 10, 400.0)
    bad = [replace(p, scene="special", wrong=wrong(1e-6)) for p in good]
    assert overall("free", {"a": [*good, *bad]}, "f64", 1e-9) == []
    assert advice("a", [*good, *bad], "f64", 1e-9).point is None
    worse = [replace(p, scene="special", wrong=wrong(16 * p.wrong.state)) for p in good]
    (row,) = overall("free", {"a": [*good, *worse]}, "f64", 0.5**10)
    assert row.radians == 0.25  # 16 * 2^-10 is above 2^-10, 16 * 2^-20 below


def test_a_step_that_a_case_was_not_run_with_serves_it_not() -> None:
    coarse = [p for p in curve("step_dmv", 10, 1.0) if p.radians >= 0.5]
    hard = [replace(p, wrong=wrong(1e6 * p.wrong.state)) for p in curve("step_dmv", 10, 1.0)]
    (row,) = overall("free", {"a": coarse, "b": hard, "c": hard}, "f64", 1e-2)
    assert row.missed == ("a",)


def test_costs_are_those_of_the_step_that_is_named() -> None:
    hard = [replace(p, wrong=wrong(1024 * p.wrong.state)) for p in curve("step_dmv", 10, 1.0)]
    (row,) = overall("free", {"a": curve("step_dmv", 10, 1.0), "b": hard}, "f64", 0.5**10)
    assert (row.radians, row.worst, row.usual) == (0.25, 2.0, 1.5)


def test_a_setting_is_cut_and_never_rounded_up() -> None:
    for x in (0.0676582346, 0.5412658773652741, 1.11e-10, 0.25, 1e-9, 9.999e-4):
        assert float(cut(x)) <= x <= SAME * float(cut(x))


def test_what_serves_most_stands_second_even_where_it_is_also_cheapest() -> None:
    rows = overall("free", {"a": curve("step_dmv", 10, 1.0)}, "f64", 1e-3)
    assert [row.method for row in choice(rows)] == ["step_dmv", "step_dmv"]
