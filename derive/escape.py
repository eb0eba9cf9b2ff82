"""Text made safe for the place where it is printed, whatever it holds.

``derive.scene.table.gate`` lets no such text in; here nothing is left to that. HTML is escaped by
its templates, JSON by its writer.
"""


def visible(text: str) -> str:
    r"""Return one line that a terminal shows and does not obey.

    >>> print(visible("a\x1b[31mb\nc"))
    a\x1b[31mb\nc
    """
    return "".join(c if c.isprintable() else _spelled(c) for c in text)


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
