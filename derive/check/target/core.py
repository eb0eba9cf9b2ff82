"""Cores that generated C is built for, the boards that they are emulated on, and their tools."""

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from derive.scene.declaration import DeriveError

HERE = Path(__file__).parent
FLAGS = ("-std=c99", "-O2", "-ffunction-sections", "-fdata-sections")
"""Flags for a scene's C; what keeps its bits stands in the C itself."""
NANOSECONDS = 128
"""Of the emulator's time an instruction takes so many: ``-icount shift=7``."""


class ToolError(DeriveError, RuntimeError):
    """A compiler or an emulator that is not here; the sentence names its packages."""


@dataclass(frozen=True)
class Toolchain:
    """A cross compiler and an emulator, and the packages of Debian that they are in."""

    prefix: str
    emulator: str
    packages: tuple[str, ...]
    library: tuple[str, ...] = ()

    @property
    def compiler(self) -> str:
        """Return the command of the C compiler."""
        return f"{self.prefix}gcc"

    @cached_property
    def version(self) -> str:
        """Return the compiler and its version."""
        command = (self.compiler, "-dumpfullversion")
        told = subprocess.run(command, capture_output=True, text=True, check=True)
        return f"{self.compiler} {told.stdout.strip()}"


ARM = Toolchain(
    "arm-none-eabi-",
    "qemu-system-arm",
    ("qemu-system-arm", "gcc-arm-none-eabi", "libnewlib-arm-none-eabi"),
)
RISCV = Toolchain(
    "riscv64-unknown-elf-",
    "qemu-system-riscv32",
    ("qemu-system-misc", "gcc-riscv64-unknown-elf", "picolibc-riscv64-unknown-elf"),
    ("--specs=picolibc.specs",),
)


@dataclass(frozen=True)
class Core:
    """A core, what its code is compiled for and the board that it is emulated on.

    memory     : the script by which programs are linked
    ticks      : of the board's counter, so many an instruction
    precisions : that it computes in as IEEE 754 says
    without    : the others, and why
    """

    name: str
    title: str
    tools: Toolchain
    flags: tuple[str, ...]
    machine: tuple[str, ...]
    start: str
    memory: str
    ticks: float
    precisions: tuple[str, ...] = ("f32", "f64")
    without: str = ""

    def missing(self) -> list[str]:
        """Return the commands that are not here."""
        return [c for c in (self.tools.compiler, self.tools.emulator) if shutil.which(c) is None]


_MPS2, _NRF51 = 25e-3 * NANOSECONDS, 16e-3 * NANOSECONDS  # ticks of 25 and of 16 MHz
_LIBGCC = "libgcc adds doubles on this core with an error beyond rounding"


def _cortex(name: str, title: str, cpu: str, board: str, *how: str, without: str = "") -> Core:
    flags = (f"-mcpu=cortex-{cpu}", "-mthumb", *how)
    small = board == "microbit"
    return Core(
        name,
        f"Cortex-{title}",
        ARM,
        (*flags, "-DMICROBIT") if small else flags,
        ("-M", board),
        "cortex.c",
        f"{'microbit' if small else 'mps2'}.ld",
        _NRF51 if small else _MPS2,
        ("f32",) if without else ("f32", "f64"),
        without,
    )


def _riscv(name: str, abi: str) -> Core:
    flags = (f"-march={name}", f"-mabi={abi}", "-mcmodel=medany")
    machine = ("-M", "virt", "-bios", "none")
    return Core(name, name.upper(), RISCV, flags, machine, "riscv.c", "virt.ld", NANOSECONDS)


CORES: Mapping[str, Core] = {
    core.name: core
    for core in (
        _cortex("m0plus", "M0+", "m0plus", "microbit", "-mfloat-abi=soft"),
        _cortex("m3", "M3", "m3", "mps2-an385", "-mfloat-abi=soft", without=_LIBGCC),
        _cortex(
            *("m4f", "M4F", "m4", "mps2-an386", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"),
            without=_LIBGCC,
        ),
        _cortex("m7", "M7", "m7", "mps2-an500", "-mfloat-abi=hard", "-mfpu=fpv5-d16"),
        _riscv("rv32imac", "ilp32"),
        _riscv("rv32imf", "ilp32f"),
    )
}
ALL = "all"


def require_tools(cores: Sequence[Core]) -> None:
    """Raise ToolError unless the compilers and emulators of all cores are here."""
    missing = dict.fromkeys(command for core in cores for command in core.missing())
    if missing:
        packages = dict.fromkeys(p for core in cores if core.missing() for p in core.tools.packages)
        raise ToolError(
            f"target: {' and '.join(missing)} must be on the PATH, but "
            f"{'is' if len(missing) == 1 else 'are'} not: `apt-get install {' '.join(packages)}` "
            "(Debian) brings all that is asked for"
        )
