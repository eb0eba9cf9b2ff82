"""Lines of C with values that are read once put where they are read: wrappers stay short."""

import re
from collections.abc import Sequence

MADE = re.compile(r"const double (\w+) = (.*);")
NAME = re.compile(r"\b[a-z]+\d+\b")
LONGEST = 112


def joined(lines: Sequence[str]) -> list[str]:
    """Return lines of constants with each that is read once put where it is read, if it fits."""
    uses: dict[str, int] = {}
    for line in lines:
        for name in NAME.findall(line):
            uses[name] = uses.get(name, 0) + 1
    waiting, found = dict[str, str](), list[str]()
    for line in lines:
        whole = NAME.sub(lambda m: waiting.get(m[0], m[0]), line)
        early = [n for n in NAME.findall(line) if n in waiting]
        if early and len(whole) > LONGEST:
            keep = max(early, key=lambda n: len(waiting[n]))
            found.append(f"const double {keep} = {waiting.pop(keep)[1:-1]};")
            whole = NAME.sub(lambda m: waiting.get(m[0], m[0]), line)
            for name in [n for n in early if n in waiting and len(whole) > LONGEST]:
                found.append(f"const double {name} = {waiting.pop(name)[1:-1]};")
                whole = NAME.sub(lambda m: waiting.get(m[0], m[0]), line)
        for name in NAME.findall(line):
            waiting.pop(name, None)
        made = MADE.fullmatch(whole)
        if made and uses[made[1]] == 2:
            waiting[made[1]] = f"({made[2]})"
        else:
            found.append(whole)
    return found
