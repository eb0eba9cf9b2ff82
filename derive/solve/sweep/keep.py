"""What a sweep keeps of every motion: a course at instants, the end, the largest, an instant."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from derive.scene import SceneError
from derive.scene.table import MANY, nearest, shown
from derive.solve.event import answers_along
from derive.solve.instrument import Instrument
from derive.solve.told import met

COURSE = "course"
EXTREMES: Mapping[str, Any] = {"max": np.maximum, "min": np.minimum}
WORDS = ("end", *EXTREMES)
MOST_KEPT = 200


@dataclass(frozen=True)
class KeptColumn:
    """A column: of which component, and what of it; ``time`` s is that of an instant.

    how : "course", "end", "max", "min" or "at"
    """

    column: str
    component: str
    how: str
    unit: str
    time: float = 0.0


def kept_columns(
    found: Instrument, given: Mapping[str, float], texts: object, until: float, more: Sequence[str]
) -> tuple[KeptColumn, ...]:
    """Return what is kept, of texts such as ``theta``, ``energy@end`` and ``theta@2.5``.

    given : names that have a value, beside the state        more : what else is kept
    Raises SceneError for what is not known along a motion, and for other words behind the ``@``.
    """
    label = f"scene '{found.name}': keep"
    if isinstance(texts, str) or not isinstance(texts, Sequence):
        rule = "takes a list of texts, as ['theta', 'theta@max']"
        raise SceneError(f"{label} {rule}, not {met(texts)}")
    units, whole = _units_along(found, given)
    each: dict[str, KeptColumn] = {}
    for text in (*texts, *more):
        if not isinstance(text, str):
            raise SceneError(f"{label} takes texts, as 'theta@max', not {met(text)}")
        name, at, word = (part.strip() for part in text.strip().partition("@"))
        if name not in whole:
            few = ", ".join([*whole][:MANY])
            hint = nearest(name, whole) or f" (known: {few})"
            raise SceneError(f"{label}: {shown(name)} is no state or answer that is known{hint}")
        how, time = _how(label, text, word, until) if at else (COURSE, 0.0)
        for component in whole[name]:
            column = f"{component}@{word or COURSE}"
            each[column] = KeptColumn(column, component, how, units[component], time)
    if not 0 < len(each) <= MOST_KEPT:
        raise SceneError(f"{label} takes 1 to {MOST_KEPT} components, not {len(each)}")
    return tuple(each.values())


def _how(label: str, text: str, word: str, until: float) -> tuple[str, float]:
    if word in WORDS:
        return word, 0.0
    try:
        time = float(word)
    except ValueError:
        time = -1.0
    if not (isfinite(time) and 0 <= time <= until) or "_" in word:
        rule = f"behind @ stands end, max, min or a time in s up to {until:g}"
        raise SceneError(f"{label} {text[:60]}: {rule}, not {shown(word)}")
    return "at", time


def _units_along(
    found: Instrument, given: Mapping[str, float]
) -> tuple[dict[str, str], dict[str, tuple[str, ...]]]:
    """Return the unit of every component that is known along a motion, and the whole names."""
    functions = answers_along(found, given)
    outputs = [q for name in dict.fromkeys(functions.values()) for q in found.library[name].outputs]
    units: dict[str, str] = {}
    whole: dict[str, tuple[str, ...]] = {}
    for q in (*found.library.vocabulary.states, *outputs):
        own = tuple(c for c in q.components if c not in units)
        if own:
            whole.setdefault(q.name, q.components)
            units |= dict.fromkeys(own, q.unit)
            whole |= {c: (c,) for c in own if c not in whole}
    return units, whole
