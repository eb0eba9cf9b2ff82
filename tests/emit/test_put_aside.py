"""Names of capitals are put aside in headers: a board's macros of these names do no harm there."""

import re
import shutil
import subprocess
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pytest

from derive.check.compiler import WARNINGS
from derive.emit.c.aside import is_put_aside
from derive.emit.c.members_file import members_files
from derive.emit.c.source import c_files
from derive.emit.package.single import single_header, single_name
from derive.library.library import library
from derive.program.precision import F32
from derive.scene import parse_scene
from derive.scene.reserved import owner
from tests.scene.test_words import NAME, machine

ROLES = {"parameter": "SP", "input": "C", "coordinate": "PB0", "result": "TIM1", "unknown": "AD_x"}
"""Macros of avr/io.h, of the MSP430's and of a Cortex's headers."""
MACROS = (*ROLES.values(), "I")
BOARD = "".join(f"#define {name} (*(volatile unsigned char *)0x{n}U)\n" for n, name in
                enumerate(MACROS, 20))  # fmt: skip
STILL = "".join(f"(void)&{name}; " for name in MACROS)
"""What a file says that needs the board's macros after our header."""
LANGUAGES = {"c": ("gcc", "-std=c99"), "cpp": ("g++", "-std=c++98")}
AVR = ("atmega328p", "atmega2560", "atmega32u4", "atmega1284p", "attiny85", "atxmega128a1")


@cache
def files() -> dict[str, str]:
    """Return all C of a scene whose names are macros of boards."""
    made = library(parse_scene(machine(**ROLES), "odd"))
    plain, many = c_files(made, ()), members_files(made, ())
    single = single_header("odd", F32, plain["odd_f32.h"], plain["odd_f32.c"])
    return plain | many | {single_name("odd", F32): single}


def complaint(texts: dict[str, str], file: str, folder: Path, *options: str) -> str:
    """Return what a compiler says of one of some files."""
    for name, text in texts.items():
        (folder / name).write_text(text)
    command, *first = LANGUAGES[file.rpartition(".")[2]]
    if shutil.which(command) is None:
        pytest.skip(f"{command} is not here")
    own = WARNINGS if command == "gcc" else ("-Wall", "-Wextra", "-Werror")
    whole = (command, *first, *own, "-fsyntax-only", *options, file)
    return subprocess.run(whole, cwd=folder, capture_output=True, text=True).stderr


@pytest.mark.parametrize("header", ["odd_f64.h", "odd_batch_f32.h", "odd_f32_single.h"])
@pytest.mark.parametrize("ending", LANGUAGES)
def test_a_header_stands_after_a_board_s_and_leaves_its_macros(
    header: str, ending: str, tmp_path: Path
) -> None:
    texts = files()
    own = f"void f(void);\nvoid f(void) {{ {STILL}}}\n"
    texts[f"use.{ending}"] = f'{BOARD}#include "{header}"\n{own}'
    assert complaint(texts, f"use.{ending}", tmp_path) == ""
    kept = re.sub(r"^#(undef|pragma push_macro).*\n", "", texts[header], flags=re.MULTILINE)
    assert complaint(texts | {header: kept}, f"use.{ending}", tmp_path) != ""


@pytest.mark.parametrize("source", ["odd_f32.c", "odd_f64.c", "odd_batch_f64.c"])
def test_a_source_stands_after_macros_that_a_project_has_for_all_its_files(
    source: str, tmp_path: Path
) -> None:
    texts = files() | {"board.h": BOARD}
    assert complaint(texts, source, tmp_path, "-include", "board.h") == ""


def test_the_functions_of_a_single_header_are_made_after_a_board_s(tmp_path: Path) -> None:
    texts = files()
    texts["use.c"] = f'{BOARD}#define ODD_F32_IMPLEMENTATION\n#include "odd_f32_single.h"\n'
    texts["use.c"] += f"void f(void);\nvoid f(void) {{ {STILL}}}\n"
    assert complaint(texts, "use.c", tmp_path) == ""


def macros(text: str, command: Iterable[str]) -> set[str]:
    """Return the macros without arguments that a compiler knows after a text."""
    done = subprocess.run([*command, "-dM", "-E", "-x", "c", "-"], input=text, text=True,
                          capture_output=True, check=True)  # fmt: skip
    return set(re.findall(r"^#define (\w+) ", done.stdout, re.MULTILINE))


@pytest.mark.target
def test_every_macro_of_the_boards_of_arduino_is_put_aside_or_refused() -> None:
    if shutil.which("avr-gcc") is None:
        pytest.skip("avr-gcc is not here")
    board = "#include <avr/io.h>\n#include <avr/interrupt.h>\n"
    found = set[str]().union(*(macros(board, ("avr-gcc", f"-mmcu={mcu}")) for mcu in AVR))
    could = {name for name in found if NAME.fullmatch(name) and not owner(name)}
    assert len(could) > 5000
    assert {name for name in could if not is_put_aside(name)} == set()
