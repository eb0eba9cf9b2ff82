"""A motion in time by the scene's own step, and a plot of it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, isfinite, log10
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.program import Quantity
from derive.report.wishes import STEPS
from derive.scene import SceneError
from derive.scene.table import one_of
from derive.scene.unit import behind
from derive.solve.arguments import one_number
from derive.solve.event import event, first_met, has_value, no_value, residual
from derive.solve.instrument import Instrument
from derive.solve.lacking import advice_on
from derive.solve.onto_constraints import left_of_constraints, start_on_constraints

STEP = "step_rk4"
WIDTH, HEIGHT, LEFT, GAP = 640, 110, 90, 14
ROUNDING = 1e-12  # so that 1 s is ten steps of 0.1 s, and no short one more
LONGEST_MOTION = 10_000_000  # steps: what fits into the memory of a small machine
MOST_TICKS = 10  # on the axis of time
SHOWN = 600  # points of a line, at most


@dataclass(frozen=True)
class Simulation:
    """Times and, for each component of the state, its values.

    doubts : warnings about what lies outside of its range, given or on the way
    left   : the largest value of every constraint on the way, and of its rate, which are to be 0
    """

    times: NDArray[np.float64]
    states: Mapping[str, NDArray[np.float64]]
    units: Mapping[str, str]
    doubts: tuple[str, ...] = ()
    left: tuple[tuple[str, float], ...] = ()


def simulated(
    found: Instrument,
    given: Mapping[str, float],
    until: float,
    step: float,
    stop: str | None = None,
    by: object = STEP,
) -> Simulation:
    """Return the motion from the state in ``given``, other inputs held, ``by`` a step of the scene.

    Steps are as long as each other, at most ``step``, and end at ``until``, or where ``stop``
    holds first: the last step is as short as that needs.

    Raises SceneError if the scene does not ask for that step, a state is not given, a time has no
    sense, an event is none, or the motion does not stay finite.
    """
    label = f"scene '{found.name}'"
    until, step = (one_number(label, n, x) for n, x in (("until", until), ("step", step)))
    count = _count(until, step)
    step = until / count if count else step
    scene = found.library.scene
    if isinstance(by, str) and by == STEP and STEP not in scene.wanted:
        raise SceneError(advice_on(scene, STEP, "a simulation"))
    name = one_of(by, f"{label}: by", steps_by_state(found.library))
    states = found.library.vocabulary.states
    names = [c for q in states for c in q.components]
    missing = [n for n in names if n not in given]
    if missing:
        raise SceneError(f"scene '{found.name}': a simulation begins at {', '.join(missing)}")
    given, mended = start_on_constraints(found, given)
    sought = None if stop is None else event(found, given, stop)
    start = [float(given[n]) for n in names]
    moved = _one_step(found, name, dict(given) | {"time_step": step}, names)
    after = moved.mapaccum("motion", count)(start).full() if count else np.zeros((len(names), 0))
    columns = np.column_stack([start, after])
    times: NDArray[np.float64] = step * np.arange(columns.shape[1], dtype=np.float64)
    doubts = mended
    if sought is not None:
        left, h = residual(found, given, names, sought), casadi.SX.sym("h")
        if not has_value(left, columns):
            raise SceneError(no_value(found.name, sought))
        part = _one_step(found, name, dict(given) | {"time_step": h}, names, [h])
        if (met := first_met(left, columns, part, step)) is None:
            doubts.append(f"'{sought.text}' is not met by {until:g} s")
        else:
            place, rest, state = met
            columns = np.column_stack([columns[:, :place], state])
            times = np.append(times[:place], times[place - 1] + rest)
    _require_finite(found.name, names, columns, step)
    motion = dict(zip(names, columns, strict=True))
    doubts += _outside(found, given, times, motion)
    left = tuple(left_of_constraints(found, given, motion))
    return Simulation(times, motion, _units(states), tuple(doubts), left)


def _outside(
    found: Instrument,
    given: Mapping[str, float],
    times: NDArray[np.float64],
    motion: Mapping[str, NDArray[np.float64]],
) -> Iterator[str]:
    """Yield a warning for each quantity that leaves its declared range, and changes the rates."""
    matters = {*found.needed(STEP)} - motion.keys() | {*found.needed("state_rate")}
    for q in found.quantities():
        low, high = float(q.low or 0), float(q.high or 0)
        for name in () if q.is_quaternion else filter(matters.__contains__, q.components):
            values = motion.get(name, np.array([given.get(name, low)]))
            wrong = np.flatnonzero((values < low) | (values > high))
            if len(wrong):
                when = f" after {times[wrong[0]]:.4g} s" if name in motion and wrong[0] else ""
                value = f"{name} is {values[wrong[0]]:.6g}{behind(q.unit)}{when}"
                yield f"{value}, outside of its range, {low:g} to {high:g}"


def _count(until: float, step: float) -> int:
    """Return the number of steps; raise SceneError for times that make none."""
    if not (isfinite(step) and step > 0):
        raise SceneError(f"step must be a positive number of seconds, not {step}")
    if not (isfinite(until) and until >= 0):
        raise SceneError(f"until must be a number of seconds from 0 up, not {until}")
    if until > LONGEST_MOTION * step:
        raise SceneError(
            f"until must be at most {LONGEST_MOTION:,} steps of {step:g} s, that is "
            f"{LONGEST_MOTION * step:g} s, not {until:g}"
        )
    return steps_until(until, step)


def steps_until(until: float, longest: float) -> int:
    """Return how many steps of one length end at a time, none of them longer than asked.

    >>> steps_until(1.0, 0.1), steps_until(1.0, 0.3)
    (10, 4)
    """
    return ceil(until / longest * (1 - ROUNDING))


def _require_finite(
    scene: str, names: Sequence[str], columns: NDArray[np.float64], step: float
) -> None:
    wrong = np.argwhere(~np.isfinite(columns.T))
    if len(wrong):
        k, place = wrong[0]
        raise SceneError(
            f"scene '{scene}': a motion must stay finite, but {names[place]} is "
            f"{columns[place, k]} after {step * k:.6g} s; a shorter step may help"
        )


def steps_by_state(library: Library) -> tuple[str, ...]:
    """Return the steps that a scene wants which need the state, what is held and their length."""
    given = {q.name for q in (*library.vocabulary.states, *library.vocabulary.given())}

    def fits(name: str) -> bool:
        inputs = {q.name for q in library[name].inputs if q.role != "constants"}
        return "time_step" in inputs and inputs <= {*given, "time_step"}

    return tuple(name for name in library.scene.wanted if name in STEPS and fits(name))


def _one_step(
    found: Instrument, by: str, given: Mapping[str, Any], names: Sequence[str],
    more: Sequence[Any] = (),
) -> Any:  # fmt: skip
    """Return the step of the whole state as a CasADi function, of ``more`` symbols behind it."""
    x = casadi.SX.sym("x", len(names))
    after = found.answer(by, dict(given) | {n: x[k] for k, n in enumerate(names)})
    following = [after.get(f"{n}_next", x[k]) for k, n in enumerate(names)]
    return casadi.Function("step", [x, *more], [casadi.vertcat(*following)])


def _units(states: Sequence[Quantity]) -> dict[str, str]:
    return {c: q.unit for q in states for c in q.components}


def plot_of(simulation: Simulation) -> str:
    """Return an SVG with a line for every component of the state."""
    below = len(simulation.states) * (HEIGHT + GAP)
    height = below + GAP + 16
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img">'
    style = (
        "<style>text{font:12px sans-serif}polyline{fill:none;stroke:#345e8c}"
        "path{stroke:#ccc}.t{text-anchor:middle}</style>"
    )
    parts = [head, style, *_ticks(float(simulation.times[-1]), below)]
    for place, (name, values) in enumerate(simulation.states.items()):
        top = GAP + place * (HEIGHT + GAP)
        parts += _line(
            name, simulation.units[name], simulation.times.tolist(), values.tolist(), top
        )
    return "\n".join([*parts, "</svg>"]) + "\n"


def _ticks(end: float, below: int) -> Iterator[str]:
    """Yield a line and a number at round times, from 0 to the end, and their unit."""
    apart = _round(end / MOST_TICKS) if end else 1.0
    for k in range(int(end / apart * (1 + ROUNDING)) + 1):
        x = LEFT + (WIDTH - LEFT - GAP) * k * apart / (end or 1.0)
        yield f'<path d="M{x:.1f} {GAP}V{below + 4}"/>'
        yield f'<text class="t" x="{x:.1f}" y="{below + 18}">{k * apart:.6g}</text>'
    yield f'<text x="{LEFT - 40}" y="{below + 18}">t, s</text>'


def _round(least: float) -> float:
    """Return the smallest of 1, 2 and 5, and their tenfolds, that is no less.

    >>> _round(0.13), _round(3.0)
    (0.2, 5.0)
    """
    power = 10.0 ** floor(log10(least))
    return next(own * power for own in (1, 2, 5, 10) if own * power >= least * (1 - ROUNDING))


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
