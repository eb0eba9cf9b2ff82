"""Loops of the literature: published figures, closed forms, and the motion that they give."""

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from flint import arb
from mpmath import acos, asin, atan2, cos, diff, mpf, pi, sin, sqrt
from scipy.integrate import solve_ivp

import derive
from derive.library.library import library
from derive.scene import parse_scene
from derive.verify.measure import results

SCENES = Path(__file__).parent / "scenes"
ROUNDED = 1e-10  # of an acceleration: states are on the constraints to what doubles leave
SQUEEZED = {
    "beta": -0.0617138900142764496, "theta": 0, "gamma": 0.455279819163070380,
    "phi": 0.222668390165885884, "delta": 0.487364979543842550, "om": -0.222668390165885884,
    "epsilon": 1.23054744454982119,
}  # fmt: skip
"""Where Andrews' mechanism begins, at rest: Hairer and Wanner, Solving ODE II, (VI.10.10)."""
AT_END = {
    "beta": 15.8107711962990, "theta": -15.7563710598430, "gamma": 0.0408222400730731,
    "phi": -0.534730116322694, "delta": 0.524409965880530, "om": 0.534730116322694,
    "epsilon": 1.04808074104226,
}  # fmt: skip
"""Where it is after 0.03 s: test set for IVP solvers, release 2.4, II-12."""
RATES_AT_END = {
    "beta": 1139.920302151208, "theta": -1424.379294994111, "gamma": 11.03291221937134,
    "phi": 19.29337464421385, "delta": 0.5735699284790808, "om": -19.29337464421385,
    "epsilon": 0.3231791658026955,
}  # fmt: skip
BENDS_AT_END = {
    "beta": -24631.76316945196, "theta": 51850.37701610329, "gamma": 324102.5686413781,
    "phi": 566749.3645176213, "delta": 16743.62929479361, "om": -566749.3645176222,
    "epsilon": 9826.520791458422,
}  # fmt: skip
FORCES_AT_END = {
    "e3_x": 199.1753333731910, "e3_y": -29.75531228015052, "e4_x": 23.06654119098399,
    "e4_y": 31.45271365475927, "e6_x": 22.64249232082739, "e6_y": 11.61740700019673,
}  # fmt: skip
"""How fast, its accelerations and what holds its loops: the test set's multipliers are these."""
FOLLOWED = 1e-6  # of what an integrator of index 3 finds for accelerations and forces
AGREED = 3e-6  # of motion that is not brought back, by an integrator of relative tolerance 1e-10


def answered(name: str, given: Mapping[str, float]) -> dict[str, float]:
    """Return the accelerations of a scene where all that is not given is 0."""
    own = library(parse_scene((SCENES / f"{name}.toml").read_text(encoding="utf-8"), name))
    at = {c: arb(float(given.get(c, 0))) for q in own.vocabulary.given() for c in q.components}
    return {n: float(x) for n, x in results(own, own["accelerations"], at).items()}


@pytest.fixture(scope="module")
def squeezed() -> derive.Handle:
    """Return Andrews' mechanism, with what holds its loops and a step wanted beside."""
    asked = tomllib.loads((SCENES / "squeezer.toml").read_text(encoding="utf-8"))
    loops = f"loops: {', '.join(FORCES_AT_END)}"
    return derive.load(asked | {"wanted": ["accelerations", loops, "step_rk4"]}, name="squeezer")


def accelerations_in(scene: derive.Handle, state: Sequence[float]) -> dict[str, float]:
    """Return the accelerations of Andrews' mechanism, of its angles and their rates."""
    names = [*SQUEEZED, *(f"{name}_dot" for name in SQUEEZED)]
    found = scene.function("accelerations")(**dict(zip(names, state, strict=True)))
    return {f"{name}_ddot": float(x) for name, x in zip(SQUEEZED, found, strict=True)}


@pytest.mark.long
def test_andrews_squeezing_mechanism_begins_as_published(squeezed: derive.Handle) -> None:
    found = accelerations_in(squeezed, [*SQUEEZED.values(), *(0.0 for _ in SQUEEZED)])
    assert found["beta_ddot"] == pytest.approx(14222.4439199541138705, rel=ROUNDED)
    assert found["theta_ddot"] == pytest.approx(-10666.8329399655854029, rel=ROUNDED)
    rest = (found[f"{name}_ddot"] for name in SQUEEZED if name not in ("beta", "theta"))
    assert max(map(abs, rest)) < ROUNDED * 14222


