"""An entry of a scene file's tables as a row of data, and the one way in which rows are read."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from derive.scene.declaration import AXES, Given, Parameter, SceneError, Turning
from derive.scene.formula import ZERO, Formula
from derive.scene.names import label
from derive.scene.numbers import positive
from derive.scene.scope import Scope, formula, formulas, triple
from derive.scene.table import (
    Table,
    interval,
    keys,
    one_of,
    rational,
    several,
    shown,
    table,
    text,
)
from derive.scene.unit import NONE, dimension

REQUIRED = "required"
MOST = 99
"""Of anything that is counted in a file."""


@dataclass(frozen=True)
class Entry:
    """One entry of a table: how its value is read, and what the manual says of it.

    kind    : a key of ``READERS``        words : those that a value may be
    unit    : SI unit of its formulas     scope : who may stand in them, a key of ``Reading.scopes``
    default : what stands for it where it is left out, as in a file; None if nothing does
    """

    key: str
    kind: str
    meaning: str
    unit: str = "1"
    scope: str = "constants"
    default: object = None
    words: tuple[str, ...] = ()


@dataclass(frozen=True)
class Reading:
    """What entries are read with: scopes of formulas, declared names by kind, parameters."""

    scopes: Mapping[str, Scope] = field(default_factory=dict)
    names: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True)
class _One:
    """A value to be read: what it is called, its row, and what it is read with."""

    value: object
    label: str
    row: Entry
    by: Reading

    @property
    def scope(self) -> Scope:
        """Return who may stand in its formulas."""
        return self.by.scopes[self.row.scope]

    def formula(self) -> Formula:
        """Return the value as a formula."""
        return formula(self.value, self.label, self.scope, dimension(self.row.unit))


def entries_of(given: Table, rows: Iterable[Entry], by: Reading) -> dict[str, Any]:
    """Return the values of a table's entries by key, None for what is left out without a default.

    Raises SceneError for a key that is missing or unknown, and for the first value that is wrong.
    """
    rows = tuple(rows)
    required = [row.key for row in rows if row.default is REQUIRED]
    keys(given, required, [row.key for row in rows if row.key not in required])
    return {row.key: _read(given, row, by) for row in rows}


def _read(given: Table, row: Entry, by: Reading) -> Any:
    value = given.entries.get(row.key, row.default)
    if value is None:
        return None
    return READERS[row.kind](_One(value, given.of(row.key), row, by))


def _turns(one: _One) -> tuple[Turning, ...]:
    """Return the turns of a list such as ["z psi", "x theta - tilt"]."""
    if not isinstance(one.value, list) or not one.value:
        raise SceneError(f"{one.label} must be a list such as ['z psi'], not {shown(one.value)}")
    return tuple(_turning(entry, one.label, one.scope) for entry in one.value)


def _turning(entry: object, label: str, scope: Scope) -> Turning:
    axis, _, angle = entry.strip().partition(" ") if isinstance(entry, str) else ("", "", "")
    if axis not in AXES or not angle.strip():
        rule = "a turn is an axis and an angle, as 'z psi'"
        raise SceneError(f"{label}: {rule}, not {shown(entry)}")
    return Turning(axis, formula(angle.strip(), label, scope, NONE))


def _positive(one: _One) -> Fraction:
    value = rational(one.value, one.label)
    if value <= 0:
        raise SceneError(f"{one.label} must be above 0, not {shown(one.value)}")
    return value


def _count(one: _One) -> int:
    count = one.value
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= MOST:
        raise SceneError(f"{one.label} must be a whole number from 1 to {MOST}, not {shown(count)}")
    return count


def _bounds(one: _One) -> Given:
    """Return a range that stands in a table of its own, as { range = [low, high] }."""
    if isinstance(one.value, list):
        raise SceneError(f"{one.label} must be {{ range = [low, high] }}, not {shown(one.value)}")
    inner = table(one.value, one.label)
    keys(inner, ("range",), ())
    return Given(*interval(inner.entries["range"], f"{one.label}.range"), None)


def _vector(one: _One) -> Given:
    """Return a known vector: a range for three fresh inputs, or three formulas."""
    if isinstance(one.value, list):
        return Given(None, None, triple(one.value, one.label, one.scope, dimension(one.row.unit)))
    if not isinstance(one.value, dict):
        rule = "must be { range = [low, high] } or three formulas"
        raise SceneError(f"{one.label} {rule}, not {shown(one.value)}")
    return _bounds(one)


def _names(one: _One) -> tuple[str, ...]:
    """Return the names of the components of a vector."""
    names = one.value if isinstance(one.value, list) else []
    if not 2 <= len(names) <= MOST or len(set(map(str, names))) < len(names):
        rule = "must be a list of different names such as ['x', 'y', 'z']"
        raise SceneError(f"{one.label} {rule}, not {shown(one.value)}")
    return tuple(label(text(name, one.label), f"a component in {one.label}") for name in names)


READERS: Mapping[str, Callable[[_One], Any]] = {
    "formula": _One.formula,
    "formula above 0": lambda one: positive(one.formula(), one.label, one.by.parameters),
    "formula above 0, or 0": lambda one: (
        made if (made := one.formula()) == ZERO else positive(made, one.label, one.by.parameters)
    ),
    "three formulas": lambda one: triple(one.value, one.label, one.scope, dimension(one.row.unit)),
    "three formulas xy, xz, yz": lambda one: formulas(
        one.value, one.label, ("xy", "xz", "yz"), one.scope, dimension(one.row.unit)
    ),
    "turns": _turns,
    "turns through coordinates": _turns,
    "range": lambda one: interval(one.value, one.label),
    "number": lambda one: rational(one.value, one.label),
    "number above 0": _positive,
    "count": _count,
    "names": _names,
    "text": lambda one: text(one.value, one.label),
    "word": lambda one: one_of(one.value, one.label, one.row.words),
    "frame": lambda one: one_of(one.value, one.label, one.by.names["frame"]),
    "body": lambda one: one_of(one.value, one.label, one.by.names["body"]),
    "bodies": lambda one: several(one.value, one.label, one.by.names["body"]),
    "bounds": _bounds,
    "vector": _vector,
    "table": lambda one: table(one.value, one.label),
    "any": lambda one: one.value,
}
"""How each kind of entry is read; of ``any``, what reads the table knows more."""
