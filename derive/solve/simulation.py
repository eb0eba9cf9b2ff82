"""A motion in time by the scene's own step, and a plot of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, isfinite
from typing import Any

import casadi
import numpy as np

from derive.program.program import Quantity
from derive.scene import SceneError
from derive.scene.unit import behind
from derive.solve.instrument import Instrument

STEP = "step_rk4"
WIDTH, HEIGHT, LEFT, GAP = 640, 110, 90, 14
ROUNDING = 1e-12  # so that 1 s is ten steps of 0.1 s, and no short one more
MOST = 10_000_000  # steps: what fits into the memory of a small machine
SHOWN = 600  # points of a line, at most


@dataclass(frozen=True)
class Simulation:
    """Times and, for each component of the state, its values."""

    times: tuple[float, ...]
    states: Mapping[str, tuple[float, ...]]
    units: Mapping[str, str]


def simulated(
    found: Instrument, given: Mapping[str, float], until: float, step: float
) -> Simulation:
    """Return the motion from the state in ``given``, other inputs held, by ``step_rk4``.

    Steps are as long as each other, at most ``step``, and end at ``until``.

    Raises SceneError if the scene does not ask for that step, a state is not given, a time has no
    sense, or the motion does not stay finite.
    """
    count = _count(until, step)
    step = until / count if count else step
    scene = found.library.scene
    if STEP not in scene.wanted:
        raise SceneError(f"scene '{found.name}': a simulation needs wanted = [..., \"{STEP}\"]")
    states = found.library.vocabulary.states
    names = [c for q in states for c in q.components]
    missing = [n for n in names if n not in given]
    if missing:
        raise SceneError(f"scene '{found.name}': a simulation begins at {', '.join(missing)}")
    start = [float(given[n]) for n in names]
    moved = _one_step(found, dict(given) | {"time_step": step}, names)
    after = moved.mapaccum("motion", count)(start).full() if count else np.zeros((len(names), 0))
    rows = [start, *after.T.tolist()]
    _require_finite(found.name, names, rows, step)
    columns = zip(*rows, strict=True)
    return Simulation(
        tuple(step * k for k in range(len(rows))),
        dict(zip(names, (tuple(c) for c in columns), strict=True)),
        _units(states),
    )


def _count(until: float, step: float) -> int:
    """Return the number of steps; raise SceneError for times that make none."""
    if not (isfinite(step) and step > 0):
        raise SceneError(f"--step must be a positive number of seconds, not {step}")
    if not (isfinite(until) and until >= 0):
        raise SceneError(f"--until must be a number of seconds from 0 up, not {until}")
    if until > MOST * step:
        raise SceneError(
            f"--until must be at most {MOST:,} steps of --step {step:g}, that is "
            f"{MOST * step:g} s, not {until:g}"
        )
    return ceil(until / step * (1 - ROUNDING))


def _require_finite(
    scene: str, names: Sequence[str], rows: Sequence[Sequence[float]], step: float
) -> None:
    for k, row in enumerate(rows):
        for name, value in zip(names, row, strict=True):
            if not isfinite(value):
                raise SceneError(
                    f"scene '{scene}': a motion must stay finite, but {name} is {value} after "
                    f"{step * k:.6g} s; a shorter --step may help"
                )


def _one_step(found: Instrument, given: Mapping[str, float], names: Sequence[str]) -> Any:
    """Return the step of the whole state as a CasADi function."""
    x = casadi.SX.sym("x", len(names))
    after = found.answer(STEP, dict(given) | {n: x[k] for k, n in enumerate(names)})
    following = [after.get(f"{n}_next", x[k]) for k, n in enumerate(names)]
    return casadi.Function("step", [x], [casadi.vertcat(*following)])


def _units(states: Sequence[Quantity]) -> dict[str, str]:
    return {c: q.unit for q in states for c in q.components}


def plot(simulation: Simulation) -> str:
    """Return an SVG with a line for every component of the state."""
    height = len(simulation.states) * (HEIGHT + GAP) + GAP + 16
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img">'
    style = "<style>text{font:12px sans-serif}polyline{fill:none;stroke:#345e8c}</style>"
    parts = [head, style]
    for place, (name, values) in enumerate(simulation.states.items()):
        top = GAP + place * (HEIGHT + GAP)
        parts += _line(name, simulation.units[name], simulation.times, values, top)
    end = simulation.times[-1]
    parts.append(f'<text x="{WIDTH - 60}" y="{height - 6}">{end:.6g} s</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"


def _line(
    name: str, unit: str, times: Sequence[float], values: Sequence[float], top: int
) -> list[str]:
    low, high = min(values), max(values)
    tall, wide = (high - low) or 1.0, times[-1] or 1.0
    every = max(1, len(times) // SHOWN)
    points: list[Any] = [
        f"{LEFT + (WIDTH - LEFT - GAP) * t / wide:.1f},{top + HEIGHT * (high - v) / tall:.1f}"
        for t, v in list(zip(times, values, strict=True))[::every]
    ]
    return [
        f'<polyline points="{" ".join(points)}"/>',
        f'<text x="4" y="{top + HEIGHT / 2}">{escape(f"{name}{behind(unit)}")}</text>',
        f'<text x="4" y="{top + 12}">{high:.4g}</text>',
        f'<text x="4" y="{top + HEIGHT}">{low:.4g}</text>',
    ]
