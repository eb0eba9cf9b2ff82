"""Steady motions: the balance that lasts is found; a residual must hold its unknown."""

from math import cos, isclose, sin
from pathlib import Path

import pytest

from derive.scene import SceneError
from derive.solve import opened, roots

HOOP = Path(__file__).parent / "scenes" / "hoop_steady.toml"
GIVEN = {"m": 0.015, "r": 0.013, "g": 9.81, "theta": 0.8, "s": 47.0}


def test_a_hoop_leans_steadily_as_its_moments_about_the_ground_demand() -> None:
    (root,) = roots(opened(str(HOOP)), GIVEN)
    W, r, g, theta = root["W"], GIVEN["r"], GIVEN["g"], GIVEN["theta"]
    n = GIVEN["s"] + W * cos(theta)  # omega along the axis; C = m r^2, A = C / 2
    turning = r * W * sin(theta) * (2 * n - W * cos(theta) / 2)
    assert isclose(turning, -g * cos(theta), rel_tol=1e-9)


def test_a_residual_that_does_not_hold_its_unknown_is_refused(tmp_path: Path) -> None:
    text = HOOP.read_text(encoding="utf-8") + "vanishes = 'g*sin(theta)'\n"
    other = tmp_path / "hoop.toml"
    other.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match="must depend on W, but it does not"):
        roots(opened(str(other)), GIVEN)


def test_a_root_at_zero_is_found_once_and_no_scale_of_the_residual_makes_another(
    tmp_path: Path,
) -> None:
    for scale in ("1", "r^9"):  # a residual near 1e-17 has no other roots
        text = HOOP.read_text(encoding="utf-8")
        text += f"vanishes = '{scale}*W*(W - s)'\n"
        other = tmp_path / "hoop.toml"
        other.write_text(text, encoding="utf-8")
        found = [root["W"] for root in roots(opened(str(other)), GIVEN)]
        assert found == [pytest.approx(0, abs=1e-9), pytest.approx(47)]
