"""Limits on the way: of states, of inputs, of what the scene's functions tell of both, of turns."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from decimal import Decimal
from math import inf
from typing import Any

import casadi
import numpy as np

from derive.control.aim import Aim, vector_names
from derive.control.plant import NDFloat, Plant
from derive.control.slew import outside
from derive.library.library import library
from derive.scene import SceneError, read
from derive.scene.table import nearest, shown
from derive.solve.arguments import one_number
from derive.solve.instrument import Instrument, instrument
from derive.solve.settings import number

CONE = "an axis comes to the edge of what it avoids"


@dataclass(frozen=True)
class Keeps:
    """What must not be above 0: (x, u) -> values, each a part of its limit's width, and what it is.

    reached : what is said of each where it is 0
    """

    at: Any
    reached: tuple[str, ...]

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.reached)

    @property
    def takes_inputs(self) -> bool:
        """Tell whether a value changes with the inputs."""
        return bool(len(self) and self.at.sparsity_jac(1, 0).nnz())


def limited(
    own: Plant,
    says: str,
    limits: Mapping[str, float | str],
    ranged: Sequence[str],
    avoid: Sequence[str],
) -> tuple[NDFloat, NDFloat, Keeps]:
    """Return the least and largest x and u; of ``ranged``, those of their ranges, if none else.

    And all else that is to be kept. Raises SceneError for what makes no sense.
    """
    every = (*own.x, *own.u)
    ends = dict.fromkeys(every, (-inf, inf)) | {n: own.ranges[n] for n in ranged}
    whole, seen = vector_names(own), set[str]()
    x, u = casadi.SX.sym("x", len(own.x)), casadi.SX.sym("u", len(own.u))
    away = [outside(own, says, text, x) for text in avoid]
    reached = [CONE] * len(away)
    for name, value in limits.items():
        label, named = f"{says}: limit {name}", [c for c in whole.get(name, (name,)) if c in ends]
        told = {} if named else dict(_told(own, says, name, x, u))
        _require_once(says, seen, named or told)
        if named:
            ends |= dict.fromkeys(named, _ends(label, value, own.units[named[0]]))
        for component, (expression, unit) in told.items():
            low, high = _ends(label, value, unit)
            away += [(expression - high) / (high - low), (low - expression) / (high - low)]
            reached += [f"{component} comes to its limit"] * 2
    low, high = np.array([ends[n] for n in every]).T
    return low, high, Keeps(casadi.Function("keeps", [x, u], [casadi.vertcat(*away)]), (*reached,))


def _require_once(says: str, seen: set[str], named: Sequence[str] | Mapping[str, Any]) -> None:
    if twice := sorted(seen.intersection(named)):
        raise SceneError(f"{says}: {twice[0]} is limited twice")
    seen.update(named)


def _told(
    own: Plant, says: str, name: str, x: Any, u: Any
) -> Iterator[tuple[str, tuple[Any, str]]]:
    """Yield the components of what a function of the scene tells of x and u, with their unit."""
    at = {**own.given, **{n: x[k] for k, n in enumerate(own.x)}}
    at |= {n: u[k] for k, n in enumerate(own.u)}
    for scene in _telling(own, name):
        for function in scene.library.functions:
            if not {*scene.needed(function.name)} <= at.keys():
                continue
            for q in scene.library[function.name].outputs:
                named = q.components if name == q.name else {name}.intersection(q.components)
                if named:
                    values = scene.answer(function.name, at)
                    yield from ((c, (values[c], q.unit)) for c in named)
                    return
    rule = "a limit is of a state, an input, or what a function of the scene tells of these"
    raise SceneError(f"{says}: {rule}, not of {shown(name)}{nearest(name, (*own.x, *own.u))}")


def _telling(own: Plant, name: str) -> Iterator[Instrument]:
    """Yield the scene, as it is, and as it would be if it wanted a function called so."""
    yield instrument(library(own.scene))
    document = tomllib.loads(own.scene.text, parse_float=Decimal)
    for wanted in dict.fromkeys((name, name.rpartition("_")[0])):
        with suppress(SceneError):
            wishes = {**document, "wanted": [wanted]}
            yield instrument(library(read(wishes, own.scene.name, own.scene.text)))


def _ends(label: str, value: float | str, unit: str) -> tuple[float, float]:
    """Return the limits that a text tells: 0.4 is -0.4 to 0.4, and 0..2 is what it says."""
    first, dots, last = value.partition("..") if isinstance(value, str) else ("", "", "")
    if dots:
        low, high = (number(label, t.strip(), unit) for t in (first, last))
    else:
        own = number(label, value.strip(), unit) if isinstance(value, str) else value
        high = one_number(label, "the limit", own)
        low = -high
    if not low < high:
        raise SceneError(f"{label}: a limit must be above 0, or LOW..HIGH, not {value}")
    return low, high


def require_room(own: Plant, says: str, to: Aim, low: NDFloat, high: NDFloat) -> None:
    """Refuse a start, or an end, that lies outside of its own limits."""
    for k, name in enumerate(own.x):
        asked = (("start", to.start), *((("end", to.goal),) if name in to.named else ()))
        for where, at in asked:
            if not low[k] <= at[k] <= high[k]:
                rule = f"must be within its limits, {low[k]:g} to {high[k]:g}"
                raise SceneError(f"{says}: {name} at the {where} {rule}, not {at[k]:g}")


def require_kept(own: Plant, says: str, keeps: Keeps, where: Mapping[str, NDFloat]) -> None:
    """Refuse a start, or an end, where what is told of the states alone is beyond its limit."""
    if not len(keeps):
        return
    alone = np.array(casadi.DM(keeps.at.sparsity_jac(1, 0), 1)).sum(axis=1) == 0
    for place, at in where.items():
        values = np.array(keeps.at(at, np.zeros(len(own.u)))).ravel()
        for k in np.flatnonzero(alone & (values > 0)):
            if keeps.reached[k] == CONE:
                raise SceneError(f"{says}: the {place} lies inside of what is to be avoided")
            name = keeps.reached[k].partition(" ")[0]
            raise SceneError(f"{says}: {name} at the {place} is beyond its limit")
