"""Statements of emitted C, one of each kind, each in a function of its own.

A function of thousands of operations keeps cppcheck busy for an hour. Statements that differ in
names and numbers alone obey rules of precedence, types and suffixes alike, wherever they stand.
"""

import re
from collections.abc import Iterator, Mapping

MADE = re.compile(r"^ +(?:const )?(\w+) (\w+) = [^;{]*;$|^ +const (\w+) (\w+) = \{.*\};$")
STORED = re.compile(r"^ +(?:\*?\w+|\w+(?:\[\w+\])+|constants->\w+) [-+]?= [^;]*;$")
PAIR = "pair"
MEMBER = re.compile(r"\b(\w+)\.(?:high|low)\b")
COUNTER = re.compile(r"\[(\w+)")
ARRAY = re.compile(r"\b(\w+)((?:\[[^]]+\])+)")
NAME = re.compile(r"(?<![\w.>])[A-Za-z_]\w*\b(?!\()")
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:[eE][+-]?\d+)?")
WORDS = {"const", "float", "double", "int", "_Bool", "constants", "F", "pair"}


def joined(text: str) -> list[str]:
    """Return lines of C, each with what goes on in the next ones."""
    lines: list[str] = []
    for line in text.splitlines():
        if lines and re.match(r"    .*[^;{}:/]$", lines[-1]) and line.startswith("     "):
            lines[-1] = f"{lines[-1]} {line.strip()}"
        else:
            lines.append(line)
    return lines


def statements(text: str, scene: str, scalar: str) -> Iterator[tuple[str, str]]:
    """Yield kind and text of every statement of a file that makes or stores a value."""
    types: dict[str, str] = {}
    for line in joined(re.sub(rf"{scene}_pair_f\d+", PAIR, text).replace(f"{scene}_", "")):
        if line == "{":
            types = {}
        if made := MADE.match(line):
            kind, name = (made[1], made[2]) if made[2] else (made[3], made[4])
            yield _kind(line, types), _alone(line, types, scalar)
            types[name] = kind
        elif STORED.match(line):
            yield _kind(line, types), _alone(line, types, scalar)


def _kind(line: str, types: Mapping[str, str]) -> str:
    """Return a statement with types for names, and one number for all."""
    own = re.sub(r"constants->\w+", "constant", line.strip())
    return NUMBER.sub("0", NAME.sub(lambda name: types.get(name[0], "value"), own))


def _alone(line: str, types: Mapping[str, str], scalar: str) -> str:
    """Return a statement in a function that is given all that it needs."""
    own = re.sub(r"constants->(\w+)", r"constants_\1", line)
    types = dict.fromkeys(MEMBER.findall(own), PAIR) | dict(types)
    types |= dict.fromkeys(COUNTER.findall(own), "int")
    deep = {m[1]: m[2].count("[") for m in ARRAY.finditer(own)}
    made = MADE.match(line)
    made_here = {made[2] or made[4]} if made else set()
    names = dict.fromkeys(NAME.findall(re.sub(r"\.\w+", "", own)))
    given = [
        f"{scalar} {'*' * deep[n]}{n}" if n in deep else f"{types.get(n, scalar)} {n}"
        for n in names
        if n not in made_here and n not in WORDS
    ]
    return f"({', '.join(given) or 'void'})\n{{\n{own}\n}}\n"


def every_kind(texts: Mapping[str, str], scalar: str) -> str:
    """Return C with a statement of each kind in files, by scene; all in one precision."""
    kinds: dict[str, str] = {}
    for scene, text in texts.items():
        for kind, alone in statements(text, scene, scalar):
            kinds.setdefault(kind, alone)
    head = f"typedef struct {{ {scalar} high; {scalar} low; }} {PAIR};\n"
    each = (f"void f{n}{alone}" for n, alone in enumerate(kinds.values()))
    return head + "".join(each)
