"""The sample of the declared ranges at which a function's result is worst, and what makes it hard.

An error is counted here in u of the result itself: where terms cancel, or where the result grows
beside a pole, that is far more than u of the largest product. What makes a sample hard is told by
looking at it: how large its terms, its result and its moments are, and which number of it matters.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from derive.library.library import Library
from derive.program.precision import F64
from derive.program.program import Program
from derive.report.price import price_of
from derive.scene.formula import Arithmetic, evaluate
from derive.scene.functions import PLAIN
from derive.verify.columns import (
    Plan,
    arithmetics,
    doubles,
    found_and_true,
    in_columns,
    planned,
)
from derive.verify.draw import Dice, Sampled, admitted, complete, drawn, on_the_sphere
from derive.verify.hard_bodies import bodies
from derive.verify.operators import IN_DOUBLES, Column
from derive.verify.scale import around, lecture_scales, measured_outputs

DRAWN, ROUNDS, BATCH, KEPT = 8192, 8, 1024, 8
EASY = 64.0
"""u of the result: what a chain of roundings may leave where nothing is hard."""
CANCELS, GROWS, NEAR, HELPS = 16.0, 100.0, 1e-2, 4.0
"""Ratios above which terms cancel and results are large, a gap below which moments are nearly
equal, and how much smaller an error must be for a form to be advised."""
CHANGED = 2.0**-26
WIDE = 1e300


@dataclass(frozen=True)
class HardCase:
    """The worst sample found of a function: values by component, and what is said of it.

    error    : in u of the result      accurate : the same in the other form, None if there is none
    rounding : what rounding the given numbers alone makes of the result, in u of it
    """

    function: str
    output: str
    error: float
    accurate: float | None
    rounding: float
    values: Mapping[str, float]
    why: str
    advice: str


@dataclass(frozen=True)
class Looked:
    """A function in double, at raw samples of its scene."""

    of: Sampled
    plan: Plan

    def errors(self, rows: Column) -> list[Column]:
        """Return the errors of each output at each sample, in u of the result."""
        by = arithmetics(F64.dtype)
        with np.errstate(all="ignore"):
            pairs = found_and_true(self.plan, complete(self.of, rows), by)
            off = np.array([np.abs(by.off(f, t)) for f, t in pairs])
            off = np.where(np.array(around(self.plan.program))[:, None] & (off > 3), 0.0, off)
            size = np.array([np.abs(t[0]) for _, t in pairs])
            spans = [span for _, span in measured_outputs(self.plan.program)]
            each = [off[s].max(axis=0) / size[s].max(axis=0) / F64.unit_roundoff for s in spans]
        return [np.where(np.isfinite(x), x, 0.0) for x in each]  # a result of 0 has no such error

    def true(self, rows: Column) -> Column:
        """Return the true results: (components, samples), in double."""
        with np.errstate(all="ignore"):
            pairs = found_and_true(self.plan, complete(self.of, rows), arithmetics(F64.dtype))
        return np.array([t[0] for _, t in pairs])

    def scales(self, rows: Column) -> Column:
        """Return the largest product in each component's equation."""
        program = self.plan.program
        if program not in self.of.library.functions:
            return np.abs(self.true(rows))
        with np.errstate(all="ignore"):
            found = lecture_scales(self.of, program, complete(self.of, rows).wide)
        return np.array([np.broadcast_to(x, rows.shape[1]) for x in found])

    def divisors(self, rows: Column) -> Column:
        """Return the size of what is divided by, at each division: (divisions, samples)."""
        found: list[Column] = []

        def divided(a: Any, b: Any) -> Any:
            found.append(np.broadcast_to(np.abs(b), rows.shape[1]))
            return a / b

        with np.errstate(all="ignore"):
            given = complete(self.of, rows).wide
            in_columns(self.plan, {**doubles(), "div": divided}, given)
        return np.array(found).reshape(-1, rows.shape[1])

    def near_zero(self, rows: Column) -> Column:
        """Return how much smaller than usual the smallest divisor is, at each sample."""
        with np.errstate(all="ignore"):
            ratios = self.usual_divisors[:, None] / self.divisors(rows)
        worst: Column = np.max(np.nan_to_num(ratios, nan=1.0, posinf=WIDE), axis=0, initial=1.0)
        return worst

    @cached_property
    def usual_divisors(self) -> Column:
        """Return the median size of what is divided by."""
        return np.median(self.divisors(self.ordinary), axis=1)

    @cached_property
    def ordinary(self) -> Column:
        """Return raw samples anywhere in the ranges."""
        dice = Dice(f"derive: {self.of.library.scene.name} report {self.plan.program.name}")
        return drawn(self.of, dice, DRAWN)


