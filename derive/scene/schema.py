"""The JSON Schema of a scene file, from the rows that readers follow, for editors and Taplo.

``derive schema`` prints it. It knows tables, entries, kinds of values and words; what a formula may
hold and how entries agree is told by ``derive generate`` alone. Draft 7 is what editors understand.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from derive.scene import entries
from derive.scene.entry import MOST, REQUIRED, Entry
from derive.scene.loads import MAIN
from derive.scene.names import LONGEST_NAME
from derive.scene.reader import MACHINE
from derive.scene.shape import ROUND, SHAPES
from derive.scene.short_form.tables import ONE_BODY
from derive.scene.wanted import WANTED

Schema = Mapping[str, Any]
FORMULA: Schema = {"type": ["string", "number"]}
_ABOVE: Schema = {**FORMULA, "exclusiveMinimum": 0}
_THREE: Schema = {"type": "array", "items": FORMULA, "minItems": 3, "maxItems": 3}
_RANGE: Schema = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
_BOUNDS: Schema = {
    "type": "object",
    "properties": {"range": _RANGE},
    "required": ["range"],
    "additionalProperties": False,
}
_NAME: Schema = {"type": "string", "minLength": 1}
_NAMES: Schema = {"type": "array", "items": _NAME, "minItems": 1, "uniqueItems": True}
_TURNS: Schema = {
    "type": "array",
    "items": {"type": "string", "pattern": r"^\s*[xyz] +\S"},
    "minItems": 1,
}
_LOAD: Schema = {"anyOf": [_THREE, {"type": "string", "pattern": r"^\s*\?[A-Za-z]"}]}
_RATE: Schema = {"anyOf": [FORMULA, _BOUNDS]}
_ONE_BODYS: Schema = {"items": {"enum": [*WANTED]}}
OF_KIND: Mapping[str, Schema] = {
    "formula": FORMULA,
    "formula above 0": _ABOVE,
    "formula above 0, or 0": {**FORMULA, "minimum": 0},
    "three formulas": _THREE,
    "three formulas xy, xz, yz": _THREE,
    "turns": _TURNS,
    "turns through coordinates": _TURNS,
    "range": _RANGE,
    "number": {"type": "number"},
    "number above 0": {"type": "number", "exclusiveMinimum": 0},
    "count": {"type": "integer", "minimum": 1, "maximum": MOST},
    "names": {**_NAMES, "minItems": 2},
    "text": _NAME,
    "word": {"type": "string"},
    "frame": _NAME,
    "body": _NAME,
    "bodies": {"anyOf": [_NAME, _NAMES]},
    "bounds": _BOUNDS,
    "vector": {"anyOf": [_BOUNDS, _THREE]},
    "table": {"type": "object"},
}
"""What a value of each kind looks like, by the keys of ``READERS``."""
OF_ANY: Mapping[str, Schema] = {
    "wanted": {
        "type": "array",
        "items": {"anyOf": [{"enum": [*WANTED]}, _NAME]},
        "minItems": 1,
        "uniqueItems": True,
    },
    "rate": _RATE,
    "acceleration": _RATE,
    "force": _LOAD,
    "couple": _LOAD,
    "lengths": {"type": "array", "items": FORMULA, "minItems": 2, "maxItems": 3},
    "formula": FORMULA,
    "gravity_gradient": {
        "anyOf": [
            FORMULA,
            {
                "type": "object",
                "properties": {row.key: FORMULA for row in entries.CENTRE_OF_FIELD},
                "additionalProperties": False,
            },
        ]
    },
    "unit": _NAME,
    "zero": FORMULA,
    "dependent": _NAMES,
    "axes": {**_NAMES, "items": {"enum": ["x", "y", "z"]}},
    "unknown": {"anyOf": [_NAME, _NAMES]},
    "vanishes": {"anyOf": [FORMULA, {"type": "array", "items": FORMULA, "minItems": 1}]},
    "name": {"type": "string", "pattern": "^[A-Za-z0-9]{1,20}$"},
}
"""What values look like of which the row says that their reader knows more, by entry."""


def schema() -> dict[str, Any]:
    """Return the schema of a scene file in either form."""
    head = _table(entries.FILE)
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "A scene of derive",
        "description": "A single body ([body]) or a machine ([bodies], [frames], [loads]); the"
        " manual is docs/scenes.md, every entry stands in docs/entries.md.",
        **head,
        "properties": {**head["properties"], **_tables()},
        "if": {"anyOf": [{"required": ["bodies"]}, {"required": ["frames"]}]},
        "then": {"required": ["bodies"], "properties": _foreign(MACHINE.tables)},
        "else": {
            "properties": {**_foreign(ONE_BODY.tables), "wanted": {"items": {"enum": [*WANTED]}}}
        },
    }


def _tables() -> dict[str, Any]:
    """Return what every table of a file holds, by its name."""
    rolling = _table(entries.FRAME)
    rolling["properties"]["rolls"] |= _table(entries.ROLLS)
    result = {"anyOf": [FORMULA, _table(entries.RESULT)]}
    named = {"anyOf": [FORMULA, _table(entries.FORMULA)]}
    parameter = {**_table(entries.PARAMETER),
                 "oneOf": [{"required": ["range"]}, {"required": ["value"]}]}  # fmt: skip
    return {
        "parameters": _named(parameter, "what set-up is told, or a number in the code"),
        "coordinates": _named(_table(entries.COORDINATE), "angles and lengths that change"),
        "speeds": _named(_table(entries.SPEED), "rates whose angle or length is not needed"),
        "inputs": _named(_table(entries.INPUT), "what is known at every instant"),
        "formulas": _named(named, "names for formulas, which may stand in others"),
        "frames": _named(rolling, "moving axes, each carried by another"),
        "bodies": _named(_member(), "rigid bodies, each carried by a frame"),
        "loads": _named(_load(), "forces, couples, weights, springs, gravity gradients"),
        "constraints": _named(_table(entries.CONSTRAINT), "what must hold of a motion"),
        "results": _named(result, "formulas of answers"),
        "linearised": _named(FORMULA, "values about which motion is small; 0 if not given"),
        "angular_momentum": _table(entries.MOMENTUM),
        "steady": {"anyOf": [_table(entries.STEADY), _named(_table(entries.STEADY), "several")]},
        "motion": _table((entries.TIME_STEP, entries.TIME, entries.COLUMN)),
        "axes": _table(entries.AXES_OF_ONE),
        "body": _body(),
        "point": _table(entries.POINT),
        "known": _table(entries.KNOWN),
        "wheels": {"type": "array", "items": _table(entries.WHEEL)},
        "position": _table(entries.POSITION),
    }


def _foreign(own: Iterable[str]) -> dict[str, bool]:
    """Return the tables that a form does not have."""
    return dict.fromkeys(sorted(_tables().keys() - {*own}), False)


def _named(each: Schema, says: str) -> dict[str, Any]:
    """Return a table of names, each with what it holds."""
    name = {"pattern": "^[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*$", "maxLength": LONGEST_NAME}
    return {"type": "object", "description": says, "propertyNames": name,
            "additionalProperties": each}  # fmt: skip


def _table(rows: Iterable[Entry]) -> dict[str, Any]:
    """Return a table of entries, required ones and no others."""
    rows = tuple(rows)
    return {
        "type": "object",
        "properties": {row.key: _value(row) for row in rows},
        "required": [row.key for row in rows if row.default is REQUIRED],
        "additionalProperties": False,
    }


def _value(row: Entry) -> dict[str, Any]:
    """Return what an entry's value looks like, with what the manual says of it."""
    found: dict[str, Any] = dict(OF_ANY[row.key] if row.kind == "any" else OF_KIND[row.kind])
    if row.words:
        found["enum"] = [*row.words]
    formulas = "formula" in row.kind or row.kind == "vector"
    unit = f", in {row.unit}" if formulas and row.unit != "1" else ""
    of = f"; formulas of {row.scope}" if formulas else ""
    return {**found, "description": f"{row.meaning or row.key}{unit}{of}"}


