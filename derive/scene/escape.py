"""Text made safe for the place where it is printed, whatever it holds.

``derive.scene.table.gate`` lets no such text in; here nothing is left to that. HTML is escaped by
its templates, JSON by its writer.
"""

from collections.abc import Mapping

LONGEST_SHOWN, MOST_NAMED = 60, 6
"""Characters of a formula and names of a place in a sentence: more would hide what it says."""


def visible(text: str) -> str:
    r"""Return one line that a terminal shows and does not obey.

    >>> print(visible("a\x1b[31mb\nc"))
    a\x1b[31mb\nc
    """
    return "".join(c if c.isprintable() else _spelled(c) for c in text)


def brief(value: object) -> str:
    """Return a formula, as it was written, or a name as a sentence shows it, cut off if it is long.

    >>> brief("m*g"), len(brief("m" * 200))
    ('m*g', 60)
    """
    text = getattr(value, "as_written", str(value))
    return text if len(text) <= LONGEST_SHOWN else f"{text[: LONGEST_SHOWN - 3]}..."


def at_place(values: Mapping[str, float]) -> str:
    """Return words for a place in a sentence, "" for none: at most a handful of its quantities.

    pi is the same at every place, and not named.

    >>> at_place({"a": 0.0, "b": 1.25})
    ' at a = 0, b = 1.25'
    """
    each = [f"{name} = {x:.6g}" for name, x in values.items() if name != "pi"]
    more = ", ..." if len(each) > MOST_NAMED else ""
    return f" at {', '.join(each[:MOST_NAMED])}{more}" if each else ""


def _spelled(character: str) -> str:
    return character.encode("unicode_escape", "surrogatepass").decode("ascii")


def in_comment(text: str) -> str:
    r"""Return one line that stays inside a comment of C and goes on nowhere else.

    >>> print(in_comment("a */ b /* ??/ c" + chr(92)))
    a * / b / * ? ?/ c\.
    """
    line = visible(text).replace("*/", "* /").replace("/*", "/ *")
    while "??" in line:  # a trigraph may spell a backslash
        line = line.replace("??", "? ?")
    return f"{line}." if line.endswith("\\") else line


def in_docstring(text: str) -> str:
    r"""Return one line that stays inside a string between three double quotes.

    >>> print(in_docstring('a \"\"\" b' + chr(92)))
    a \"\"\" b\\
    """
    return visible(text).replace("\\", "\\\\").replace('"', '\\"')
