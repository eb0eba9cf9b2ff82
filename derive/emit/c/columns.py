"""Lines of C broken where they are too long for a screen; what they mean does not change."""

import re

COLUMNS = 120
_PLACES = (re.compile(r", "), re.compile(r"(?<=[\w])\((?=\w)|[?:=] | [-+*/]=? "), re.compile(r" "))
"""Where lines are broken: after a comma; in a call, at a sign; anywhere between words."""


def within_columns(text: str) -> str:
    """Return a text of C with no line of more than COLUMNS, if words and commands are shorter.

    >>> [len(line) for line in within_columns("x = f(" + "a, " * 40 + "b);").splitlines()]
    [119, 13]
    >>> within_columns(" * " + "a " * 50 + "`b" + " c" * 20 + "`.").splitlines()[1][:9]
    ' *   `b c'
    """
    return "\n".join(part for line in text.split("\n") for part in _parts(line))


def _parts(line: str) -> list[str]:
    if len(line) <= COLUMNS or line.startswith("#"):
        return [line]
    if line.lstrip().startswith('"'):
        return [line.lstrip()]  # a string stays whole
    indent = line[: len(line) - len(line.lstrip())]
    remark = re.match(r"/?\s*\*\s*", line)
    head = f" *{' ' * len(remark[0])}" if remark else f"{indent}    "
    most = line[:COLUMNS]
    for place in _PLACES[2:] if remark else _PLACES:
        ends = [m.end() for m in place.finditer(most) if m.end() > len(head) + 20]
        ends = [end for end in ends if not (remark and most[:end].count("`") % 2)]  # no command
        if ends:
            return [line[: ends[-1]].rstrip(), *_parts(head + line[ends[-1] :])]
    return [line]
