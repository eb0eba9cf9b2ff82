"""Sweeps of a top that tests share: small, and cut into many chunks."""

from pathlib import Path
from typing import Any

import derive

HELD = {"r": 0.05, "l": 0.06, "g": 9.81, "beta": 0.0, "alpha_dot": 0.0, "beta_dot": 0.0}
VARIED = {"alpha": "uniform(1deg, 3deg)", "m": "normal(0.5, 0.01)", "n": "loguniform(30, 60)"}
KEPT = ["alpha", "energy@end", "alpha@max", "beta@min", "beta@0.05"]
STOP = "alpha = 0.06"


def swept_top(folder: Path, **more: Any) -> derive.Ensemble:
    """Return a sweep of the sleeping top, of 600 members unless told otherwise."""
    told: dict[str, Any] = {
        "vary": VARIED, "folder": folder, "until": 0.2, "keep": KEPT, "values": HELD,
        "samples": 600, "stop": STOP, "step": 1e-3, "seed": 7, "instants": 4, "workers": 1,
        "chunk": 100,
    }  # fmt: skip
    return derive.load("sleeping_top").sweep(**told | more)
