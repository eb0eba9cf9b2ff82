"""The step that keeps the length of q: of order four, linear in q, and a number at every start."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from derive.library.library import Library, library
from derive.motion.runge_kutta import step
from derive.program.arithmetic import working
from derive.program.program import Op, Program
from derive.program.run import run
from derive.scene import SceneError, parse_scene
from tests.made import CATALOGUE, thinned
from tests.motion.systems import Values, at, mpf, system
from tests.motion.test_runge_kutta import order
from tests.motion.test_step_jacobian import EXACTLY, case, entries, worst

FREE = ("principal", "rigid_body")
LONG = 10_000
DRIFT = 2e-14
"""Of the length over LONG steps: some roundings a step of 1e-16, of either sign, and a few more."""


def inputs(program: Program) -> list[str]:
    return [c for q in program.inputs for c in q.components]


@pytest.mark.long
@pytest.mark.parametrize("name", thinned(FREE, 1))
def test_the_order_is_four(name: str) -> None:
    given, values = case(name)
    assert order(step(given, "step_rk4_unit"), given, values) == pytest.approx(4, abs=0.15)


@pytest.mark.parametrize("name", thinned(FREE, 1))
def test_on_the_sphere_it_is_the_step_that_normalises(name: str) -> None:
    given, values = case(name)
    unit, plain = (at(step(given, f"step_rk4{kind}"), values) for kind in ("_unit", ""))
    assert max(abs(a - b) for a, b in zip(unit, plain, strict=True)) < EXACTLY


def length_after(program: Program, values: Values, steps: int) -> tuple[float, float]:
    """Return how far the length of q is from 1 and from 0.1 after as many steps from there."""
    names, lengths = inputs(program), np.array([1.0, 0.1])
    now = {c: np.float64(values[c]) * np.ones(2) for c in names}
    parts = [c for c in names if c.startswith("attitude")]
    now |= {c: now[c] * lengths for c in parts}
    after = [c.removesuffix("_next") for q in program.outputs for c in q.components]
    for _ in range(steps):
        found = run(program, working(np.float64), [now[c] for c in names])
        now |= dict(zip(after, found, strict=True))
    sizes = np.sqrt(sum(now[c] ** 2 for c in parts)) / lengths
    one, tenth = np.abs(sizes - 1)
    return float(one), float(tenth)


@pytest.mark.long
def test_the_length_is_kept_over_ten_thousand_steps() -> None:
    given, values = case("principal")
    still = dict(values) | {f"moment_{axis}": mpf(0) for axis in "xyz"}
    # at most 3 rad/s: it turns by 0.1 rad a step, where RK4 alone would lose 1e-9 a step
    still["time_step"] = mpf("0.03")
    assert max(length_after(step(given, "step_rk4_unit"), still, LONG)) <= DRIFT


def test_an_increment_that_is_not_of_length_one_is_found() -> None:
    given, values = case("principal")
    made = step(given, "step_rk4_unit")
    (root,) = (op.result for op in made.ops if isinstance(op, Op) and op.operator == "sqrt")
    long = tuple(
        replace(op, operands=tuple(Fraction(1) if o == root else o for o in op.operands))
        if isinstance(op, Op)
        else op
        for op in made.ops
    )
    assert max(length_after(replace(made, ops=long), values, 100)) > 100 * DRIFT


@pytest.mark.parametrize("name", thinned(FREE, 1))
def test_the_jacobian_is_the_slope_of_the_step_on_the_sphere_and_off_it(name: str) -> None:
    given, values = case(name)
    off = dict(values) | {"attitude_x": values["attitude_x"] + mpf("0.3")}
    made, plain = step(given, "step_rk4_unit_jacobian"), step(given, "step_rk4_unit")
    assert max(worst(made, plain, one) for one in (values, off)) < EXACTLY


@pytest.mark.long
def test_the_tangent_jacobian_is_that_of_the_step_that_normalises() -> None:
    given, values = case("rigid_body")
    unit, plain = (entries(step(given, f"step_rk4{k}_tangent"), values) for k in ("_unit", ""))
    assert unit.keys() == plain.keys()
    assert max(abs(unit[place] - plain[place]) for place in unit) < EXACTLY


def test_mutants_of_the_jacobian_are_found() -> None:
    given, values = case("principal")
    made, plain = step(given, "step_rk4_unit_jacobian"), step(given, "step_rk4_unit")
    for place, op in list(enumerate(made.ops))[-300::37]:
        if isinstance(op, Op) and op.operator in ("add", "sub"):
            flipped = replace(op, operator="sub" if op.operator == "add" else "add")
            ops = (*made.ops[:place], flipped, *made.ops[place + 1 :])
            assert worst(replace(made, ops=ops), plain, values) > mpf(10) ** -9, op


def at_zero(name: str) -> list[float]:
    """Return what a step gives where all that varies is zero, the attitude too."""
    given, values = case("principal")
    program = step(given, name)
    zero = {c: 0.0 if c[:3] in ("att", "ome", "mom") else float(v) for c, v in values.items()}
    with np.errstate(all="ignore"):
        return [
            float(x)
            for x in run(
                program, working(np.float64), [np.float64(zero[c]) for c in inputs(program)]
            )
        ]


@pytest.mark.parametrize("kind", ["", "_jacobian", "_tangent"])
def test_nothing_is_nan_at_rest_nor_at_an_attitude_of_zeros(kind: str) -> None:
    assert np.isfinite(at_zero(f"step_rk4_unit{kind}")).all()
    assert not np.isfinite(at_zero(f"step_rk4{kind}")).all() or kind == "_tangent"


def test_it_costs_less_than_the_step_that_normalises() -> None:
    for kind in ("", "_jacobian", "_tangent"):
        unit, plain = (step(system("principal"), f"step_rk4{u}{kind}") for u in ("_unit", ""))
        assert unit.flops() <= plain.flops()


def wanting(scene: str, name: str) -> Library:
    """Return the programs of a scene of the catalogue that wants ``name`` alone."""
    text = (CATALOGUE / f"{scene}.toml").read_text(encoding="utf-8")
    start = text.index("wanted")
    end = text.index("]", start) + 1
    return library(parse_scene(f'{text[:start]}wanted = ["{name}"]{text[end:]}', scene))


@pytest.mark.parametrize(
    ("scene", "says"),
    [
        ("heavy_body", "is for rates of 'omega_x' that do not rest on 'attitude_w'"),
        ("heavy_top", "moves a quaternion: say axes.attitude = 'quaternion'"),
        ("rattleback", "keeps the length of one quaternion, and the state has none"),
    ],
)
def test_a_scene_that_has_no_such_step_is_refused_by_a_sentence(scene: str, says: str) -> None:
    with pytest.raises(SceneError, match=f"'step_rk4_unit' {says}"):
        wanting(scene, "step_rk4_unit")


def test_a_rate_that_rests_on_the_attitude_has_no_such_step() -> None:
    with pytest.raises(ValueError, match="which does not rest on it"):
        step(case("hung")[0], "step_rk4_unit")


@pytest.mark.long
def test_bodies_in_space_have_it_with_their_places() -> None:
    made = wanting("rigid_body", "step_rk4_unit_jacobian")["step_rk4_unit_jacobian"]
    assert "position_next" in {q.name for q in made.outputs}
