"""A table of a scene file, read strictly: known keys, right types, exact numbers, right units.

Every function here raises SceneError with a sentence that begins at the table's own name.
"""

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import date, time
from decimal import Decimal
from fractions import Fraction
from numbers import Number

from derive.scene.declaration import SceneError
from derive.scene.escape import brief
from derive.scene.grammar import LARGEST_DECIMAL_EXPONENT
from derive.scene.unit import Dimension, UnitError, dimension

LONGEST_INTEGER_BITS = 1000
LONGEST_LINE, LONGEST_KEY = 1000, 100
DEEPEST, MANY = 20, 12
"""Tables and lists within each other, of which scenes need a few; names that a sentence lists."""
MARKS = ("*/", "/*", "\\", '"""', "??")
SPACES = "\t\n"
"""What may part the words of a formula beside blanks."""


THE_FILE = "the file"
NAMED = {
    "parameters": "parameter",
    "coordinates": "coordinate",
    "speeds": "speed",
    "inputs": "input",
    "frames": "frame",
    "bodies": "body",
    "loads": "load",
    "results": "result",
    "formulas": "formula",
}
"""Tables whose entries are named by the scene, and what one of them is called."""


SCALARS = ("parameter", "coordinate", "speed", "input", "wheel", "result", "formula")
"""What a table of few entries is called."""


@dataclass(frozen=True)
class Table:
    """One TOML table and the name that its errors begin with."""

    label: str
    entries: Mapping[str, object]

    def of(self, key: str) -> str:
        """Return what an entry is called in a sentence."""
        if self.label == THE_FILE:
            return key
        apart = ": " if self.label.partition(" ")[0] in SCALARS else "."
        return f"{self.label}{apart}{key}"


def gate(value: object, label: str, depth: int = 0) -> None:
    """Refuse a string anywhere in a document, key or value, that is not plain text.

    Every string passes here before anything else reads it: characters that can be seen, in either
    direction of writing as they stand, and no mark that ends a comment or a string.
    """
    if depth > DEEPEST:
        raise SceneError(f"{brief(label)} is nested deeper than {DEEPEST} tables or lists")
    if isinstance(value, dict):
        for key, inner in value.items():
            _require_plain(key, f"a key in {label}")
            if len(key) > LONGEST_KEY:
                rule = f"has a key of {len(key)} characters; {LONGEST_KEY} is the most"
                raise SceneError(f"{label} {rule}")
            gate(inner, _place(label, key), depth + 1)
    elif isinstance(value, list):
        for inner in value:
            gate(inner, label, depth + 1)
    elif isinstance(value, str):
        _require_plain(value, label)


def _place(label: str, key: str) -> str:
    """Return what an entry of a table is called in a sentence."""
    if label == THE_FILE:
        return key
    if label in NAMED:
        return f"{NAMED[label]} '{key}'"
    return f"{label}: {key}" if label.endswith("'") else f"{label}.{key}"


def _require_plain(value: str, label: str) -> None:
    hidden = next((c for c in value if not (c.isprintable() or c in SPACES)), None)
    if hidden is not None:
        rule = "holds a character that does not print"
        raise SceneError(f"{label} {rule}, {hidden!a}: {shown(value)}")
    for mark in MARKS:
        if mark in value:
            raise SceneError(f"{label} must not hold {mark}, which can end a comment or a string")


def table(value: object, label: str) -> Table:
    """Return a TOML value as a table."""
    if not isinstance(value, dict):
        raise SceneError(f"{label} must be a table, not {shown(value)}")
    return Table(label, value)


def keys(given: Table, required: Iterable[str], optional: Iterable[str]) -> None:
    """Refuse a table that misses a required key or has an unknown one."""
    required, optional = tuple(required), tuple(optional)
    for key in given.entries:
        if key not in required + optional:
            hint = nearest(key, required + optional)
            raise SceneError(f"{given.label} has an unknown key {shown(key)}{hint}")
    for key in required:
        if key not in given.entries:
            raise SceneError(f"{given.label} needs '{key}'")


def nearest(name: str, known: Iterable[str]) -> str:
    """Return a hint at the known name that resembles an unknown one most, or all of a few."""
    known = tuple(known)
    close = difflib.get_close_matches(name, known, 1)
    if close:
        return f" (did you mean '{close[0]}'?)"
    return f" (known: {', '.join(known)})" if 0 < len(known) <= MANY else ""


