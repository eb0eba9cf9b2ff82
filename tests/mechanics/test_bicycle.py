"""The bicycle of Meijaard, Papadopoulos, Ruina and Schwab (2007), from one scene file."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from flint import arb

from derive.check.particles import clouds
from derive.library.library import Library, library
from derive.program.precision import F64
from derive.scene import SceneError, parse_scene
from derive.scene.machine import Force
from derive.verify.measure import results
from derive.verify.sample import samples

BICYCLE = (Path(__file__).parent / "scenes" / "bicycle.toml").read_text(encoding="utf-8")
M = [[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]]
K_0 = [[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]]
K_2 = [[0, 76.59734589573222], [0, 2.65431523794604]]
C_1 = [[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]]
"""Appendix A of the paper, lean before steer."""
EIGENVALUES = {
    0: (-5.53094371765322, -3.13164324790656, 3.13164324790656, 5.53094371765322),
    1: (-7.11008014637441, -3.13423125066578, 3.52696170990069),
    2: (-8.67387984831737, -3.07158645641514, 2.68234517512745),
    3: (-10.35101467245920, -2.63366137253667, 1.70675605663975),
    4: (-12.15861426576447, -1.42944427361326, 0.41325331521125),
    5: (-14.07838969279822, -0.77534188219585, -0.32286642900409),
    6: (-16.08537123098026, -1.52644486584142, -0.00406690076970),
    7: (-18.15788466125262, -2.13875644258362, 0.10268170574766),
    8: (-20.27940894394569, -2.69348683581097, 0.14327879765713),
    9: (-22.43788559040858, -3.21675402252485, 0.15790184030917),
    10: (-24.62459635017404, -3.72016840437287, 0.16105338653172),
}
"""Real parts at so many m/s: table 2 of the paper, weave, capsize and caster."""
DIGITS = 5e-14  # the table ends at 14 places


@cache
def bicycle() -> Library:
    return library(parse_scene(BICYCLE, "bicycle"))


def matrices(v: float) -> dict[str, Any]:
    own = bicycle()
    given = {"v": arb(v), "g": arb("9.81")}
    at = {c: given.get(c, arb(0)) for q in own.vocabulary.given() for c in q.components}
    found = results(own, own["linearised"], at)
    return {
        name: np.array([[float(found[f"{name}_{i}_{k}"]) for k in (1, 2)] for i in (1, 2)])
        for name in ("mass_matrix", "damping_matrix", "stiffness_matrix")
    }


@pytest.mark.long
@pytest.mark.parametrize("v", [0, 1, 4])
def test_the_matrices_are_those_of_the_paper(v: float) -> None:
    found = matrices(v)
    stiff = np.array(K_0) * 9.81 + np.array(K_2) * v**2
    assert found["mass_matrix"] == pytest.approx(np.array(M), abs=DIGITS)
    assert found["damping_matrix"] == pytest.approx(np.array(C_1) * v, abs=4 * DIGITS)
    assert found["stiffness_matrix"] == pytest.approx(stiff, abs=20 * DIGITS)


@pytest.mark.long
@pytest.mark.parametrize("v", EIGENVALUES)
def test_the_eigenvalues_are_those_of_the_paper(v: int) -> None:
    own = matrices(v)
    inverse = np.linalg.inv(own["mass_matrix"])
    first = np.hstack([np.zeros((2, 2)), np.eye(2)])
    last = np.hstack([-inverse @ own["stiffness_matrix"], -inverse @ own["damping_matrix"]])
    found = np.linalg.eigvals(np.vstack([first, last])).real
    for should in EIGENVALUES[v]:
        assert min(abs(found - should)) < 20 * DIGITS * max(1, abs(should))


@pytest.mark.long
def test_the_small_motion_is_that_of_the_cloud() -> None:
    own = bicycle()
    each = samples(own.mechanism, F64, 1, 0).each
    assert [v.outcome for v in clouds(own, each)] == ["holds"]


@pytest.mark.long
@pytest.mark.whole
def test_a_force_and_its_opposite_at_one_point_are_noticed_where_points_are_apart() -> None:
    scene = parse_scene(BICYCLE.replace('["linearised"]', '["accelerations"]'), "bicycle")
    loads = tuple(replace(f, other=None) if isinstance(f, Force) else f for f in scene.loads)
    for own, outcome in ((scene, "holds"), (replace(scene, loads=loads), "FAILS")):
        made = library(own)
        each = samples(made.mechanism, F64, 1, 0).each
        assert [v.outcome for v in clouds(made, each)] == [outcome]


@pytest.mark.long
@pytest.mark.parametrize(("old", "new", "says"), [
    ('dependent = ["theta"]\n', "", "needs to know what follows by the constraints, 3 in all"),
    ('dependent = ["psi", "W_F"]', 'dependent = ["phi", "W_F"]', "name others"),
    ('W_F = "-v/r_F"', "W_F = 0", "about a state that constraint 'grip' does not allow"),
])  # fmt: skip
def test_what_follows_must_follow(old: str, new: str, says: str) -> None:
    with pytest.raises(SceneError, match=says):
        library(parse_scene(BICYCLE.replace(old, new), "bicycle"))
