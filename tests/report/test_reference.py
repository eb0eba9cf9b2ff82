"""The true motion of a report is that of the equations, and of bodies whose motion is known."""

import pytest
from flint import arb, ctx

from derive.library.library import Library, library
from derive.report.rate import rate_of_state
from derive.report.reference import BITS, NoEndError, end_of
from derive.report.states import begun
from derive.scene import parse_scene
from derive.verify.convergence import right_hand_side, unit_attitude
from tests.made import library_of

SPHERE = """
wanted = ["step_rk4"]
axes = { attitude = "quaternion" }
body = { kind = "spherical", moment = 2 }
known = { moment = [0, 0, 0] }
"""
RUNAWAY = (
    SPHERE.replace("moment = 2", 'moment = "A"').replace(
        "[0, 0, 0]", '["A*omega_x*omega_x", "0", "0"]'
    )
    + 'parameters = { A = { unit = "kg m^2", range = [1, 3], meaning = "moment" } }\n'
)
"""omega_x' = omega_x^2: infinite after 1 / omega_x."""
TOLD = 1e-18
"""Extrapolation leaves 1e-20 of every length, of which there are some dozens."""
SAME = 1e-30
"""Of 128 bits, with room for what cancels."""


def values_of(library: Library, place: int) -> dict[str, float]:
    return begun(library, "test", 4).values(place)


@pytest.mark.long
@pytest.mark.parametrize("scene", ["rigid_body_steps", "sleeping_top"])
def test_the_rates_are_those_that_orders_are_measured_by(scene: str) -> None:
    own = library_of(scene)
    with ctx.workprec(BITS):
        given = unit_attitude(own, {c: arb(x) for c, x in values_of(own, 1).items()})
        state = [given[c] for q in own.vocabulary.states for c in q.components]
        found, should = (f(own, given)(state) for f in (rate_of_state, right_hand_side))
        pairs = zip(found, should, strict=True)
        gaps = [abs(float(a - b)) / max(1.0, abs(float(a))) for a, b in pairs]
    assert len(gaps) > 3
    assert max(gaps) < SAME


def test_a_sphere_without_torque_ends_where_its_turn_takes_it() -> None:
    own = library(parse_scene(SPHERE, "sphere"))
    values = {"attitude_w": 1.0, "attitude_x": 0.0, "attitude_y": 0.0, "attitude_z": 0.0}
    values |= {"omega_x": 3.0, "omega_y": -2.0, "omega_z": 6.0}
    end = end_of(own, values, 5.0, 7.0)
    with ctx.workprec(BITS):
        half = arb(7) * 5 / 2
        should = [half.cos(), *(half.sin() * x / 7 for x in (3, -2, 6))]
        gaps = [abs(float(arb(end.state[c][0]) + arb(end.state[c][1]) - x))
                for c, x in zip(list(values)[:4], should, strict=True)]  # fmt: skip
    assert max(gaps) < TOLD
    assert end.state["omega_x"] == (3.0, 0.0)
    assert end.sizes["omega_z"] == 6.0


@pytest.mark.long
def test_a_motion_that_is_infinite_on_its_way_has_no_end() -> None:
    own = library(parse_scene(RUNAWAY, "runaway"))
    values = {"A": 2.0, "attitude_w": 1.0, "attitude_x": 0.0, "attitude_y": 0.0, "attitude_z": 0.0}
    values |= {"omega_x": 3.0, "omega_y": 0.0, "omega_z": 0.0}
    with pytest.raises(NoEndError, match="becomes infinite"):
        end_of(own, values, 0.5, 3.0)


@pytest.mark.long
def test_another_body_ends_elsewhere() -> None:
    own = library_of("tumbling_body")
    values = values_of(own, 0)
    name = own.vocabulary.parameters[0].components[0]
    first, other = (end_of(own, values | {name: values[name] * x}, 1.0, 10.0) for x in (1, 1.0001))
    assert first.state != other.state