@pytest.mark.long
def test_andrews_squeezing_mechanism_is_after_30_ms_where_published(
    squeezed: derive.Handle,
) -> None:
    def rate(_: float, state: np.ndarray) -> np.ndarray:
        own = accelerations_in(squeezed, state)
        return np.array([*state[len(SQUEEZED) :], *own.values()], float)

    start = [*SQUEEZED.values(), *(0.0 for _ in SQUEEZED)]
    moved = solve_ivp(rate, (0, 0.03), start, method="DOP853", rtol=1e-10, atol=1e-11)
    for place, (name, should) in zip(moved.y[:, -1], AT_END.items(), strict=False):
        assert place == pytest.approx(should, abs=AGREED), name


@pytest.mark.long
def test_andrews_squeezing_mechanism_ends_with_the_published_accelerations_and_forces(
    squeezed: derive.Handle,
) -> None:
    given = AT_END | {f"{name}_dot": rate for name, rate in RATES_AT_END.items()}
    found = accelerations_in(squeezed, [*given.values()])
    found |= zip(FORCES_AT_END, map(float, squeezed.function("loops")(**given)), strict=True)
    for name, should in BENDS_AT_END.items():
        assert found[f"{name}_ddot"] == pytest.approx(should, abs=FOLLOWED * 566749), name
    against = {round(found[name] / should, 4) for name, should in FORCES_AT_END.items()}
    assert against in ({1}, {-1})  # on the one body or on the other, all alike


@pytest.mark.long
def test_andrews_squeezing_mechanism_is_moved_by_steps_to_where_it_is_published(
    squeezed: derive.Handle,
) -> None:
    start = SQUEEZED | {f"{name}_dot": 0.0 for name in SQUEEZED}
    motion = squeezed.simulate(start, 0.03, 3e-5)
    for name, should in AT_END.items():
        assert motion.states[name][-1] == pytest.approx(should, abs=5e-8), name
        rate = RATES_AT_END[name]
        assert motion.states[f"{name}_dot"][-1] == pytest.approx(rate, rel=1e-6, abs=2e-5), name
    assert max(off for _, off in motion.left) < 1e-13


@pytest.mark.long
def test_peaucellier_and_lipkin_draw_a_straight_line() -> None:
    long, side, crank, p, rate = 0.4, 0.2, 0.15, 0.25, 1.25
    along = (long**2 - side**2) / (2 * crank)  # the inverse of a circle through the pole

    def states(p: mpf) -> list[mpf]:
        d, e = 2 * crank * cos(p / 2), along / cos(p / 2)
        bend = acos((long**2 + d**2 - side**2) / (2 * long * d))
        inner = acos((long**2 + side**2 - d**2) / (2 * long * side))
        outer = acos((long**2 + side**2 - e**2) / (2 * long * side))
        up, down = p / 2 + bend, p / 2 - bend
        return [p, up, down, up - pi + inner, down + pi - inner, up - pi + outer, down + pi - outer]

    names = ["p", "a", "b", "u", "v", "w", "z"]
    each = [[diff(lambda s, k=k: states(s)[k], p, n) for k in range(7)] for n in (0, 1, 2)]
    given = {n: float(x) for n, x in zip(names, each[0], strict=True)}
    given |= {f"{n}_dot": float(x) * rate for n, x in zip(names, each[1], strict=True)}
    found = answered("peaucellier", given)
    for name, slope, bend in zip(names, each[1], each[2], strict=True):
        should = float(slope) * found["p_ddot"] + float(bend) * rate**2
        assert found[f"{name}_ddot"] == pytest.approx(should, rel=1e-9, abs=1e-9)


@pytest.mark.long
def test_a_spatial_slider_follows_its_crank() -> None:
    r, length, h, d = 0.08, 0.3, 0.12, 0.1
    q, rate = mpf(0.5), 6

    def place(q: mpf) -> mpf:
        return sqrt(length**2 - (d - r * sin(q)) ** 2 - (h + r * cos(q)) ** 2)

    def angles(q: mpf) -> tuple[mpf, mpf]:
        """Return how the rod is turned, which points from the pin to the slider."""
        return atan2(h + r * cos(q), place(q)), asin((r * sin(q) - d) / length)

    each = {"q": lambda x: x, "s": place, "a": lambda x: angles(x)[0], "b": lambda x: angles(x)[1]}
    given = {n: float(f(q)) for n, f in each.items()}
    given |= {f"{n}_dot": float(diff(f, q)) * rate for n, f in each.items()}
    found = answered("spatial_slider_crank", given)
    for name, f in each.items():
        should = float(diff(f, q)) * found["q_ddot"] + float(diff(f, q, 2)) * rate**2
        assert found[f"{name}_ddot"] == pytest.approx(should, rel=1e-9)
