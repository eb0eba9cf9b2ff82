"""Scenes that the tests of this room steer."""

from collections.abc import Mapping, Sequence
from typing import Any

import derive


def craft(**more: Any) -> derive.Handle:
    """Return a rigid body with three principal moments, turned by three moments."""
    moments = [f"I_{a}" for a in "xyz"]
    document = {
        "wanted": ["step_rk4_unit", "step_taylor12"],
        "parameters": {n: {"unit": "kg m^2", "range": [0.5, 9000]} for n in moments},
        "axes": {"attitude": "quaternion"},
        "body": {"kind": "principal", "moments": moments},
        "known": {"angular_velocity": {"range": [-3, 3]}, "moment": {"range": [-60, 60]}},
        "motion": {"time_step": {"range": [0, 1]}},
    }
    return derive.load(document | more, name="craft")


def inertia(moments: Sequence[float]) -> Mapping[str, float]:
    """Return the craft's parameters."""
    return dict(zip(("I_x", "I_y", "I_z"), moments, strict=True))
