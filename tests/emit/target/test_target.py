"""The emitted C on its targets: no warnings, no double in float builds, the same bits.

Needs gcc, clang, arm-none-eabi-gcc and qemu-system-arm; .ci/run installs them and runs this.
"""

import json
import re
import subprocess
from pathlib import Path

import pytest

from derive.emit.files import manifests

pytestmark = pytest.mark.target

HERE = Path(__file__).parent
GENERATED = HERE.parents[2] / "generated"
MANIFESTS = manifests(GENERATED)
WARNINGS = (
    *("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion"),
    *("-Wshadow", "-Wstrict-prototypes", "-Wfloat-equal", "-Werror"),
)
ARM = "arm-none-eabi-gcc"
THUMB = ("-mthumb", "-ffunction-sections", "-fdata-sections")
CORES = {
    "M0+": ("-mcpu=cortex-m0plus", "-mfloat-abi=soft", *THUMB),
    "M4F": ("-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", *THUMB),
    "M7": ("-mcpu=cortex-m7", "-mfloat-abi=hard", "-mfpu=fpv5-d16", *THUMB),
}
COMPILERS = {"gcc": ("gcc",), "clang": ("clang",)} | {
    core: (ARM, *flags) for core, flags in CORES.items()
}
BOARDS = {"f32": ("M4F", "mps2-an386"), "f64": ("M7", "mps2-an500")}
SEMIHOSTING = ("-nographic", "-monitor", "none", "-serial", "none")
SAY = '#include <stdio.h>\nvoid say(const char *t);\nvoid say(const char *t) { printf("%s", t); }\n'
DOUBLE_CALL = re.compile(r"__aeabi_(?:d\w+|f2d|i2d|l2d|ui2d|ul2d)|\b(?:sin|cos|sqrt|pow|fabs|fma)$")
DOUBLE_X86 = re.compile(r"\b(?:v?(?:add|sub|mul|div|sqrt)[sp]d|v?cvts[si]2sd|v?cvtps2pd)\b")

scenes = pytest.mark.parametrize("manifest", MANIFESTS, ids=lambda p: p.stem)
precisions = pytest.mark.parametrize("precision", ["f32", "f64"])


def run(*command: str) -> str:
    """Return what a command prints; fail with its complaint."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}{done.stderr}"
    assert done.stderr == "", done.stderr
    return done.stdout


def source(manifest: Path, precision: str) -> str:
    """Return the path of a scene's C file."""
    files = json.loads(manifest.read_text(encoding="utf-8"))["files"]
    return str(manifest.parent / files[precision]["source"])


def test_there_are_scenes_to_compile() -> None:
    assert len(MANIFESTS) >= 7


@scenes
@precisions
@pytest.mark.parametrize("compiler", COMPILERS)
def test_it_compiles_without_a_warning(compiler, precision, manifest, tmp_path) -> None:
    out = str(tmp_path / "scene.o")
    told = run(*COMPILERS[compiler], "-O2", *WARNINGS, "-c", source(manifest, precision), "-o", out)
    assert told == ""


@scenes
@pytest.mark.parametrize("core", CORES)
def test_a_float_build_calls_no_double_routine(core, manifest, tmp_path) -> None:
    out = str(tmp_path / "scene.o")
    run(ARM, *CORES[core], "-O2", "-std=c99", "-c", source(manifest, "f32"), "-o", out)
    assert doubles(run("arm-none-eabi-nm", "-u", out)) == []
    assert ".f64" not in run("arm-none-eabi-objdump", "-d", out)


@scenes
def test_a_float_build_for_the_host_has_no_double_instruction(manifest, tmp_path) -> None:
    out = str(tmp_path / "scene.o")
    run("gcc", "-O2", "-std=c99", "-c", source(manifest, "f32"), "-o", out)
    assert DOUBLE_X86.findall(run("objdump", "-d", out)) == []


def test_a_double_routine_in_a_float_build_is_noticed(tmp_path) -> None:
    text = "float f(float a); float f(float a) { return a * 1.1; }\n"
    (tmp_path / "slip.c").write_text(text)
    out, slip = str(tmp_path / "slip.o"), str(tmp_path / "slip.c")
    run(ARM, *CORES["M4F"], "-O2", "-c", slip, "-o", out)
    assert doubles(run("arm-none-eabi-nm", "-u", out)) == [
        "__aeabi_d2f",
        "__aeabi_dmul",
        "__aeabi_f2d",
    ]
    run("gcc", "-O2", "-c", slip, "-o", out)
    assert DOUBLE_X86.findall(run("objdump", "-d", out)) != []


