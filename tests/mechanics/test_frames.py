"""Angular velocities and accelerations of frames are those of their axes and origins in time."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from numpy.typing import NDArray
from sympy import Expr, Matrix

from derive.mechanics.mechanism import mechanism
from derive.mechanics.probe import Probe, random_probe
from derive.mechanics.sheet import Sheet
from derive.scene import load
from derive.verify.cloud.history import History
from derive.verify.cloud.series import DIGITS, each

SCENES = (
    "centrifuge_gondola",
    "edge_runner_flat",
    "gyrocompass",
    "skewed_disc",
    *sorted((Path(__file__).parent / "scenes").glob("*.toml")),
)
AGREE = mp.mpf(10) ** -40


def values_of(matrix: Matrix, probe: "Probe | Later") -> NDArray[Any]:
    return np.array([probe.value(e) for e in matrix], dtype=object)


@pytest.mark.parametrize("source", SCENES, ids=lambda s: getattr(s, "stem", s))
def test_frames_turn_and_accelerate_as_their_positions_say(source: str | Path) -> None:
    machine = load(source)
    known = mechanism(machine)
    frames, words = known.answers.frames, known.words
    frames.acceleration, frames.Omega_dot  # noqa: B018 - they name what they need on the sheet
    with mp.workdps(DIGITS):
        probe = random_probe(words, 0)
        probe.values |= {
            u: mp.mpf(k + 2) / 7 for k, u in enumerate(sorted(words.sheet.unknowns, key=str))
        }
        probe.define(words.sheet.definitions)
        names = {
            name: probe.values[s] for name, s in words.sheet.symbols.items() if s in probe.values
        }
        history = History(machine, names)
        for frame in machine.frames:
            R = history.rotations[frame.name]
            skew = R.T @ each(lambda x: x.rate(), R)
            Omega = values_of(frames.Omega[frame.name], probe)
            assert all(abs(skew[k - 1, k - 2].value - Omega[k]) < AGREE for k in range(3))
            there = each(lambda x: x.value, R).T @ each(
                lambda x: x.acceleration, history.origins[frame.name]
            )
            found = sum(
                (
                    values_of(frames.carried(part, name, frame.name), Later(probe, words.sheet))
                    for name, part in frames.acceleration[frame.name].items()
                ),
                0 * there,
            )
            assert all(abs(a - b) < AGREE * (1 + abs(a)) for a, b in zip(there, found, strict=True))


class Later:
    """A trial point that also values what is named while it is asked."""

    def __init__(self, probe: Probe, sheet: Sheet) -> None:
        self.probe, self.sheet = probe, sheet

    def value(self, e: Expr) -> Any:
        new = {s: v for s, v in self.sheet.definitions.items() if s not in self.probe.values}
        self.probe.define(new)
        return self.probe.value(e)