def _member() -> dict[str, Any]:
    """Return a body of a machine, of a kind, a shape or neither."""
    kinds = {("kind", name): (*rows, entries.MASS) for name, rows in entries.KINDS.items()}
    bare = (replace(entries.AXIS, default=None), entries.MASS, *entries.MEMBER)
    return _chosen(kinds | _shapes((*ROUND, *entries.SAID)), entries.MEMBER, bare)


def _body() -> dict[str, Any]:
    """Return a single body, of a kind or a shape."""
    kinds = {("kind", name): (*rows, entries.MASS) for name, rows in entries.KINDS.items()}
    found = _chosen(kinds | _shapes(SHAPES), entries.BODY, entries.BODY)
    return {**found, "oneOf": [{"required": ["kind"]}, {"required": ["shape"]}]}


def _shapes(names: Iterable[str]) -> dict[tuple[str, str], tuple[Entry, ...]]:
    return {("shape", name): entries.shape_entries(name) for name in names}


def _chosen(
    choices: Mapping[tuple[str, str], tuple[Entry, ...]], more: Iterable[Entry],
    bare: Iterable[Entry],
) -> dict[str, Any]:  # fmt: skip
    """Return a table whose entries depend on the word that one of them holds, or on none."""
    words: dict[str, list[str]] = {}
    for key, word in choices:
        words.setdefault(key, []).append(word)
    heads = tuple(
        Entry(key, "word", f"of the body: its {key}", words=tuple(own))
        for key, own in words.items()
    )
    every = {row.key: row for rows in (*choices.values(), bare, more, heads) for row in rows}
    loose = _table(replace(row, default=None) for row in every.values())
    cases = []
    for (key, word), rows in choices.items():
        said = {"properties": {key: {"const": word}}, "required": [key]}
        own = [*more, *rows, *(head for head in heads if head.key == key)]
        cases.append({"if": said, "then": _narrowed(every, own)})
    none = {"not": {"anyOf": [{"required": [key]} for key in words]}}
    return {**loose, "allOf": [*cases, {"if": none, "then": _narrowed(every, bare)}]}


def _narrowed(every: Mapping[str, Entry], rows: Iterable[Entry]) -> dict[str, Any]:
    """Return which of all entries one case has, which it needs, and where it says more."""
    own = {row.key: row for row in rows}
    values = {
        key: _value(own[key]) if key in own else False
        for key, row in every.items()
        if key not in own or _value(own[key]) != _value(row)
    }
    return {
        "required": [key for key, row in own.items() if row.default is REQUIRED],
        "properties": values,
    }


def _load() -> dict[str, Any]:
    """Return a load, which the first of its main entries makes what it is."""
    every = {row.key: row for rows in MAIN.values() for row in rows}
    loose = _table(replace(row, default=None) for row in every.values())
    cases, before = [], list[str]()
    for key, rows in MAIN.items():
        earlier = {"not": {"anyOf": [{"required": [k]} for k in before]}} if before else {}
        cases.append({"if": {"required": [key], **earlier}, "then": _narrowed(every, rows)})
        before.append(key)
    return {**loose, "anyOf": [{"required": [key]} for key in MAIN], "allOf": cases}


def schema_text() -> str:
    """Return the schema as ``derive schema`` prints it."""
    return f"{json.dumps(schema(), indent=1, ensure_ascii=False)}\n"
