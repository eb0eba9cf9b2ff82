"""What a report was measured on: processor, system and compiler; no name of a person or host."""

import platform
import subprocess
from dataclasses import dataclass
from pathlib import Path

from derive.check.compiler import CompilerError, find_compiler

NO_COMPILER = "no compiler"


@dataclass(frozen=True)
class Machine:
    """What a report was measured on."""

    processor: str
    system: str
    compiler: str


def machine_here() -> Machine:
    """Return what this machine is."""
    return Machine(_processor(), f"{platform.system()} {platform.machine()}", _compiler())


def _processor() -> str:
    """Return the name of the processor, as far as it is told."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    named = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(named, "") or platform.processor() or platform.machine()


def _compiler() -> str:
    """Return the first line that the compiler says of itself, or that there is none."""
    try:
        with_ = find_compiler()
        said = subprocess.run((*with_.command, "--version"), capture_output=True, text=True,
                              check=False).stdout  # fmt: skip
    except (CompilerError, OSError):
        return NO_COMPILER
    return next(iter(said.splitlines()), with_.name)
