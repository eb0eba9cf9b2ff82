"""A scene given as a dict, written as the TOML text that says the same: one reader for both.

Numbers are written by their shortest decimals, so that 0.1 is read as one tenth, as in a file.
"""

import json
from collections.abc import Iterator, Mapping
from decimal import Decimal
from numbers import Integral, Real

from derive.scene.declaration import SceneError
from derive.scene.table import DEEPEST, shown

RULE = "must be text, a number, true or false, a list or a table"


def toml(document: Mapping[str, object]) -> str:
    """Return the TOML text of a parsed document; a table at its top stands under its own header.

    Raises SceneError for what TOML has no value for.

    >>> print(toml({"wanted": ["moment"], "body": {"kind": "spherical", "moment": 0.4}}), end="")
    wanted = ["moment"]
    <BLANKLINE>
    [body]
    kind = "spherical"
    moment = 0.4
    """
    tables = {key: own for key, own in document.items() if isinstance(own, Mapping)}
    lines = [*_rows({key: own for key, own in document.items() if key not in tables}, "")]
    for key, own in tables.items():
        lines += ["", f"[{_key(key, 'the file')}]", *_rows(own, key)]
    return "\n".join([*lines, ""])


def _rows(table: Mapping[str, object], label: str) -> Iterator[str]:
    for key, value in table.items():
        place = f"{label}.{key}" if label else str(key)
        yield f"{_key(key, label or 'the file')} = {_value(value, place, 0)}"


def _key(key: object, label: str) -> str:
    if not isinstance(key, str):
        raise SceneError(f"a key in {label} must be text, not {shown(key)}")
    return key if key.isascii() and key.replace("_", "a").isalnum() else _text(key)


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: object, label: str, depth: int) -> str:
    if depth > DEEPEST:
        raise SceneError(f"{label} is nested deeper than {DEEPEST} tables or lists")
    match value:
        case str():
            return _text(value)
        case bool():
            return str(value).lower()
        case Integral():
            return _whole(int(value), label)
        case Decimal() if value.is_finite():
            return str(value)
        case Real() | Decimal():
            return repr(float(value))
        case Mapping():
            each = (f"{_key(k, label)} = {_value(v, label, depth + 1)}" for k, v in value.items())
            return f"{{ {', '.join(each)} }}" if value else "{}"
        case list() | tuple():
            return f"[{', '.join(_value(own, label, depth + 1) for own in value)}]"
        case _:
            raise SceneError(f"{label} {RULE}, not {type(value).__name__}")


def _whole(value: int, label: str) -> str:
    try:
        return str(value)
    except ValueError:  # Python writes no whole number of so many digits
        raise SceneError(f"{label} holds a whole number of too many digits") from None
