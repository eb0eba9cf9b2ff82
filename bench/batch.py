"""``python -m bench.batch``: functions over members beside a loop over the scene's own, in one run.

Both are compiled alike, in one process, turn and turn about, in blocks of some microseconds; the
shortest block counts, which nobody else's work has lengthened. What a core can do is measured in
the same process: products and sums, quotients and roots on numbers in its first cache, and how fast
it copies as much memory as the function reads and writes.
"""

import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import jinja2
import numpy as np

from bench.build import run
from derive.check.compiler import find_compiler
from derive.emit.c.members import IN_COMMON
from derive.emit.c.members_file import VECTOR_OPTIONS, members_files
from derive.emit.c.source import c_files
from derive.library.library import Library, library
from derive.program.precision import F32, F64, Precision
from derive.program.program import Program
from derive.scene import load
from derive.verify.draw import Dice, Sampled, complete, drawn

ROWS = (
    ("satellite", "step_rk4", 6.0, 10.0),
    ("rigid_body", "state_rate", 2.4, 4.5),
    ("tumbling_body", "flow_exact", 0.0, 0.0),
    ("heavy_top", "state_rate", 4.0, 8.0),
    ("cart_pendulum", "state_rate", 4.0, 8.0),
    ("quadrotor", "state_rate", 2.4, 4.5),
)
"""Scene, function, and how many times faster 1000 members are to be, in double and in float.

Rates with sines, of `heavy_top` and `cart_pendulum`, more than those without.
"""
REPEATED = 4
LIMITS = {
    "summed": "y = y * BENCH_FACTOR + BENCH_TERM; " * REPEATED,
    "divided": "y = BENCH_TERM / y; " * REPEATED,
    "rooted": "y = BENCH_ROOT(y); " * REPEATED,
}
"""What a core is tried by: a product and a sum, a quotient, a root, each several times a number."""
NUMBERS = {"BENCH_FACTOR": "0.999", "BENCH_TERM": "0.003"}
MEMBERS = (1000, 1_000_000)
CALLS = 4e6
BLOCK = 2_000_000  # operations between two looks at the clock: less than a millisecond
TIME_STEP = 1e-3  # s


@dataclass(frozen=True)
class Pace:
    """What one function takes a member, in ns: alone, over members, and as the core allows."""

    function: str
    precision: str
    members: int
    single: float
    over: float
    arithmetic: float
    memory: float

    @property
    def gain(self) -> float:
        """Return how many times faster members are together."""
        return self.single / self.over

    @property
    def of_limit(self) -> float:
        """Return which part of what the core allows is reached."""
        return max(self.arithmetic, self.memory) / self.over


def pace(
    made: Library,
    function: str,
    precision: Precision,
    members: int,
    folder: Path,
    calls: float = CALLS,
) -> Pace:
    """Return what a function takes, measured. Raises BuildError if a bit differs."""
    program = made[function]
    made = alone(made, program)
    texts = c_files(made, ()) | members_files(made, ())
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "drive.c").write_text(_driver(made, program, precision), encoding="utf-8")
    sources = (f"{made.scene.name}_{over}{precision.name}.c" for over in ("", "batch_"))
    root = "__builtin_sqrtf" if precision is F32 else "__builtin_sqrt"
    numbers = (f"-D{n}={x}{precision.suffix}" for n, x in NUMBERS.items())
    where = (f"-I{folder}", f"-DBENCH_ROOT={root}", *numbers, "-ffp-contract=off", "-w")
    program_file = str(folder / "drive")
    run((*find_compiler().command, *VECTOR_OPTIONS, *where, str(folder / "drive.c"),
         *(str(folder / source) for source in sources), "-o", program_file, "-lm"))  # fmt: skip
    given = _supplied(made, program, precision, members)
    said = run((program_file, str(members), str(calls)), given).split()
    single, over, byte, *limits = map(float, said)
    summed, divided, rooted = (ns / REPEATED for ns in limits)
    count = program.count
    plain = count.get("add", 0) + count.get("sub", 0) + count.get("mul", 0)
    arithmetic = plain / 2 * summed + count.get("div", 0) * divided
    arithmetic += count.get("sqrt", 0) * rooted + _sines(program, precision) / 2 * summed
    memory = byte * _numbers(program) * np.dtype(precision.dtype).itemsize
    name = f"{made.scene.name} {function}"
    return Pace(name, precision.scalar, members, single, over, arithmetic, memory)


