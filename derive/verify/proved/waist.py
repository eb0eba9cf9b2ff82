"""Functions with a waist: all results rest on a turned quaternion alone, which has four components.

What comes before is bounded over boxes of what is given: how far rounding moves each component,
and between which numbers their squared length is. What comes after is bounded over parts of the
sphere, which are far smaller, as they have few sides.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from derive.verify.proved.cells import Cells
from derive.verify.proved.cut import Cutting, Region
from derive.verify.proved.enclosed import enclosed
from derive.verify.proved.lengths import UPWARDS
from derive.verify.proved.multiples import squares_in
from derive.verify.proved.slopes import shifts
from derive.verify.proved.traits import Traits, choice_name, traits
from derive.verify.proved.unfolded import Operation, Unfolded, pruned

AHEAD = 2
"""One in so many of all operations is spent on what comes before a waist."""


def bounded(at: Cutting, known: Sequence[Cells] = ()) -> tuple[Cells, ...]:
    """Return parts with their bounds, those of what comes before a waist first, if there is one.

    known : the parts of another precision, which serve this one too
    """
    place = waist(at.traits)
    if place is None or len(known) == 1:
        return (at.again(known[0]) if known else at.run(),)
    head = _head(at, place)
    before = head.again(known[0]) if known else head.run()
    tail = _tail(at, place, *_carried(head, before))
    if tail is None:
        return (at.run(),)
    tail.work = at.work - head.spent
    after = tail.again(known[1]) if known else tail.run()
    at.spent += head.spent + tail.spent
    return before, after


def waist(of: Traits) -> int | None:
    """Return the squared length of a quaternion that all results rest on alone, None if none is."""
    for index in of.multiples:
        turned, rests = squares_in(of.trace.steps, index), list[bool]()
        for n, step in enumerate(of.trace.steps):
            own = step.operator == "given" or any(rests[o] for o in step.operands)
            rests.append(own and n not in turned)
        if len(set(turned)) == len(turned) and not any(rests[r] for r in of.trace.results):
            return index
    return None


def _head(at: Cutting, index: int) -> Cutting:
    """Return what bounds the components of the quaternion."""
    steps = at.traits.trace.steps
    trace = pruned(steps, squares_in(steps, index))
    of = traits(trace, at.traits.precision, at.traits.quaternions)
    return Cutting(of, _region(of, at.box), at.work // AHEAD, at.dice)


def _region(of: Traits, box: Region) -> Region:
    """Return a box of what a part of a function rests on, with that part's own choices."""
    given = [n for n, name in enumerate(box.names) if any(s.name == name for s in of.trace.steps)]
    names, free = [box.names[n] for n in given], len(of.choices)
    low, high = (np.concatenate([ends[given], np.full(free, end)])
                 for ends, end in ((box.lows, 0.0), (box.highs, 1.0)))  # fmt: skip
    places = tuple(tuple(map(names.index, each)) for each in of.quaternions)
    return Region((*names, *map(choice_name, of.choices)), low, high, places)


def _carried(head: Cutting, parts: Cells) -> tuple[list[float], tuple[float, float]]:
    """Return how far components are off before they are rounded, and ends of their squared sum."""
    turned, rows = head.traits.trace.results, len(head.traits.trace.results)
    whole = traits(_with_length(head.traits.trace), head.traits.precision, head.traits.quaternions)
    most, ends = np.zeros(rows), (np.inf, -np.inf)
    for low, high in head.batches(parts.lows, parts.highs):
        with np.errstate(all="ignore"):
            found = enclosed(whole, head.ranges(low, high), low.shape[1])
            own = np.array([found.own[n] for n in turned])
            off = (shifts(found, range(rows)) - own).max(axis=1, initial=0.0) * UPWARDS
        most = np.maximum(most, off)
        square = found.ranges[whole.trace.results[-1]]
        ends = min(ends[0], float(square[0].min())), max(ends[1], float(square[1].max()))
    return [float(x) for x in most], ends


def _with_length(trace: Unfolded) -> Unfolded:
    """Return a function that gives the sum of the squares of its results besides."""
    steps, places = list(trace.steps), list[int]()
    for result in trace.results:
        places.append(len(steps))
        steps.append(Operation("mul", (result, result), "working"))
    while len(places) > 1:
        steps.append(Operation("add", (places.pop(0), places.pop(0)), "working"))
        places.append(len(steps) - 1)
    return Unfolded(tuple(steps), (*trace.results, *places))


def _tail(
    at: Cutting, index: int, most: Sequence[float], ends: tuple[float, float]
) -> Cutting | None:
    """Return what bounds results over parts of the sphere, None if there is no such."""
    steps, names = list(at.traits.trace.steps), [f"turned {n}" for n in range(len(most))]
    for name, place in zip(names, squares_in(steps, index), strict=True):
        steps[place] = Operation("given", (), "given", name=name)
    trace = pruned(steps, at.traits.trace.results)
    of = traits(trace, at.traits.precision, [names], dict(zip(names, most, strict=True)))
    if len(of.lengths) != 1 or not (ends[0] > 0 and np.all(np.isfinite([*most, *ends]))):
        return None
    of = replace(of, shell=ends)
    reach = np.full(len(names), np.sqrt(ends[1]) * UPWARDS)
    every = Region(tuple(s.name for s in trace.steps if s.name), -reach, reach, ((0, 1, 2, 3),))
    return Cutting(of, every, 0, at.dice)
