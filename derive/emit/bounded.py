"""How many functions have a proved bound, and how far it is above what is seen: a table.

``python -m derive.emit.bounded [DIR]`` reads the JSON of all scenes below a folder.
"""

import json
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from derive.emit.files import manifests
from derive.program.program import Bound
from derive.verify.kept import stated_bounds

WANTED = 3.0
"""Of what is proved over what is seen, for nine functions of ten."""


@dataclass(frozen=True)
class BoundRow:
    """A function: the largest of its outputs' proved over seen, or why it has no proved bound."""

    scene: str
    function: str
    ratio: float | None
    why: str = ""


def rows(folder: Path) -> list[BoundRow]:
    """Return all functions of the scenes below a folder."""
    return [row for path in manifests(folder) for row in _of_scene(json.loads(path.read_text()))]


def _of_scene(manifest: Any) -> Iterator[BoundRow]:
    each: dict[str, list[Bound]] = {}
    for bound in stated_bounds(manifest):
        each.setdefault(bound.function, []).append(bound)
    for function, own in each.items():
        why = next((b.why for b in own if b.proved is None), "")
        ratio = None if why else max(map(_ratio, own))
        yield BoundRow(manifest["scene"], function, ratio, why)


def _ratio(bound: Bound) -> float:
    """Return proved over seen: one where both are nothing."""
    proved = bound.proved or 0.0
    if bound.seen:
        return proved / bound.seen
    return float("inf") if proved else 1.0


def told(each: Sequence[BoundRow]) -> list[str]:
    """Return what is said of functions: how many are proved, how closely, and why others not."""
    ratios = [row.ratio for row in each if row.ratio is not None]
    within = sum(ratio <= WANTED for ratio in ratios)
    lines = [f"{len(ratios)} of {len(each)} functions have a proved bound, in float and in double"]
    if len(ratios) > 1:
        low, middle, high = (sorted(ratios)[(len(ratios) - 1) * n // 4] for n in (1, 2, 3))
        lines.append(f"proved over seen: quartiles {low:.2g}, {middle:.2g}, {high:.2g}")
        lines.append(f"at most {WANTED:g} times what is seen: {within}")
    counts = Counter(row.why for row in each if row.why)
    return [*lines, *(f"{count} not: {why}" for why, count in counts.most_common())]


def main(arguments: Sequence[str]) -> None:
    """Print the table, a line a function, and what is said of all."""
    each = rows(Path(*arguments) if arguments else Path("generated"))
    for row in each:
        says = f"{row.ratio:.3g}" if row.ratio is not None else f"not proved: {row.why}"
        sys.stdout.write(f"{row.scene:36} {row.function:28} {says}\n")
    sys.stdout.writelines(f"{line}\n" for line in told(each))


if __name__ == "__main__":
    main(sys.argv[1:])
