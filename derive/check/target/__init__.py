"""What generated C does on its targets: built, run in an emulator, compared and measured.

In comes a scene's library, out goes a row a function: its bits are those of this machine or not,
and what it costs. The harness draws the same inputs everywhere; ``-icount`` lets each instruction
take the same time, so that a timer of the board counts instructions.
"""

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from derive.check.compiler import CompilerError, find_compiler
from derive.check.target.build import Bytes, built, built_here, laid_out
from derive.check.target.core import Core
from derive.check.target.harness import CALLS, all_of, count_of
from derive.check.target.run import Heard, RunError, counted, here, on_board
from derive.check.verdict import Outcome
from derive.emit.c.signature import CNames
from derive.emit.c.source import c_files
from derive.emit.on_target import Cost
from derive.library.library import Library
from derive.program.precision import PRECISIONS, Precision
from derive.program.program import Program


@dataclass(frozen=True)
class Tried:
    """What was found of one function on a core, or of all of a scene that could not be run.

    cost : None where it was not run        says : why it fails or is skipped
    """

    scene: str
    function: str
    core: str
    precision: str
    outcome: Outcome
    cost: Cost | None = None
    says: str = ""


def tried_on(library: Library, core: Core, sources: Mapping[str, str] | None = None) -> list[Tried]:
    """Return what a scene's functions do on a core, in the precisions that it computes in.

    sources : other C for the target than this machine gets, for tests of this check
    """
    return [
        row
        for precision in PRECISIONS
        for row in (
            _rows(library, precision, core, sources)
            if precision.name in core.precisions
            else [Tried(library.scene.name, "all", core.name, precision.name, "skipped",
                      says=core.without)]
        )
    ]  # fmt: skip


def _rows(
    library: Library, precision: Precision, core: Core, sources: Mapping[str, str] | None
) -> Iterator[Tried]:
    texts = c_files(library, ())
    with tempfile.TemporaryDirectory(prefix="derive-target-") as place:
        try:
            own = laid_out(library, precision, sources or texts, Path(place) / core.name)
            target = built(library, precision, core, own)
            this = laid_out(library, precision, texts, Path(place) / "here")
            want = here(built_here(library, precision, this, find_compiler()))
            bits = on_board(core, target.bits)
            costs = bits if target.cost == target.bits else on_board(core, target.cost)
        except (CompilerError, RunError) as error:
            yield _whole(library, core, precision, error)
            return
        yield from judged(library, core, precision, (want, bits, costs), target.sizes)


def _whole(
    library: Library, core: Core, precision: Precision, error: CompilerError | RunError
) -> Tried:
    """Return the row of a scene that was not run: a memory too small for it is no failure."""
    full = "overflowed by" in str(error)
    outcome: Outcome = "skipped" if full else "FAILS"
    says = f"too large for the memory of '{core.machine[1]}'" if full else str(error)
    return Tried(library.scene.name, "all", core.name, precision.name, outcome, says=says)


def judged(
    library: Library,
    core: Core,
    precision: Precision,
    said: tuple[list[Heard], list[Heard], list[Heard]],
    sizes: Mapping[str, Bytes],
) -> Iterator[Tried]:
    """Yield a row a function from what this machine and the target, for bits and cost, said."""
    every, names = all_of(library), CNames(library.scene.name)
    lengths = {len(every), *map(len, said)}
    if len(lengths) > 1:
        says = f"{len(every)} functions must be told of, but {sorted(lengths)} were"
        yield Tried(names.scene, "all", core.name, precision.name, "FAILS", says=says)
        return
    for program, want, bits, cost in zip(every, *said, strict=True):
        says = _wrong(program, want, bits)
        taken = sizes[names.symbol(program.name, precision)]
        found = Cost(
            *(core.name, core.title, precision.name, program.name),
            (counted(core, cost.least) + 1, counted(core, cost.most) + 1),
            *(taken.code, taken.tables, max(cost.stack, taken.stack), core.tools.version),
        )  # one more for the return, which the empty function has too
        outcome: Outcome = "FAILS" if says else "holds"
        yield Tried(names.scene, program.name, core.name, precision.name, outcome, found, says)


def _wrong(program: Program, want: Heard, bits: Heard) -> str:
    """Return what is wrong with what a target said of a function, "" if nothing."""
    compared = CALLS * count_of(program)
    if not compared or {want.values, bits.values} != {compared}:
        return f"{compared} values must be compared, but {want.values} and {bits.values} were"
    return (
        "" if want.bits == bits.bits else f"other bits than on this machine, of {compared} values"
    )