def shown(value: object) -> str:
    """Return a TOML value as an error shows it: itself, cut off if it is long, and its kind.

    >>> shown([1, "a"]), shown({"a": True}), shown("a")
    ("a list of 2, [1, 'a']", 'a table, { a = true }', "'a'")
    """
    kind = "a table, " if isinstance(value, dict) else ""
    kind = f"a list of {len(value)}, " if isinstance(value, list) else kind
    return kind + brief(_spelled(value))


def _spelled(value: object, depth: int = 0) -> str:
    """Return a TOML value in one line; what is not one by its type."""
    if isinstance(value, dict | list) and depth > DEEPEST:
        return "..."
    if isinstance(value, dict):
        each = [f"{key} = {_spelled(own, depth + 1)}" for key, own in value.items()]
        return f"{{ {', '.join(each)} }}" if each else "{}"
    if isinstance(value, list):
        return f"[{', '.join(_spelled(own, depth + 1) for own in value)}]"
    if isinstance(value, int) and value.bit_length() > LONGEST_INTEGER_BITS:
        return f"a number of {value.bit_length()} bits"
    if isinstance(value, str):
        return repr(value)
    return str(value).lower() if isinstance(value, Number | date | time) else type(value).__name__


def one_of(value: object, label: str, known: Iterable[str]) -> str:
    """Return a value that must be one of a few words."""
    known = tuple(known)
    if not isinstance(value, str) or value not in known:
        raise SceneError(f"{label} must be {_choice(known)}, not {shown(value)}")
    return value


def _choice(known: tuple[str, ...]) -> str:
    if len(known) < 2:
        return f"'{known[0]}'" if known else "one that is declared, but none is"
    more = f" or {len(known) - MANY} others" if len(known) > MANY else ""
    return f"one of {', '.join(known[:MANY])}{more}"


def several(value: object, label: str, known: Iterable[str]) -> tuple[str, ...]:
    """Return one word or a list of different ones, each one of a few."""
    known, each = tuple(known), value if isinstance(value, list) else [value]
    if not each:
        raise SceneError(f"{label} is an empty list; leave it out to mean all")
    found = tuple(one_of(one, label, known) for one in each)
    for name in found:
        if found.count(name) > 1:
            raise SceneError(f"{label} has '{name}' twice")
    return found


def text(value: object, label: str) -> str:
    """Return one line of text that may stand in a comment of C and in a string of Python."""
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise SceneError(f"{label} must be one line of text, not {shown(value)}")
    if len(value) > LONGEST_LINE:
        raise SceneError(f"{label} is {len(value)} characters long; {LONGEST_LINE} is the most")
    _require_plain(value, label)
    return value


def rational(value: object, label: str) -> Fraction:
    """Return an exact, finite number."""
    if isinstance(value, bool) or not isinstance(value, int | Decimal):
        raise SceneError(f"{label} must be a number, not {shown(value)}")
    long = isinstance(value, int) and value.bit_length() > LONGEST_INTEGER_BITS
    if not long and not Decimal(value).is_finite():
        raise SceneError(f"{label} must be finite, not {value}")
    if long or (value and abs(Decimal(value).adjusted()) > LARGEST_DECIMAL_EXPONENT):
        most = f"1e-{LARGEST_DECIMAL_EXPONENT} to 1e{LARGEST_DECIMAL_EXPONENT}"
        raise SceneError(f"{label} must be 0 or of size {most}, not {shown(value)}")
    return Fraction(value)


def interval(value: object, label: str) -> tuple[Fraction, Fraction]:
    """Return a range [low, high] with low < high."""
    if not isinstance(value, list) or len(value) != 2:
        raise SceneError(f"{label} must be a list of 2, not {shown(value)}")
    low, high = (rational(end, label) for end in value)
    if low >= high:
        state = "empty" if low == high else "reversed"
        raise SceneError(f"{label} is {state}: [{float(low):g}, {float(high):g}]")
    return low, high


def unit(given: Table) -> Dimension:
    """Return the dimension of a table's unit."""
    try:
        return dimension(text(given.entries["unit"], f"{given.label}.unit"))
    except UnitError as error:
        raise SceneError(f"{given.label}: {error}") from None
