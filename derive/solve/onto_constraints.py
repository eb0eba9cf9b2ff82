"""The start of a motion of a machine with constraints, and how far from them the motion is."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library
from derive.scene import SceneError
from derive.scene.unit import behind
from derive.solve.instrument import Instrument

TYPED = 1e-3
"""A part of its range by which a value of the start may be rounded, or measured."""
ROUNDED = 1e-12
"""A part of its range that a value of an example is not written out for."""
KEPT = 1e-6
"""A part of its range by which nobody minds that a value is mended."""


def start_on_constraints(
    found: Instrument, given: Mapping[str, float]
) -> tuple[dict[str, float], list[str]]:
    """Return the values with the state brought onto the constraints, and sentences on what moved.

    Raises SceneError if the state is further from them than it could be by rounding.
    """
    brings = found.library.mechanism.held.onto
    if brings is None:
        return dict(given), []
    names = [c for q in found.library.vocabulary.given() for c in q.components]
    here = _values_given(brings, names, given)
    (there,), (fits,) = brings.brought(here[None, :])
    label = f"scene '{found.name}'"
    moved = {n: (float(there[k] - here[k]), size) for n, k, size in _free_in_time(brings, names)}
    far = {n: abs(by) / size for n, (by, size) in moved.items()}
    if not fits or max(far.values()) > TYPED:
        name, value = brings.worst(here)
        rule = f"a motion must begin where {name} is 0, not {value:.4g}"
        more = "no state nearby fulfils all of them"
        if (state := there if fits else found.library.mechanism.fulfilling(here)) is not None:
            each = (f"{n}={state[names.index(n)]:.9g}" for n in far)
            more = f"a state {'nearby ' * bool(fits)}that fulfils all is {', '.join(each)}"
        raise SceneError(f"{label}: {rule}; {more}")
    units = {c: q.unit for q in found.quantities() for c in q.components}
    doubts = [
        f"{n} begins at {there[names.index(n)]:.9g}{behind(units[n])}, not {given[n]:.9g}, "
        "so that the constraints hold"
        for n, part in far.items()
        if part > KEPT
    ]
    return dict(given) | {n: float(there[names.index(n)]) for n in moved}, doubts


def held_example(library: Library, given: Mapping[str, str]) -> dict[str, str]:
    """Return values as text, those of a state that does not fulfil the constraints changed so."""
    brings = library.mechanism.held.onto
    names = [c for q in library.vocabulary.given() for c in q.components]
    if brings is None or not {n for n, _, _ in _free_in_time(brings, names)} <= given.keys():
        return dict(given)
    here = _values_given(brings, names, given)
    (there,), (fits,) = brings.brought(here[None, :])
    if (there := there if fits else library.mechanism.fulfilling(here)) is None:
        return dict(given)
    moved = [n for n, k, size in _free_in_time(brings, names)
             if abs(there[k] - here[k]) > ROUNDED * size]  # fmt: skip
    return dict(given) | {n: f"{there[names.index(n)]:.9g}" for n in moved}


def left_of_constraints(
    found: Instrument, given: Mapping[str, float], columns: Mapping[str, NDArray[np.float64]]
) -> list[tuple[str, float]]:
    """Return the largest value of every condition on a motion, by its name."""
    brings = found.library.mechanism.held.onto
    if brings is None:
        return []
    names = [c for q in found.library.vocabulary.given() for c in q.components]
    count = len(next(iter(columns.values())))
    each = np.tile(_values_given(brings, names, given)[:, None], count)
    for n, values in columns.items():
        each[names.index(n)] = values
    return [(name, float(np.max(np.abs(own)))) for name, own in brings.distances(each)]


def _values_given(brings: Any, names: list[str], given: Mapping[str, Any]) -> NDArray[np.float64]:
    """Return all that conditions may rest on; what is not given, they do not rest on."""
    rest = dict.fromkeys(names, 1.0) | dict(given)
    return np.array([float(rest[n]) for n in names] + [1.0] * (len(brings.symbols) - len(names)))


def _free_in_time(brings: Any, names: list[str]) -> list[tuple[str, int, float]]:
    every = {**brings.places, **brings.rates}
    return [(names[k], k, size) for k, size in every.items()]
