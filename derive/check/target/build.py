"""A scene's C built for a core and for this machine, and the bytes that each function takes.

A function's bytes are those of the sections that it reaches in the scene's own object file: what
linking it alone brings. Routines of the C library and of the compiler are not among them.
"""

import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from derive.check.compiler import WARNINGS, Compiler, answer_of
from derive.check.target.core import FLAGS, HERE, Core
from derive.check.target.harness import calling
from derive.emit.c.signature import CNames
from derive.library.library import Library
from derive.program.arithmetic import LIBM, TURNS
from derive.program.precision import Precision

BOARD = (*("-std=gnu99", "-O2", "-ffp-contract=off", "-fno-builtin"), f"-I{HERE}", "-I.")
ASKED = LIBM | TURNS
"""What asks the C library, which is not the same everywhere: always, or for large angles."""
_SECTION = re.compile(r"^ *\d+ (\.\S+) +([0-9a-f]{8}) ")
_SYMBOL = re.compile(r"^[0-9a-f]{8} .{7} (\.\S+)\t[0-9a-f]{8} (?:\.hidden )?(\S+)$")
_RELOCATED = re.compile(r"^RELOCATION RECORDS FOR \[(\S+)\]:$")
_TO = re.compile(r"^[0-9a-f]{8} R_\S+ +([^+\s]+)")


@dataclass(frozen=True)
class Bytes:
    """What a function takes: of code, of tables, and of stack by its own frame."""

    code: int
    tables: int
    stack: int


@dataclass(frozen=True)
class Built:
    """Programs that call a scene's functions; each folder holds what made it.

    bits  : with sines of the harness's own where the scene calls the library's
    cost  : with the library's
    sizes : bytes by symbol
    """

    bits: Path
    cost: Path
    sizes: Mapping[str, Bytes]


def calls_libm(library: Library) -> bool:
    """Tell whether a function of a scene has a call of what C libraries round differently."""
    return any(ASKED & set(p.count) for p in library.printed())


def laid_out(
    library: Library, precision: Precision, sources: Mapping[str, str], folder: Path
) -> Path:
    """Write a scene's C and what calls it to a folder, and return it."""
    folder.mkdir(parents=True)
    for name, text in {**sources, **calling(library, precision)}.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def built(library: Library, precision: Precision, core: Core, folder: Path) -> Built:
    """Return programs for a core. Raises CompilerError with the compiler's complaint."""
    source = CNames(library.scene.name).file(precision, "c")
    command = (core.tools.compiler, *core.flags, *core.tools.library)
    answer_of((*command, *FLAGS, *WARNINGS, "-fstack-usage", "-c", source, "-o", "scene.o"), folder)
    units = (str(HERE / "harness.c"), "scene.o")
    cost = linked(core, units, folder, "cost.elf")
    sizes = _sizes(core, folder)
    own = calls_libm(library)
    bits = linked(core, ("-DOWN_SINE", *units), folder, "bits.elf") if own else cost
    return Built(bits, cost, sizes)


def linked(core: Core, units: Sequence[str], folder: Path, name: str) -> Path:
    """Return a program of some units for a core's board, with what starts it."""
    command = (core.tools.compiler, *core.flags, *core.tools.library, *BOARD, "-DON_TARGET")
    place = ("-nostartfiles", f"-L{HERE}", f"-T{core.memory}", str(HERE / core.start))
    end = ("-Wl,--no-warn-rwx-segments", "-Wl,--gc-sections", "-lm")
    answer_of((*command, *place, *units, "-o", name, *end), folder)
    return folder / name


def linked_here(units: Sequence[str], folder: Path, with_: Compiler) -> Path:
    """Return a program of the same units for this machine."""
    answer_of((*with_.command, *BOARD, str(HERE / "host.c"), *units, "-o", "here", "-lm"), folder)
    return folder / "here"


def built_here(library: Library, precision: Precision, folder: Path, with_: Compiler) -> Path:
    """Return the program of this machine that says the same bits."""
    source = CNames(library.scene.name).file(precision, "c")
    answer_of((*with_.command, "-std=c99", "-O2", "-c", source, "-o", "scene.o"), folder)
    own = ("-DOWN_SINE",) if calls_libm(library) else ()
    return linked_here((*own, str(HERE / "harness.c"), "scene.o"), folder, with_)


def _sizes(core: Core, folder: Path) -> dict[str, Bytes]:
    objdump = shutil.which(f"{core.tools.prefix}objdump") or "objdump"
    lines = answer_of((objdump, "-h", "-t", "-r", "scene.o"), folder).splitlines()
    sections = {m[1]: int(m[2], 16) for line in lines if (m := _SECTION.match(line))}
    homes = {m[2]: m[1] for line in lines if (m := _SYMBOL.match(line))}
    reached: dict[str, set[str]] = {}
    at = ""
    for line in lines:
        if m := _RELOCATED.match(line):
            at = m[1]
        elif m := _TO.match(line):
            reached.setdefault(at, set()).add(homes.get(m[1], m[1]))
    own = _stacks(folder / "scene.su")
    return {
        symbol: Bytes(*_taken(_closure(home, reached), sections), own[symbol])
        for symbol, home in homes.items()
        if home in (f".text.{symbol}", f".text.unlikely.{symbol}") and symbol in own
    }


def _closure(start: str, reached: Mapping[str, set[str]]) -> set[str]:
    found, ahead = {start}, [start]
    while ahead:
        new = reached.get(ahead.pop(), set()) - found
        found |= new
        ahead += sorted(new)
    return found


def _taken(names: set[str], sections: Mapping[str, int]) -> tuple[int, int]:
    code = sum(sections[n] for n in names if n.startswith(".text") and n in sections)
    data = (".rodata", ".srodata", ".data", ".sdata")
    return code, sum(sections[n] for n in names if n.startswith(data) and n in sections)


def _stacks(file: Path) -> dict[str, int]:
    """Return the stack that each function's own frame takes."""
    rows: Sequence[list[str]] = [r.split("\t") for r in file.read_text().splitlines()]
    return {row[0].rpartition(":")[2]: int(row[1]) for row in rows}
