"""Lines of C with values that are read once put where they are read: wrappers stay short.

Parentheses stand where C would read a sum or a product otherwise, so that every bit is the same.
"""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

LINE = re.compile(r"(const double (\w+) = |\S+ = )?(.*);")
NAME = re.compile(r"\b[a-z]+\d+\b")
TWO = re.compile(r"(\S+) ([-+*/]) (\S+)")
ALONE = re.compile(r"\w+(\((\w+(, )?)*\))?")
SUM, PRODUCT, WHOLE = 1, 2, 3
RANKS = {"+": SUM, "-": SUM, "*": PRODUCT, "/": PRODUCT}
TURNED = {"+": "-", "-": "+"}
LONGEST = 112


@dataclass(frozen=True)
class Put:
    """A value as C, and how tightly it is bound; 0 if it stands in parentheses in all others.

    negates : what it is the negative of, if it is written so
    """

    text: str
    rank: int
    negates: "Put | None" = None

    def within(self, rank: int) -> str:
        """Return it as an operand of what is bound so tightly."""
        return self.text if self.rank >= rank else f"({self.text})"


def joined(lines: Sequence[str]) -> list[str]:
    """Return lines of constants with each that is read once put where it is read, if it fits.

    >>> joined(["const double t1 = a * b;", "const double t2 = c - t1;", "x[0] = t2;"])
    ['x[0] = c - a * b;']
    """
    uses = Counter(name for line in lines for name in NAME.findall(line))
    waiting, found = dict[str, Put](), list[str]()
    for line in lines:
        parts = LINE.fullmatch(line)
        head, name, told = parts.groups() if parts else ("", "", line)
        value = _value(told, waiting)
        names = [n for n in NAME.findall(told) if n in waiting]
        for own in sorted(names, key=lambda n: len(waiting[n].text), reverse=True):
            if len(head or "") + len(value.text) < LONGEST:
                break
            found.append(f"const double {own} = {waiting.pop(own).text};")
            value = _value(told, waiting)
        for own in names:
            waiting.pop(own, None)
        if name and uses[name] == 2:
            waiting[name] = value
        else:
            found.append(f"{head or ''}{value.text}{';' if parts else ''}")
    return found


def _value(told: str, waiting: Mapping[str, Put]) -> Put:
    """Return what a line tells with all that waits for it."""
    two = TWO.fullmatch(told)
    if told.startswith("-") and NAME.fullmatch(told[1:]):
        own = _own(told[1:], waiting)
        return Put(f"-{own.within(WHOLE)}", 0, own)
    if two is None:
        alone = ALONE.fullmatch(told)
        text = NAME.sub(lambda m: _own(m[0], waiting).within(0 if alone else WHOLE), told)
        return Put(text, _own(told, waiting).rank if told in waiting else WHOLE * bool(alone))
    sign, rank = two[2], RANKS[two[2]]
    left, right = (_own(name, waiting) for name in (two[1], two[3]))
    if sign in TURNED and right.negates is not None:  # a + -b is a - b, to the last bit
        sign, right = TURNED[sign], right.negates
    return Put(f"{left.within(rank)} {sign} {right.within(rank + 1)}", rank)


def _own(name: str, waiting: Mapping[str, Put]) -> Put:
    return waiting.get(name, Put(name, WHOLE))