def doubles(undefined: str) -> list[str]:
    """Return the routines for doubles among the undefined names of an object file."""
    names = [line.split()[-1] for line in undefined.splitlines() if line.strip()]
    return sorted(name for name in names if DOUBLE_CALL.search(name))


@scenes
@precisions
def test_the_target_gives_the_bits_of_the_host(precision, manifest, tmp_path) -> None:
    whole = json.loads(manifest.read_text(encoding="utf-8"))
    if any({"sin", "cos"} & set(f.get("cost", {})) for f in whole["functions"]):
        pytest.skip("sin and cos are the C library's, and libraries differ")
    write_calls(whole, precision, tmp_path)
    units = [str(HERE / "bits.c"), source(manifest, precision)]
    flags = ("-O2", "-std=c99", "-ffp-contract=off", f"-I{tmp_path}", f"-I{manifest.parent}")
    assert on_target(precision, units, flags, tmp_path) == on_host(units, flags, tmp_path)


def on_host(units: list[str], flags: tuple[str, ...], folder: Path) -> str:
    """Return what the program says on this machine."""
    (folder / "say.c").write_text(SAY)
    program = str(folder / "host")
    run("gcc", *flags, *units, str(folder / "say.c"), "-o", program, "-lm")
    return run(program)


def on_target(precision: str, units: list[str], flags: tuple[str, ...], folder: Path) -> str:
    """Return what the program says on an emulated board."""
    core, board = BOARDS[precision]
    program = str(folder / "target.elf")
    start = ("-nostartfiles", f"-T{HERE / 'target.ld'}", str(HERE / "startup.c"))
    link = ("-Wl,--no-warn-rwx-segments", "-Wl,--gc-sections", "-lm", "-lc", "-lgcc")
    run(ARM, *CORES[core], *flags, *start, *units, "-o", program, *link)
    host = ("-semihosting-config", "enable=on,target=native")
    done = subprocess.run(
        ("qemu-system-arm", "-M", board, *SEMIHOSTING, *host, "-kernel", program),
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    return done.stdout + done.stderr


def write_calls(whole: dict, precision: str, folder: Path) -> None:
    """Write calls.h and calls.c: every function of a scene, on numbers from its ranges."""
    scalar = {"f32": "float", "f64": "double"}[precision]
    header = whole["files"][precision]["header"]
    text = f'#include "{header}"\ntypedef {scalar} scalar;\nstatic void calls(void);\n'
    (folder / "calls.h").write_text(text)
    functions = [f for f in whole["functions"] if f["symbols"][precision]]
    bodies = "".join(f"    {{\n{call(f, precision)}    }}\n" for f in functions)
    struct = f"{whole['scene']}_constants_{precision}"
    held = f"    static {struct} ready;\n" if whole["constants"] else ""
    (folder / "calls.c").write_text(f"static void calls(void)\n{{\n{held}{bodies}}}\n")


def call(function: dict, precision: str) -> str:
    """Return C lines that draw a function's inputs, call it and take its outputs."""
    lines, passed, taken = [], [], []
    for argument in function["arguments"]:
        name, size = argument["name"], max(len(argument["components"]), *argument["shape"], 1)
        if argument["type"] == "struct":
            passed.append("&ready")
            taken += ["take(&ready, sizeof ready);"] if argument["direction"] == "out" else []
        elif argument["direction"] == "out":
            lines.append(f"scalar {name}[{size}];")
            passed.append(name)
            taken.append(f"take({name}, sizeof {name});")
        else:
            low, high = argument["range"] or (-1, 1)
            pair = f"{{(scalar){low!r}, (scalar){high!r}}}"
            ranges = ", ".join([pair] * size)
            lines.append(f"scalar {name}[{size}];")
            lines.append(f"static const scalar {name}_range[{size}][2] = {{{ranges}}};")
            lines.append(f"draw({name}, {name}_range, {size});")
            passed.append(name if argument["type"] == "array" else f"{name}[0]")
    invoked = f"{function['symbols'][precision]}({', '.join(passed)});"
    return "".join(f"        {line}\n" for line in [*lines, invoked, *taken])