def cases_of(library: Library, program: Program, other: Library | None) -> list[HardCase]:
    """Return the worst samples found of a function of a scene, the hardest output's first.

    Each output that is hard has its own, as each may have its own reason; if none is hard, the
    worst of all is there alone.
    """
    at = Looked(Sampled(library, F64), planned(program))
    found = [_case(at, other, place, row) for place, row in enumerate(_worst(at))]
    found.sort(key=lambda case: -case.error)
    return [case for case in found if case.why] or found[:1]


def _case(at: Looked, other: Library | None, place: int, row: Column) -> HardCase:
    program = at.plan.program
    output = measured_outputs(program)[place][0].name
    error = float(at.errors(row)[place][0])
    values = dict(zip(at.of.names, row[:, 0].tolist(), strict=True))
    accurate = _in_other_form(at, other, program.name, place, row)
    rounding = _rounding(at, row, place)
    gap = _nearest_moments(at, row)
    alike = gap is not None and gap < NEAR and rounding > EASY
    if error < EASY and not alike:
        return HardCase(program.name, output, error, accurate, rounding, values, "", "")
    why, pole = _why(at, row, place)
    advice = _advice(program, other, error, accurate, rounding, pole)
    return HardCase(program.name, output, error, accurate, rounding, values, why, advice)


def _worst(at: Looked) -> list[Column]:
    """Return the raw sample, (names, 1), of the largest error found of each output."""
    dice = Dice(f"derive: {at.of.library.scene.name} hard {at.plan.program.name}")
    best = [at.ordinary[:, np.argsort(-e, kind="stable")[:KEPT]] for e in at.errors(at.ordinary)]
    low, high = at.of.lows[:, None], at.of.highs[:, None]
    for turn in range(ROUNDS):
        for k, parents in enumerate(best):
            which = (dice.uniform(BATCH) * parents.shape[1]).astype(int)
            reach = 2.0 ** (-1 - 3 * turn * dice.uniform(BATCH))
            moved = dice.uniform(*(len(at.of.names), BATCH)) < 1 / 3
            steps = np.where(moved, 2 * dice.uniform(len(at.of.names), BATCH) - 1, 0.0)
            rows = np.clip(parents[:, which] + steps * (high - low) * reach, low, high)
            rows = on_the_sphere(at.of, rows)
            rows = np.concatenate([parents, rows[:, admitted(at.of, rows)]], axis=1)
            errors = at.errors(rows)[k]
            best[k] = rows[:, np.argsort(-errors, kind="stable")[:KEPT]]
    return [rows[:, :1] for rows in best]


def _in_other_form(
    at: Looked, other: Library | None, name: str, place: int, row: Column
) -> float | None:
    if other is None or name not in [p.name for p in other.printed()]:
        return None
    of = Sampled(other, F64)
    places = [at.of.names.index(n) for n in of.names]
    return float(Looked(of, planned(other[name])).errors(row[places])[place][0])


def _rounding(at: Looked, row: Column, place: int) -> float:
    """Return by how many u of itself a result changes if each given number does by one of its."""
    many = np.repeat(row, 1 + len(row), axis=1)
    for k in range(len(row)):
        many[k, 1 + k] *= 1 + CHANGED
    span = measured_outputs(at.plan.program)[place][1]
    true = at.true(many)[span]
    size = np.max(np.abs(true[:, 0]))
    gaps = np.max(np.abs(true[:, 1:] - true[:, :1]), axis=0) / CHANGED / size
    return float(np.sum(gaps[np.isfinite(gaps)]))


