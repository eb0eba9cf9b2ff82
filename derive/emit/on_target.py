"""What functions cost on the cores that they were run on, while the figures are of the present C.

``derive check --target CORE --keep`` stores them beside a scene's files, with a digest of the C
text that they are of; what is generated states them as long as its own text has that digest.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

ENDING = "_target.json"
"""How the file of a scene is called in which they lie."""
OPTIMISED = "-O2"


@dataclass(frozen=True)
class Cost:
    """What one function costs on a core, as it was measured.

    core         : by name, and ``title`` as its makers call it
    instructions : of a call, the least and the most of all that were made
    code, tables : bytes that linking the function brings, without routines of libraries
    stack        : bytes below the caller's own
    compiler     : that made the code
    """

    core: str
    title: str
    precision: str
    function: str
    instructions: tuple[int, int]
    code: int
    tables: int
    stack: int
    compiler: str = ""

    @property
    def figures(self) -> tuple[str, str, str, str]:
        """Return instructions, code, tables and stack as a table has them."""
        least, most = self.instructions
        count = f"{least}" if least == most else f"{least} to {most}"
        return count, str(self.code), str(self.tables), str(self.stack)

    @property
    def says(self) -> str:
        """Return the figures in words."""
        count, code, tables, stack = self.figures
        more = f", {tables} B of tables" if self.tables else ""
        return f"{count} instructions, {code} B of code{more}, {stack} B of stack"


@dataclass(frozen=True)
class OnTarget:
    """The figures of a scene that are of its present C, and the cores whose figures are not."""

    each: tuple[Cost, ...] = ()
    stale: tuple[str, ...] = ()

    def of(self, function: str, precision: str = "") -> tuple[Cost, ...]:
        """Return the figures of one function, in one precision or in both."""
        return tuple(
            c for c in self.each if c.function == function and precision in ("", c.precision)
        )


UNKNOWN = OnTarget()


def digest_of_source(text: str) -> str:
    """Return a digest of a C file but for how it was made, and for macros that it puts aside."""
    lines = text.partition("*/")[2].splitlines(keepends=True)
    kept = "".join(line for line in lines if not line.startswith("#undef "))
    return sha256(kept.encode()).hexdigest()[:16]


def path_of(folder: Path, scene: str) -> Path:
    """Return where the figures of a scene lie below a folder."""
    return folder / scene / f"{scene}{ENDING}"


def kept(folder: Path, scene: str, sources: Mapping[str, str]) -> OnTarget:
    """Return what is kept of a scene below ``folder``; ``sources`` is its C by precision."""
    return of_text(_read(path_of(folder, scene)), sources)


def lies(folder: Path, scene: str) -> bool:
    """Tell whether figures of a scene lie below a folder, of whatever C."""
    return path_of(folder, scene).is_file()


def of_text(text: str, sources: Mapping[str, str]) -> OnTarget:
    """Return the figures that a file's text holds of the C in ``sources``."""
    digests = {precision: digest_of_source(source) for precision, source in sources.items()}
    try:
        targets = json.loads(text)["targets"]
        every = [(_costs(core, p, each[p]), each[p]["c"] == digests[p], core)
                 for core, each in targets.items() for p in sources if p in each]  # fmt: skip
    except (ValueError, LookupError, TypeError, AttributeError):
        return UNKNOWN
    fresh = tuple(cost for costs, own, _ in every for cost in costs if own)
    return OnTarget(fresh, tuple(dict.fromkeys(core for _, own, core in every if not own)))


def _costs(core: str, precision: str, said: Mapping[str, Any]) -> list[Cost]:
    found = []
    for name, row in said["functions"].items():
        least, most = map(int, row["instructions"])
        code, tables, stack = (int(row[key]) for key in ("code", "tables", "stack"))
        title, made_by = str(said["title"]), str(said["compiler"])
        cost = Cost(core, title, precision, str(name), (least, most), code, tables, stack, made_by)
        found.append(cost)
    return found


def to_text(scene: str, costs: Iterable[Cost], sources: Mapping[str, str]) -> str:
    """Return the text of a file that holds figures of the C in ``sources``."""
    targets: dict[str, dict[str, Any]] = {}
    for cost in costs:
        own = targets.setdefault(cost.core, {}).setdefault(
            cost.precision,
            {
                "title": cost.title,
                "compiler": cost.compiler,
                "flags": OPTIMISED,
                "c": digest_of_source(sources[cost.precision]),
                "functions": {},
            },
        )
        own["functions"][cost.function] = described(cost)
    return json.dumps({"scene": scene, "targets": targets}, indent=1) + "\n"


def described(cost: Cost) -> dict[str, Any]:
    """Return the figures of one function on a core, for JSON."""
    return {
        "instructions": list(cost.instructions),
        "code": cost.code,
        "tables": cost.tables,
        "stack": cost.stack,
    }


def by_core(costs: Sequence[Cost]) -> dict[str, dict[str, Any]]:
    """Return figures by core and precision, for JSON."""
    found: dict[str, dict[str, Any]] = {}
    for cost in costs:
        found.setdefault(cost.core, {})[cost.precision] = described(cost)
    return found


def _read(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""
