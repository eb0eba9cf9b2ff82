"""Loops of bars beside Newton and Euler of every bar alone, in absolute coordinates, by numpy."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from flint import arb

from derive.library.library import library
from derive.scene import parse_scene
from derive.verify.measure import results

Pin = tuple[tuple[int, float, float], tuple[int, float, float]]
"""Two bars, -1 for the ground, and a place on each, from its mass centre along its own axes."""
GRAVITY, MASS = 9.81, 1.5
NEAR = 1e-8  # of accelerations: rates along the loops are told by differences


def accelerations(states: Any, rates: Any, lengths: Sequence[float], pins: Sequence[Pin]) -> Any:
    """Return the angular accelerations of bars, with a force of its own at every pin.

    states, rates : angles of bars and how fast these turn
    """
    count = len(lengths)
    rows, right = np.zeros((2 * len(pins), 3 * count)), np.zeros(2 * len(pins))
    for n, pin in enumerate(pins):
        for (bar, along, across), sign in zip(pin, (1, -1), strict=True):
            if bar >= 0:
                c, s = np.cos(states[bar]), np.sin(states[bar])
                arm = np.array([c * along - s * across, s * along + c * across])
                own = slice(2 * n, 2 * n + 2)
                rows[own, 3 * bar : 3 * bar + 2] = sign * np.eye(2)
                rows[own, 3 * bar + 2] = sign * np.array([-arm[1], arm[0]])
                right[own] += sign * arm * rates[bar] ** 2
    masses = [x for length in lengths for x in (MASS, MASS, MASS * length**2 / 12)]
    whole = np.block([[np.diag(masses), rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    weights = [x for _ in lengths for x in (0, -MASS * GRAVITY, 0)]
    found = np.linalg.solve(whole, [*weights, *right])
    return found[2 : 3 * count : 3]


JOINTS = """
f_1 = { turned = ["z q_1"] }
f_2 = { parent = "f_1", origin = ["1", "0", "0"], turned = ["z q_2 - q_1"] }
f_3 = { origin = ["1.1", "0", "0"], turned = ["z q_3"] }
f_4 = { parent = "f_3", origin = ["1", "0", "0"], turned = ["z q_4 - q_3"] }
f_5 = { origin = ["2.2", "0", "0"], turned = ["z q_5"] }
"""
LOOPS = """
p = { on = "b_2", at = ["1", "0", "0"], against = "b_3", to = ["1", "0", "0"], axes = ["x", "y"] }
q = { on = "b_4", at = ["1", "0", "0"], against = "b_5", to = ["1", "0", "0"], axes = ["x", "y"] }
"""
LOADS = """
weight = { gravity = ["0", -9.81, "0"] }
h_1 = { on = "b_1", force = "?A", couple = ["?A_a", "?A_b", "0"] }
h_2 = { on = "b_2", against = "b_1", force = "?B", couple = ["?B_a", "?B_b", "0"] }
h_3 = { on = "b_3", force = "?C", couple = ["?C_a", "?C_b", "0"] }
h_4 = { on = "b_4", against = "b_3", force = "?D", couple = ["?D_a", "?D_b", "0"] }
h_5 = { on = "b_5", force = "?E", couple = ["?E_a", "?E_b", "0"] }
"""
EACH = range(1, 6)
ANGLES = "\n".join(f'q_{k} = {{ unit = "rad", range = [LOW_{k}, HIGH_{k}] }}' for k in EACH)
BARS = "\n".join(
    f'b_{k} = {{ frame = "f_{k}", shape = "rod", axis = "x", mass = {MASS}, length = 1, '
    'centre = ["0.5", "0", "0"] }'
    for k in EACH
)
SCENE = f"""
wanted = ["accelerations"]
[coordinates]
{ANGLES}
[frames]{JOINTS}
[bodies]
{BARS}
[loads]{LOADS}
[constraints]{LOOPS}
"""
A, B = -0.5, 0.5  # the ends of a bar, from its mass centre
ROW = [((0, A, 0), (-1, 0, 0)), ((1, A, 0), (0, B, 0)), ((2, A, 0), (-1, 0, 0)),
       ((3, A, 0), (2, B, 0)), ((4, A, 0), (-1, 0, 0)), ((1, B, 0), (2, B, 0)),
       ((3, B, 0), (4, B, 0))]  # fmt: skip


def closed(first: float, base: float) -> tuple[float, float]:
    """Return the angles of coupler and rocker of four bars 1 long on a ground of ``base``."""
    x, y = np.cos(first) - base, np.sin(first)
    apart, towards = np.hypot(x, y), np.arctan2(-y, -x)
    coupler = towards + np.arccos(apart / 2)
    return float(coupler), float(np.arctan2(y + np.sin(coupler), x + np.cos(coupler)))


@pytest.mark.long
@pytest.mark.parametrize("crank", [1.2, 1.7])
def test_two_four_bars_in_a_row_move_as_five_bars_pinned_to_each_other(crank: float) -> None:
    def angles(q: float) -> np.ndarray[Any, Any]:
        b, c = closed(q, 1.1)
        return np.array([q, b, c, *closed(c, 1.1)])

    q, turn, h = angles(crank), 0.8, 1e-5
    slope = (8 * (angles(crank + h) - angles(crank - h))
             - angles(crank + 2 * h) + angles(crank - 2 * h)) / (12 * h)  # fmt: skip
    text = SCENE
    for k, x in enumerate(q, start=1):
        text = text.replace(f"LOW_{k}", f"{x - 0.2:.3f}").replace(f"HIGH_{k}", f"{x + 0.2:.3f}")
    own = library(parse_scene(text, "bars"))
    state = {f"q_{k}": x for k, x in enumerate(q, start=1)}
    state |= {f"q_{k}_dot": x * turn for k, x in enumerate(slope, start=1)}
    at = {c: arb(float(state[c])) for v in own.vocabulary.given() for c in v.components}
    found = results(own, own["accelerations"], at)
    should = accelerations(q, slope * turn, [1.0] * 5, ROW)
    each = [float(found[f"q_{k}_ddot"]) for k in range(1, 6)]
    assert each == pytest.approx(should, rel=NEAR, abs=NEAR)