def _why(at: Looked, row: Column, place: int) -> tuple[str, str]:
    """Return what makes a sample hard, and the component whose value is a pole, "" if none is."""
    span = measured_outputs(at.plan.program)[place][1]
    size = float(np.max(np.abs(at.true(row)[span])))
    product = float(np.max(at.scales(row)[span]))
    usual = float(np.median(np.max(at.scales(at.ordinary)[span], axis=0)))
    reasons, pole = [], ""
    small = float(at.near_zero(row)[0])
    if product > GROWS * usual:
        pole = _blamed(at, row, lambda rows: np.max(at.scales(rows)[span], axis=0))
        told = f"terms are {product / usual:.1g} times the usual ones"
        reasons.append(f"near a pole{_placed(at, row, pole)}: {told}")
    elif small > CANCELS:
        pole = _blamed(at, row, at.near_zero)
        told = f"a divisor is {1 / small:.1g} of its usual size"
        reasons.append(f"near a pole{_placed(at, row, pole)}: {told}")
    gap = _nearest_moments(at, row)
    if gap is not None and gap < NEAR:
        reasons.append(f"nearly equal moments: two principal moments differ by {gap:.1g} of them")
    if product > CANCELS * size:
        reasons.append(f"terms cancel: the largest is {product / size:.1g} times the result")
    blamed = _blamed(at, row, lambda rows: at.errors(rows)[place])
    if not reasons:
        reasons.append("a part of the result cancels before it is magnified")
    if blamed and not pole:
        reasons.append(f"what matters most is {blamed} = {row[at.of.names.index(blamed), 0]:.6g}")
    return "; ".join(reasons), pole


def _placed(at: Looked, row: Column, name: str) -> str:
    return f" at {name} = {row[at.of.names.index(name), 0]:.6g}" if name else ""


def _blamed(at: Looked, row: Column, measure: Any) -> str:
    """Return the component that, moved to the middle of its range, takes most of a measure away."""
    count = len(row)
    many = np.repeat(row, count, axis=1)
    for k in range(count):
        many[k, k] = (at.of.lows[k] + at.of.highs[k]) / 2
    fits = admitted(at.of, many)
    here, there = float(measure(row)[0]), measure(many)
    there = np.where(fits, there, np.inf)
    least = int(np.argmin(there))
    return at.of.names[least] if there[least] < here / HELPS else ""


def _nearest_moments(at: Looked, row: Column) -> float | None:
    """Return how far the two nearest principal moments of any body are apart, beside the larger."""
    scene = at.of.library.scene
    values = dict(zip(at.of.names, row[:, 0].tolist(), strict=True))
    values |= {p.name: float(p.value) for p in scene.parameters if p.value is not None}
    gaps = []
    for tensor in bodies(scene):
        xx, yy, zz, xy, xz, yz = (
            0.0 if f is None else float(evaluate(f, values, IN_FLOATS)) for f in tensor.whole
        )
        own = np.linalg.eigvalsh([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]])
        if len({*tensor.whole[:3]}) == 3:
            gaps.append(float(np.min(np.diff(own)) / max(own[-1], 1 / WIDE)))
    return min(gaps, default=None)


IN_FLOATS: Arithmetic = {**PLAIN, **IN_DOUBLES, "number": float, "power": pow, "tan": np.tan}


def _advice(
    program: Program,
    other: Library | None,
    error: float,
    accurate: float | None,
    rounding: float,
    pole: str,
) -> str:
    """Return what to do about a hard case."""
    if accurate is not None and other is not None and accurate * HELPS < error:
        cost = f"{price_of(other[program.name])} weighted operations instead of {price_of(program)}"
        said = f'form = "accurate" is off by {accurate:.2g} u there, for {cost}'
    elif rounding * HELPS > error:
        said = "no form helps: rounding the given numbers does as much"
    else:
        said = "give the numbers in double"
    if pole:
        said += f"; a range of {pole} that keeps away from there, or axes without such a place"
    elif rounding > error / HELPS and accurate is not None and accurate * HELPS < error:
        said += f"; but rounding the given numbers moves it by {rounding:.1g} u: they must be exact"
    return said
