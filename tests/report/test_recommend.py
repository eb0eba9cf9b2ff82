"""A recommendation follows from the points alone, and never from a lucky one."""

from derive.report.recommend import advice, keeping, overall, sentence
from tests.report.made_up import curve, peer, point


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
    rows = overall("free", [easy, curve("step_dmv", 10, 400.0)], "f64", 1e-3)
    assert [(r.method, r.reached, r.asked) for r in rows] == [
        ("step_dmv", 2, 2),
        ("step_rk4", 1, 2),
    ]


def test_the_step_that_is_named_is_right_for_every_case() -> None:
    other = [point("step_dmv", p.value, 100 * p.wrong.state, 1 / p.value)
             for p in curve("step_dmv", 10, 1.0)]  # fmt: skip
    (row,) = overall("free", [curve("step_dmv", 10, 1.0), other], "f64", 1e-9)
    assert row.radians == 2.0**-4  # 100 * 2^-30 is above 1e-9 / 10, 100 * 2^-40 below
