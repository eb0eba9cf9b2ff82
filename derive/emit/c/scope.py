"""Names within one emitted function: none that the scene gives is one that the function declares.

What printers call their own values is read off the lines that they print, so that nothing has to
be listed here, and a name that is taken is refused by a sentence and not by a compiler.
"""

import re
from collections.abc import Iterable, Iterator, Sequence

from derive.scene import SceneError

_TYPE = r"(?:double|float|int|_Bool|unsigned char|unsigned short|\w+_(?:pair|sines)_f(?:32|64))"
_DECLARED = re.compile(rf"\s*(?:for \()?(?:static )?(?:const )?{_TYPE} ([^;]*);?")
_FIRST = re.compile(r"\*?([A-Za-z_]\w*)(?:\[\w+\])*(?: =.*)?")
_ASSIGNED = re.compile(r"\s*(?:for )?([A-Za-z_]\w*(?:, [A-Za-z_]\w*)*)(?: =| in) ")

_MACRO = re.compile(r"^#define (\w+)|\bdefined\((\w+)\)", re.MULTILINE)
_AT_THE_EDGE = re.compile(r"^(?:\} (\w+);|[A-Za-z_][\w *]*?\b(\w+)\()", re.MULTILINE)


def declared_in_c(lines: Iterable[str]) -> Iterator[str]:
    """Yield the names that lines of C declare.

    >>> list(declared_in_c(["double start[3], now[3];", "for (int j = 1, m = k - 1; j < 3;) {"]))
    ['start', 'now', 'j', 'm']
    """
    for line in lines:
        found = _DECLARED.match(line)
        if found:
            alone = set("({") & set(found[1])  # a value may hold commas too
            parts = found[1].split(", ")[: 1 if alone else None]
            yield from (one[1] for part in parts if (one := _FIRST.fullmatch(part)))


def declared_in_python(lines: Iterable[str]) -> Iterator[str]:
    """Yield the names that lines of Python assign to, and what every module calls CasADi.

    >>> list(declared_in_python(["a, b = c", "for k in range(3):"]))
    ['ca', 'a', 'b', 'k']
    """
    yield "ca"
    for line in lines:
        found = _ASSIGNED.match(line)
        if found:
            yield from found[1].split(", ")


def declared_by_file(text: str) -> set[str]:
    r"""Return the types, functions and macros that a text of C declares or asks for.

    >>> sorted(declared_by_file("} a_constants_f32;\nstatic int a_setup_f32(float b);\n  c(d);"))
    ['a_constants_f32', 'a_setup_f32']
    """
    found = (*_AT_THE_EDGE.findall(text), *_MACRO.findall(text))
    return {name for pair in found for name in pair if name}


def require_no_symbol(scene: str, given: Iterable[str], text: str) -> None:
    """Refuse a name of the scene that its C has for a type, a function or a macro."""
    taken = declared_by_file(text)
    for name in given:
        if name in taken:
            rule = "is what the emitted C calls a type, a function or a macro; give it another name"
            raise SceneError(f"scene '{scene}': '{name}' {rule}")


def require_free(scene: str, function: str, given: Sequence[str], declared: Iterable[str]) -> None:
    """Refuse a name of the scene that a function has for a value of its own, or that it has twice.

    given : the names of the function's arguments        declared : those of its own values
    """
    own = set(declared)
    for place, name in enumerate(given):
        if name in own or name in given[:place]:
            whose = "a value of its own" if name in own else "two arguments"
            raise SceneError(
                f"scene '{scene}': '{name}' is what the emitted function '{function}' calls "
                f"{whose}; give it another name"
            )
