"""Limits on the way: of states, of inputs, of what the scene's functions tell of both, of turns."""

import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from decimal import Decimal
from math import inf
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from derive.control.aim import Aim, vector_names
from derive.control.plant import NDFloat, Plant
from derive.control.slew import outside
from derive.library.library import library
from derive.scene import SceneError, read
from derive.scene.table import nearest, shown
from derive.solve.arguments import one_number
from derive.solve.instrument import Instrument, instrument
from derive.solve.settings import number

BEYOND = 1e-9  # of a limit's width, that rounding may lead the start beyond it
CONE = "an axis comes to the edge of what it avoids"


@dataclass(frozen=True)
class Keeps:
    """What must not be above 0: (x, u) -> values, each a part of its limit's width, and what it is.

    last    : those that hold at the end too, by number: inputs do not change them, and what the
              end says of the states does not settle them
    reached : what is said of each where it is 0
    ends    : of what a function tells, its other limit and the one that is reached then
    """

    at: Any
    last: tuple[int, ...]
    reached: tuple[str, ...]
    ends: tuple[tuple[float, float], ...]

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
    named: Collection[str],
) -> tuple[NDFloat, NDFloat, Keeps]:
    """Return the least and largest x and u; of ``ranged``, those of their ranges, if none else.

    And all else that is to be kept; the end says what the ``named`` states are there.
    Raises SceneError for what makes no sense.
    """
    every = (*own.x, *own.u)
    ends = dict.fromkeys(every, (-inf, inf)) | {n: own.ranges[n] for n in ranged}
    whole, seen = vector_names(own), set[str]()
    x, u = casadi.SX.sym("x", len(own.x)), casadi.SX.sym("u", len(own.u))
    away = [outside(own, says, text, x) for text in avoid]
    reached, sides = [CONE] * len(away), [(0.0, 0.0)] * len(away)
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
            sides += [(low, high), (high, low)]
    low, high = np.array([ends[n] for n in every]).T
    free = casadi.vertcat(*(x[k] for k, n in enumerate(own.x) if n not in named))
    depends = casadi.depends_on
    last = (k for k, a in enumerate(away) if depends(a, free) and not depends(a, u))
    at = casadi.Function("keeps", [x, u], [casadi.vertcat(*away)])
    return low, high, Keeps(at, (*last,), (*reached,), (*sides,))


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
        rule = "LOW..HIGH must ascend" if dots else "a limit must be above 0, or LOW..HIGH"
        raise SceneError(f"{label}: {rule}, not {value}")
    return low, high


def require_room(own: Plant, says: str, to: Aim, low: NDFloat, high: NDFloat) -> None:
    """Refuse a start, or an end, that lies outside of its own limits."""
    for k, name in enumerate(own.x):
        asked = (("start", to.start), *((("end", to.goal),) if name in to.named else ()))
        for where, at in asked:
            if not low[k] <= at[k] <= high[k]:
                rule = f"must be within its limits, {low[k]:g} to {high[k]:g}"
                raise SceneError(f"{says}: {name} at the {where} {rule}, not {at[k]:g}")


def require_kept(
    own: Plant, says: str, keeps: Keeps, to: Aim, within: tuple[NDFloat, NDFloat]
) -> None:
    """Refuse a start whose inputs, however they are within their limits, leave one of all else.

    And an end where what it says of the states does. What is not linear in inputs is not judged.
    """
    if not len(keeps):
        return
    x, u = casadi.SX.sym("x", len(own.x)), casadi.SX.sym("u", len(own.u))
    rows = keeps.at(x, u)
    jacobian = casadi.jacobian(rows, u)
    judged = np.array([not casadi.depends_on(row, u) for row in casadi.vertsplit(jacobian)])
    slopes = casadi.Function("slopes", [x, u], [rows, jacobian])
    free = [k for k, name in enumerate(own.x) if name not in to.named]
    known = judged & ~_rests(keeps.at.sparsity_jac(0, 0), free)
    known &= ~_rests(keeps.at.sparsity_jac(1, 0), range(len(own.u)))
    for place, state, those in (("start", to.start, judged), ("end", to.goal, known)):
        values, by = (m.full() for m in slopes(state, np.zeros(len(own.u))))
        with np.errstate(invalid="ignore"):
            least = np.where(by == 0, 0.0, np.minimum(by * within[0], by * within[1]))
        values = values.ravel() + least.sum(axis=1)
        for k in np.flatnonzero(those & (values > BEYOND)):
            if keeps.reached[k] == CONE:
                raise SceneError(f"{says}: the {place} lies inside of what is to be avoided")
            name, (other, limit) = keeps.reached[k].partition(" ")[0], keeps.ends[k]
            rule = f"must be within its limits, {min(other, limit):g} to {max(other, limit):g}"
            found = f"{limit + values[k] * (limit - other):g}"
            if by[k].any():
                found += f" at {'most' if limit < other else 'least'}, whatever the inputs"
            raise SceneError(f"{says}: {name} at the {place} {rule}, not {found}")


def _rests(pattern: Any, columns: Sequence[int]) -> NDArray[np.bool_]:
    """Return which rows change with any of some columns."""
    found: NDArray[np.bool_] = casadi.DM(pattern, 1).full()[:, list(columns)].any(axis=1)
    return found
