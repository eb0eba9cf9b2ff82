"""The reference satisfies the lecture's equations as they stand, and its slopes are differences."""

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
import pytest
import sympy
from flint import arb, ctx

from derive.mechanics.mechanism import Mechanism, mechanism
from derive.mechanics.problem import Problem
from derive.program.precision import F64
from derive.scene import catalogue, load
from derive.scene.wanted import ATTITUDES, JACOBIAN, moves
from derive.verify import reference as own_module
from derive.verify.equations import equations_of
from derive.verify.gains import gains
from derive.verify.reference import BALLS, NoValueError, in_columns, reference, references
from derive.verify.sample import Sample, samples
from derive.verify.scale import DOUBLES, _ends
from derive.verify.solution import solution
from tests.made import thinned

STEP_BITS = 200  # central differences with a step of 2^-200, at 800 bits: 400 bits right
BITS = 800


@cache
def scene(name: str) -> Mechanism:
    return mechanism(load(name))


def problems(known: Mechanism) -> list[Problem]:
    bases = dict.fromkeys(w.removesuffix(JACOBIAN) for w in known.scene.wanted)
    stated = [b for b in bases if not moves(b) and b not in ATTITUDES]
    return [known.problem(base) for base in stated]


def valued(e: Any, values: Mapping[Any, Any]) -> Any:
    """Return the value of a SymPy expression in balls, by walking its tree."""
    if e.is_Rational:
        return arb(int(e.p)) / int(e.q)
    if e.is_Symbol:
        return values[e]
    parts = [valued(part, values) for part in e.args]
    if e.is_Add:
        return sum(parts[1:], parts[0])
    if e.is_Mul:
        product = parts[0]
        for part in parts[1:]:
            product = product * part
        return product
    if e.is_Pow and e.exp.q == 2:
        return parts[0].sqrt() ** int(e.exp.p)
    if e.is_Pow:
        return parts[0] ** int(e.exp)
    if e is sympy.pi:
        return arb.pi()
    return parts[0].sin() if isinstance(e, sympy.sin) else parts[0].cos()


def ordinary(known: Mechanism) -> Sample:
    return samples(known, F64, 1, 0).each[0]


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_the_reference_satisfies_every_residual(name: str) -> None:
    known = scene(name)
    for problem in problems(known):
        symbols = known.posed(problem.name).vocabulary.symbols
        given = ordinary(known).values
        found = reference(equations_of(known, problem), given, ())
        values = {symbols[c]: arb(x) for c, x in given.items()}
        values |= {symbols[c]: k.value for c, k in found.items()}
        with ctx.workprec(300):
            assert all(abs(valued(r, values)) < arb(2) ** -200 for r in problem.residuals)


@pytest.mark.parametrize("name", thinned(catalogue(), 4))
def test_slopes_are_central_differences_of_the_reference_itself(name: str) -> None:
    known = scene(name)
    columns = [
        c for q in (*known.vocabulary.states, *known.vocabulary.inputs) for c in q.components
    ]
    for problem in problems(known):
        equations = equations_of(known, problem)
        with ctx.workprec(BITS):
            given = {c: arb(x) for c, x in ordinary(known).values.items()}
            slopes = solution(equations, given, columns, BALLS).unknowns()
            h = arb(2) ** -STEP_BITS
            for column in columns:
                ahead, behind = (
                    solution(equations, given | {column: given[column] + d}, (), BALLS).unknowns()
                    for d in (h, -h)
                )
                for row, one in slopes.items():
                    slope, _ = one.slopes.get(column, (arb(0), 0.0))
                    difference = (ahead[row].value - behind[row].value) / (2 * h)
                    assert abs(difference - slope) < arb(2) ** -(STEP_BITS + 100)


def found(name: str, wanted: str, values: Mapping[str, float]) -> dict[str, Any]:
    known = scene(name)
    given = dict(ordinary(known).values) | values
    return reference(equations_of(known, known.problem(wanted)), given, ())


