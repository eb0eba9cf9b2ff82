"""Parts of the ranges of a function in which nothing can divide by zero, and set-up's constants.

A part that has something which divides and may vanish, or has its root taken and may be negative,
is halved where that narrows it the most, until there is none. Set-up's own divisions are among
them. What set-up surely refuses is left out. Whether nothing divides by zero in floats is for who
takes the parts to find: they make up the ranges, and constants are what set-up makes in floats.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Program, component_names
from derive.program.status import Test, tried
from derive.verify.operators import Column
from derive.verify.proved.enclosed import PAIR_ERROR, enclosed, given
from derive.verify.proved.meant import exactly
from derive.verify.proved.ranges import Interval, outward
from derive.verify.proved.traits import Traits, traits
from derive.verify.proved.unfolded import unfolded

PARTS = 128
"""Into so many parts the ranges are cut, at most."""
FloatRanges = Mapping[str, tuple[float, float]]
PairOperation = tuple[str, tuple[tuple[float, float], ...]]
"""An operator, and of each operand between which numbers it is."""


@dataclass(frozen=True)
class Sector:
    """Ranges of parameters and inputs by component; of constants that have bounds, these."""

    inputs: FloatRanges
    constants: FloatRanges


@dataclass(frozen=True)
class Watched:
    """What is looked at in boxes: a function, and constants and what set-up asks for beside it.

    names : of what boxes have ends of, a row each
    """

    names: tuple[str, ...]
    constants: tuple[str, ...]
    tests: tuple[Test, ...]
    function: Traits
    setup: Traits

    def ranges(self, boxes: Column) -> dict[str, Interval]:
        """Return the ranges of parameters and inputs in boxes."""
        return {n: (boxes[0, k], boxes[1, k]) for k, n in enumerate(self.names)}


def sectors(
    library: Library, function: Program, cases: Sequence[FloatRanges], precision: Precision
) -> list[Sector] | None:
    """Return parts that together hold all of ``cases``, in which nothing divides by zero.

    cases : ranges of parameters and of the function's other inputs, by component
    None where more than ``PARTS`` would be needed.
    """
    of, found = _watched(library, function, tuple(cases[0]), precision), list[Sector]()
    ahead = np.array([[case[n] for n in of.names] for case in cases]).T
    while ahead.size:
        doubt, made = _looked_at(of, ahead)
        found += [_sector(of, ahead[..., k], made[..., k]) for k in np.flatnonzero(doubt == 0)]
        ahead = ahead[..., doubt > 0]
        if ahead.shape[-1] * 2 + len(found) > max(PARTS, 2 * len(cases)):
            return None
        ahead = _halved(of, ahead)
    return found


def whole_sectors(
    library: Library, function: Program, cases: Sequence[FloatRanges], precision: Precision
) -> list[Sector]:
    """Return ``cases`` as they are, for who knows otherwise that nothing divides by zero."""
    of = _watched(library, function, tuple(cases[0]), precision)
    boxes = np.array([[case[n] for n in of.names] for case in cases]).T
    doubt, made = _looked_at(of, boxes)
    return [_sector(of, boxes[..., k], made[..., k]) for k in np.flatnonzero(doubt >= 0)]


def pair_operations(
    library: Library, program: Program, parts: Sequence[Sector], precision: Precision
) -> set[PairOperation]:
    """Return the operations on pairs on a program's way, each with ends of its operands' ranges."""
    names, found = tuple(parts[0].inputs), set[PairOperation]()
    boxes = np.array([[part.inputs[n] for n in names] for part in parts]).T
    known = {n: (boxes[0, k], boxes[1, k]) for k, n in enumerate(names)}
    of = traits(unfolded(library, program, precision.bits), precision)
    with np.errstate(all="ignore"):
        at = enclosed(of, known, len(parts))
    for step in of.trace.steps:
        if step.origin == "pairs" and step.operator in (*PAIR_ERROR, "sin", "cos", "power_of_two"):
            each = ((*at.ranges[o], at.errors[o]) for o in step.operands)
            ends = ((float((a - e).min()), float((b + e).max())) for a, b, e in each)
            found.add((step.operator, tuple(ends)))
    return found


def _watched(
    library: Library, function: Program, names: tuple[str, ...], precision: Precision
) -> Watched:
    asked = {c for q in function.inputs if q.role == "constants" for c in q.components}
    every = zip(component_names(library.setup), library.setup.results, strict=True)
    made = {name: value for name, value in every if name in asked}
    tests = tuple(test for _, kept in tried(library.setup) for test in kept)
    setup = replace(library.setup, results=(*made.values(), *(value for _, value, _ in tests)))
    each = (unfolded(library, program, precision.bits) for program in (function, setup))
    own, ready = (traits(trace, precision) for trace in each)
    return Watched(names, tuple(made), tests, own, ready)


def _sector(of: Watched, box: Column, made: Column) -> Sector:
    """Return a part by names."""

    def named(names: Sequence[str], ends: Column) -> FloatRanges:
        each = zip(names, *ends, strict=True)
        return {n: (float(a), float(b)) for n, a, b in each if np.isfinite(a) and np.isfinite(b)}

    return Sector(named(of.names, box), named(of.constants, made))


def _looked_at(of: Watched, boxes: Column) -> tuple[Column, Column]:
    """Return how wide what may vanish is in each box, -1 where set-up refuses it; constants."""
    count, refused = boxes.shape[-1], np.zeros(boxes.shape[-1], bool)
    with np.errstate(all="ignore"):
        found = enclosed(of.setup, of.ranges(boxes), count)
    values = [found.ranges[place] for place in of.setup.trace.results]
    constants = len(of.constants)
    for test, value in zip(of.tests, values[constants:], strict=True):
        refused |= _is_refused(test, value)
    made = np.array([*values[:constants]]).reshape(constants, 2, count).swapaxes(0, 1)
    return np.where(refused, -1.0, _doubts(of, boxes)), made


def _is_refused(test: Test, value: Interval) -> Column:
    """Tell in which boxes no number keeps what set-up asks for."""
    kept, _, ends = test
    if kept == "positive":
        return np.asarray(value[1] <= 0)
    if kept == "not negative":
        return np.asarray(value[1] < 0)
    if kept == "finite":
        return np.zeros(len(value[0]), bool)
    low, high = outward(*(np.full(len(value[0]), float(end)) for end in ends))
    return np.asarray((value[1] < low) | (value[0] > high))


def _doubts(of: Watched, boxes: Column) -> Column:
    """Return how wide what may vanish is in each box, 0 where nothing may."""
    known, ranges, count = of.ranges(boxes), list[Interval](), boxes.shape[-1]
    doubt = np.zeros(count)
    with np.errstate(all="ignore"):
        for index, step in enumerate(of.function.trace.steps):
            each = [ranges[o] for o in step.operands]
            if not each:
                ranges.append(given(of.function, step, known, count)[0])
            elif step.operator == "atan2":
                ranges.append(outward(*(np.full(count, x) for x in (-np.pi, np.pi))))
            else:
                ranges.append(exactly(of.function, index, step, each))
            if step.operator in ("div", "sqrt"):
                low, high = each[-1]
                may = low < 0 if step.operator == "sqrt" else (low <= 0) & (high >= 0)
                width = high - low
                width = np.where(np.isnan(width), np.inf, width)
                doubt = np.maximum(doubt, np.where(may, width, 0.0))
    return doubt


def _halved(of: Watched, boxes: Column) -> Column:
    """Return boxes cut in two, each where that leaves the least in doubt.

    The lower half ends a float below where the upper one begins: what is asked of a sign is told.
    """
    rows, count = boxes.shape[1:]
    pairs = np.concatenate([boxes, boxes], axis=-1)[None].repeat(rows, axis=0)
    for k, (below, middle) in enumerate(zip(*_middles(of, boxes), strict=True)):
        pairs[k, 1, k, :count] = below
        pairs[k, 0, k, count:] = middle
    doubts = np.array([_doubts(of, pair) for pair in pairs]).reshape(rows, 2, count)
    along = np.tile(np.argmin(doubts.max(axis=1), axis=0), 2)
    return np.asarray(pairs[along, :, :, np.arange(2 * count)].transpose(1, 2, 0))


def _middles(of: Watched, boxes: Column) -> tuple[Column, Column]:
    """Return the floats at the middle of each side, and those below; of a point itself, twice."""
    middle = boxes.mean(axis=0).astype(of.function.precision.dtype)
    below = np.nextafter(middle, middle.dtype.type(-np.inf)).astype(float)
    fits = (boxes[0] <= below) & (middle <= boxes[1])
    return np.where(fits, below, boxes.mean(axis=0)), np.where(fits, middle, boxes.mean(axis=0))
