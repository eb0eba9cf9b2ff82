"""From a scene and a task to a trajectory: several starts on a coarse grid, a finer one, arcs."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np

from derive.control.arcs import Refined, refined
from derive.control.conditions import Conditions, conditions, missed
from derive.control.direct import SOLVERS, TRANSCRIPTIONS, Grid, direct, first_guesses
from derive.control.plant import Plant, plant
from derive.control.structure import Arc, arcs_of
from derive.control.task import Task, task
from derive.control.trajectory import Trajectory, beyond_ranges
from derive.emit.files import require_folder, write
from derive.scene import SceneError
from derive.scene.table import one_of
from derive.solve.arguments import by_name
from derive.solve.handle import Handle, silent
from derive.solve.settings import NamedValues
from derive.solve.told import count, listener, met, path

Listener = Callable[[str], None]
COARSE = 40  # steps from which the several starts begin
FINEST = 800
DEARER = 1.05  # times the cost on fewer steps: what costs more is another trajectory
ASTRAY = 1e-4  # at the end, inputs flown: of so much a warning is given
HELPS = 4  # times less of a miss by halved steps, which are of order four
CLOSE = 1e-6  # to what should vanish at the end, inputs flown
SHORTEST = 1e-7  # of the time: an arc that is shorter is none
JUMPS = (4, 8)  # per cent of the steps: what else may be a switch between limits
HOLDS, FAILS = 2e-3, 1e-2  # of Pontryagin's conditions: what is looked no further for, or not shown
OVER = 1e-6  # of the width between its limits, that an input may be beyond them
FLOWN = 1e-9  # to what should vanish at the end: elements are halved until it is so
FINER = 4
HELD = 1e-6  # of a limit's width: a state so close to it is at it
STARTS, STEPS = 16, 100
MOST_STARTS = 1000


def steer(
    scene: Handle,
    values: NamedValues,
    turn: str = "",
    end: NamedValues | None = None,
    limits: Mapping[str, float | str] | None = None,
    avoid: Sequence[str] = (),
    cost: Mapping[str, float] | None = None,
    until: float | None = None,
    steps: int = STEPS,
    starts: int = STARTS,
    method: str = "shooting",
    solver: str = "ipopt",
    folder: str | Path | None = None,
    told: Listener = silent,
    guess: Trajectory | None = None,
) -> Trajectory:
    """Return the cheapest trajectory, with its inputs, that brings a scene where it is to go.

    values : parameters, inputs that are held, and states at the start; others begin at 0
    turn   : to rest, about an axis of the body at the start, as "z 180deg", "1,2,2 2"
    end    : states at the end, those that are named
    limits : of inputs, states, and what functions tell of them, as angular_momentum: 0.4 is -0.4
             to 0.4; "0..2"; without, inputs keep to their ranges if time alone is the cost
    avoid  : "x 0,0,1 30deg" keeps the body's x so far from the inertial frame's z
    cost   : weights of "time", s, and "energy", the integral of u.u; the time alone, if None
    until  : s, the time at the end, or where the cost counts it the first guess
    steps  : of the grid, at least      starts : the first straight, the others perturbed
    method : "shooting", "collocation"   solver : "ipopt", "fatrop"       told : hears how far it is
    guess  : a trajectory that was found before, of the same states and inputs: the first start
    folder : where a table (CSV) and a plot (SVG) of it are written, None for nowhere
    Raises DeriveError for what makes no sense, and if no start leads to an end.
    """
    if not isinstance(scene, Handle):
        raise SceneError(f"scene must be what derive.load returns, not {met(scene)}")
    if not isinstance(guess, Trajectory | None):
        raise SceneError(f"guess must be what derive.steer returns, not {met(guess)}")
    most = count("steps", steps, range(1, FINEST + 1))
    many = count("starts", starts, range(1, MOST_STARTS + 1))
    by = one_of(method, "method", TRANSCRIPTIONS), one_of(solver, "solver", tuple(SOLVERS))
    if by == ("collocation", "fatrop"):
        raise SceneError("fatrop solves steps of shooting, not collocation; take ipopt")
    cones = (avoid,) if isinstance(avoid, str) else avoid
    _require_words(turn, cones, {"values": values, "end": end, "limits": limits, "cost": cost})
    into = None if folder is None else path("folder", folder)
    if into is not None:
        require_folder(into)
    hears = listener(told)
    hears("deriving")
    own, given = plant(scene.scene, values)
    asked = task(own, given, turn, end or {}, limits or {}, cones, cost or {"time": 1}, until)
    first = first_guesses(own, asked, min(COARSE, most), many)
    if guess is not None:
        first = [_from_before(own, guess, min(COARSE, most)), *first[1:]]
    tried = _tried(own, asked, first, by, hears)
    best = min((g for g in tried if g.is_found), key=lambda g: g.cost, default=None)
    if best is None:
        raise SceneError(
            f"scene '{scene.name}': none of {many} starts led to the end: {_reasons(tried)}"
        )
    grid = best if best.u.shape[1] >= most else _again(own, asked, best, most, by, hears)
    grid = _finer(own, asked, grid, by, hears)
    hears("refining")
    found, holds, why = _refined(own, asked, grid)
    last = grid if found is None else found
    made = Trajectory(
        scene.name, own.x, own.u, own.units, last.until, last.cost, missed(own, asked, last),
        grid, found, why, holds, tuple(g.cost if g.is_found else None for g in tried), (),
    )  # fmt: skip
    doubts = beyond_ranges(own, made.states, made.inputs[1])
    if made.missed > ASTRAY:
        says = f"flown from the start, the inputs miss the end by {made.missed:.2g}"
        doubts = (f"{says}; take more steps, a longer time or wider limits", *doubts)
    made = replace(made, doubts=doubts)
    if into is not None:
        write(into, made.files())
    return made


def _require_words(turn: object, avoid: object, named: Mapping[str, object]) -> None:
    if not isinstance(turn, str):
        raise SceneError(f'turn must be a text, as "z 180deg", not {met(turn)}')
    if not (isinstance(avoid, Sequence) and all(isinstance(text, str) for text in avoid)):
        raise SceneError(f'avoid must be texts, as ["x 0,0,1 30deg"], not {met(avoid)}')
    for what, values in named.items():
        if not isinstance(values, Mapping) and (values is not None or what == "values"):
            raise SceneError(f"{what} must be given by name, not as {met(values)}")
        by_name(what, values or {})


def _from_before(own: Plant, guess: Trajectory, steps: int) -> Grid:
    if (guess.x, guess.u) != (own.x, own.u):
        rule = f"guess must be of the states and inputs {', '.join((*own.x, *own.u))}"
        raise SceneError(f"scene '{own.name}': {rule}, not {', '.join((*guess.x, *guess.u))}")
    return guess.grid.finer(steps)


def _tried(
    own: Plant, asked: Task, first: Sequence[Grid], by: tuple[str, str], told: Listener
) -> list[Grid]:
    problem = direct(own, asked, first[0].u.shape[1], *by)
    found = []
    for number, start in enumerate(first, 1):
        told(f"start {number} of {len(first)}")
        found.append(problem.solved(start))
    return found


def _reasons(tried: Sequence[Grid]) -> str:
    each = [g.why for g in tried]
    return ", ".join(f"{each.count(why)} end by {why}" for why in dict.fromkeys(each))


def _again(
    own: Plant, asked: Task, guess: Grid, steps: int, by: tuple[str, str], told: Listener
) -> Grid:
    """Return the trajectory on another grid, or the one that is there, if the solver fails."""
    told(f"{steps} steps")
    found = direct(own, asked, steps, *by).solved(guess.finer(steps))
    return found if found.is_found and found.cost <= DEARER * guess.cost else guess


def _finer(own: Plant, asked: Task, guess: Grid, by: tuple[str, str], told: Listener) -> Grid:
    """Return the trajectory on a grid so fine that its inputs, flown, lead to the end.

    Halving ends where it helps no more: what is unstable makes much of the solver's own error.
    """
    left, before, steps = missed(own, asked, guess), inf, guess.u.shape[1]
    while CLOSE < left <= before / HELPS and steps < FINEST:
        steps = min(2 * steps, FINEST)
        guess = _again(own, asked, guess, steps, by, told)
        left, before = missed(own, asked, guess), left
    return guess


def _refined(own: Plant, asked: Task, grid: Grid) -> tuple[Refined | None, Conditions | None, str]:
    """Return the trajectory on arcs, and how well it is the cheapest; or None twice, and why."""
    states, steps = len(own.x), grid.u.shape[1]
    if which := _held_back(own, asked, grid):
        return None, None, f"{which} on the way"
    why, best, holds = "", None, None
    looked = set[tuple[tuple[int, ...], ...]]()
    for short in dict.fromkeys((2, *(max(2, steps * part // 100) for part in JUMPS))):
        arcs = arcs_of(grid, asked.low[states:], asked.high[states:], short)
        stays = tuple(arc.stays for arc in arcs)
        if stays in looked:
            continue
        looked.add(stays)
        found, why = _on_arcs(own, asked, grid, arcs)
        if found is None:
            continue
        told = conditions(own, asked, found)
        if found.beyond(asked.low[states:], asked.high[states:]) > OVER:
            why = "between its points an input passes its limit"
            continue
        if holds is None or told.worst < holds.worst:
            best, holds = found, told
        if told.worst <= HOLDS:
            break
    if best is None or holds is None or holds.worst > FAILS:
        return None, None, why or "what its inputs do is not understood as arcs"
    return best, holds, ""


def _on_arcs(
    own: Plant, asked: Task, grid: Grid, arcs: tuple[Arc, ...]
) -> tuple[Refined | None, str]:
    """Return the trajectory on arcs, or why there is none; elements are halved if it flies ill."""
    finer, before, last = 1, inf, None
    while True:
        found = refined(own, asked, grid, arcs, finer)
        if found is None:
            return last, f"{len(arcs)} arcs are too few for what the end asks for"
        if found.why:
            return last, f"on {len(arcs)} arcs the solver ends by {found.why}"
        kept = tuple(arc for arc in found.arcs if arc.lasts > SHORTEST * found.until)
        if len(kept) < len(arcs):
            arcs = kept
            continue
        left = missed(own, asked, found)
        if left <= FLOWN or left > before / HELPS or finer == FINER:
            return found, ""
        finer, before, last = 2 * finer, left, found


def _held_back(own: Plant, asked: Task, grid: Grid) -> str:
    """Return which limit is reached that is not of an input, "" if none is."""
    for k, name in enumerate(own.x):
        low, high = asked.low[k], asked.high[k]
        room = min(grid.x[k].min() - low, high - grid.x[k].max())
        if np.isfinite(low) and room <= HELD * (high - low):
            return f"{name} comes to its limit"
    if len(asked.keeps):
        values = np.array(asked.keeps.at(grid.x[:, :-1], grid.u))
        worst = values[:, int(not asked.keeps.takes_inputs) :].max(axis=1)
        at_end, last = np.array(asked.keeps.at(grid.x[:, -1], grid.u[:, -1])), [*asked.keeps.last]
        worst[last] = np.maximum(worst[last], at_end[last, 0])
        return next((asked.keeps.reached[k] for k in np.flatnonzero(worst >= -HELD)), "")
    return ""