def test_near_a_sphere_the_products_are_large_and_the_difference_is_small() -> None:
    near = {"I_xx": 1.0, "I_yy": 1.0 + 2.0**-40, "I_zz": 1.0}
    still = {"moment_x": 0.0, "moment_y": 0.0, "moment_z": 0.0, "omega_y": 3.0, "omega_z": 5.0}
    one = found("free_body_principal", "acceleration", near | still)["omega_dot_x"]
    assert one.scale == 15.0 * (1.0 + 2.0**-40)
    assert abs(one.value - 15 * arb(2) ** -40) < 1e-60


def test_a_sum_that_cancels_is_measured_by_its_largest_product() -> None:
    equal = {"moment_x": 1.0, "omega_y": 1.0, "omega_z": 1.0, "I_xx": 1.0, "I_yy": 2.0, "I_zz": 3.0}
    one = found("free_body_principal", "acceleration", equal)["omega_dot_x"]
    assert one.value.contains(0)
    assert one.scale == 3.0


def test_a_sum_that_is_larger_than_its_products_is_measured_by_itself() -> None:
    still = {"moment_x": 4.0, "omega_y": 1.0, "omega_z": 1.0, "I_xx": 1.0, "I_yy": 3.0, "I_zz": 2.0}
    one = found("free_body_principal", "acceleration", still)["omega_dot_x"]
    assert (float(one.value.mid()), one.scale) == (5.0, 5.0)


@pytest.mark.long
def test_an_exact_zero_is_told_from_a_tiny_number() -> None:
    rest = dict.fromkeys(("theta", "phi", "omega_x", "omega_y", "omega_z"), 0.0)
    rates = found("gyrostat", "state_rate", rest)
    assert all(abs(rates[c].value) < arb(2) ** -1200 for c in ("psi_dot", "theta_dot", "phi_dot"))


def test_equations_without_a_solution_are_refused() -> None:
    with pytest.raises(ArithmeticError, match="no solution that 10000 bits can tell"):
        found("free_body_principal", "acceleration", {"I_xx": 0.0})


TOGETHER = 3


@pytest.mark.parametrize("few", [110, 300])
def test_samples_that_are_solved_together_are_what_each_is_alone(
    few: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = scene("acrobot")
    equations = equations_of(known, known.problem("state_rate"))
    columns = ["q_1", "q_2"]
    each = [s.values for s in samples(known, F64, TOGETHER, 0).each]
    alone = [reference(equations, at, columns) for at in each]
    monkeypatch.setattr(own_module, "BITS", few)  # of 110, some need more
    found = references(equations, each, columns)
    for name, at in found.known.items():
        for n, one in enumerate(alone):
            assert abs(at.value[n] - one[name].value) < arb(2) ** -90 * arb(one[name].scale)
            assert at.scale[n] == pytest.approx(one[name].scale)
            assert {c: float(v[n]) for c, (v, _) in at.slopes.items()} == {
                c: float(v) for c, (v, _) in one[name].slopes.items()
            }


def test_a_sample_without_a_value_is_told_beside_others_that_have_one() -> None:
    known = scene("heavy_top")
    equations = equations_of(known, known.problem("state_rate"))
    values = ordinary(known).values
    gone = values | dict.fromkeys((c for c in values if c == "theta"), 0.0)
    assert references(equations, [values], ()).known
    with pytest.raises(NoValueError):
        references(equations, [values, gone], ())


def test_what_all_samples_magnify_at_most_bounds_what_each_does() -> None:
    known = scene("heavy_top")
    equations = equations_of(known, known.problem("state_rate"))
    each = samples(known, F64, 20, 0).each
    given = {c: np.array([s.values[c] for s in each]) for c in each[0].values}
    solved = solution(equations, given, (), DOUBLES)
    most = gains(solved, DOUBLES, _ends)
    own = gains(solved, DOUBLES, lambda size: (size, size))
    balls = references(equations, [s.values for s in each], ())
    assert any(np.max(own[name]) > 1 for name in own)
    for name, gain in own.items():
        assert np.max(gain) <= most[name]
        assert np.broadcast_to(gain, len(each)) == pytest.approx(balls.gains[name])


def test_balls_of_one_sample_go_into_no_column_of_another() -> None:
    by = in_columns(BALLS)
    inverse = by["inverse"]([[np.array([arb(1), arb(0)]), arb(0)], [arb(0), arb(2)]])
    assert float(inverse[0][0][0]) == 1
    assert not inverse[0][0][1].is_finite()