def alone(made: Library, program: Program) -> Library:
    """Return a library of one function: what else there is would only be compiled with it."""
    own = (tuple(p for p in each if p is program) for each in (made.functions, made.motions))
    functions, motions = own
    return replace(made, functions=functions, motions=motions)


def _sines(program: Program, precision: Precision) -> int:
    """Return the operations of our own sines: both of an angle are made together."""
    pairs = max(program.count.get("sin", 0), program.count.get("cos", 0))
    return pairs * (45 if precision is F32 else 52)


def _members(program: Program) -> list[Any]:
    return [q for q in program.inputs if q.role != "constants" and q.name not in IN_COMMON]


def _numbers(program: Program) -> int:
    """Return how many numbers of a member are read and written."""
    return len([c for q in (*_members(program), *program.outputs) for c in q.components])


def _driver(made: Library, program: Program, precision: Precision) -> str:
    one, every = [], ["(ptrdiff_t)(end - start)", "(ptrdiff_t)n"]
    for q in program.inputs:
        if q.role == "constants":
            one.append("&constants")
            every.append("&constants")
        elif q.name in IN_COMMON:
            one.append(q.name)
            every.append(q.name)
        else:
            at = f"{q.name}_one + {len(q.components)} * k" if q.shape else f"{q.name}_one[k]"
            one.append(at)
            every.append(f"{q.name} + start")
    for q in program.outputs:
        one.append(f"{q.name}_one + {len(q.components)} * k")
        every.append(f"{q.name} + start")
    at = _drawn(made, precision, 1)
    template = jinja2.Environment(autoescape=False, trim_blocks=True).from_string(  # noqa: S701
        (Path(__file__).parent / "batch_driver.c.jinja").read_text(encoding="utf-8")
    )
    return template.render(
        scene=made.scene.name,
        function=program.name,
        p=precision.name,
        real=precision.scalar,
        limits=LIMITS,
        block=BLOCK // max(100, len(program.ops)),
        time_step=TIME_STEP,
        given=[{"name": q.name, "size": len(q.components)} for q in _members(program)],
        found=[{"name": q.name, "size": len(q.components)} for q in program.outputs],
        constants=any(q.role == "constants" for q in program.inputs),
        parameters=[repr(float(at[c][0])) for q in made.setup.inputs for c in q.components],
        one=", ".join(one),
        all=", ".join(every),
        traffic=min(8, max(2, _numbers(program))),
    )


def _drawn(made: Library, precision: Precision, members: int) -> Any:
    of = Sampled(made, precision)
    return complete(of, drawn(of, Dice("batch"), members)).own


def _supplied(made: Library, program: Program, precision: Precision, members: int) -> bytes:
    """Return the inputs of members, of each quantity as structures of arrays, then one by one."""
    few = min(members, 4096)
    at = _drawn(made, precision, few)
    texts = []
    for q in _members(program):
        table: Any = np.array([np.resize(at[c], members) for c in q.components], precision.dtype)
        texts += [table.tobytes(), np.ascontiguousarray(table.T).tobytes()]
    return b"".join(texts)


def main(words: Sequence[str]) -> int:
    """Print the table, in the form that a page has; return whether a target is missed."""
    missed = 0
    command = " ".join(find_compiler().command)
    version = subprocess.run(
        (*find_compiler().command, "--version"), capture_output=True, text=True, check=True
    ).stdout.splitlines()[0]
    print(f"{command}: {version}; {' '.join(VECTOR_OPTIONS)}\n")
    print("| function | type | members | alone | over members | gain | target | of limit |")
    print("|---|---|---|---|---|---|---|---|")
    for scene, function, *targets in ROWS:
        if words and scene not in words:
            continue
        made = library(load(scene))
        for precision, target in zip((F64, F32), targets, strict=True):
            for members in MEMBERS:
                with TemporaryDirectory() as folder:
                    own = pace(made, function, precision, members, Path(folder))
                asked = f"{target:g}" if target and members == MEMBERS[0] else ""
                missed += bool(asked) and own.gain < target
                limit = "memory" if own.memory > own.arithmetic else "arithmetic"
                print(f"| `{scene}` {function} | {precision.scalar} | {members} |"
                      f" {own.single:.1f} | {own.over:.2f} | {own.gain:.1f} | {asked} |"
                      f" {own.of_limit:.0%} {limit} |", flush=True)  # fmt: skip
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
