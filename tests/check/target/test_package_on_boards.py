"""Packages in tools that build for boards, and what comes out runs there."""

import re
import shutil
import subprocess
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path

import pytest

from derive.program.precision import F32, PRECISIONS
from tests.check.target.packaged import NAME, required, told, write_package

pytestmark = pytest.mark.target

ARDUINO = f"""
#include <avr/sleep.h>
#include <{NAME}_f32.h>
#include "{NAME}_test.h"
void setup()
{{
    Serial.begin(115200);
    Serial.println({NAME}_test_f32());
    Serial.flush();
    noInterrupts();
    sleep_enable();
    sleep_cpu();
}}
void loop() {{}}
"""
MEGA = "arduino:avr:mega:cpu=atmega2560"
UNDECLARED = "compiler.cpp.extra_flags=-DDECIMAL_DIG=9"
"""What the core of Debian needs of <float.h>, and gcc 5 has for C alone."""


def built_by_arduino(libraries: Path, sketch: Path, folder: Path) -> tuple[str, Path]:
    """Return what Arduino's builder says of a sketch, and the program."""
    share = "/usr/share/arduino"
    required("arduino-builder", "avr-gcc", "simavr")
    folder.mkdir()
    hardware = ("-hardware", f"{share}/hardware", "-hardware", f"{share}-builder")
    said = told(folder, "arduino-builder", "-compile", *hardware, "-tools", "/usr/bin",
                "-libraries", str(libraries), "-fqbn", MEGA, "-build-path", str(folder),
                "-warnings", "all", "-prefs", UNDECLARED, str(sketch))  # fmt: skip
    return said, folder / f"{sketch.name}.elf"


def said_on_mega(program: Path) -> list[str]:
    """Return the lines that a program says on an emulated Arduino Mega, until it sleeps."""
    command = ("timeout", "20", "simavr", "-m", "atmega2560", "-f", "16000000", str(program))
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return re.findall(r"\x1b\[32m(.*?)\.*\n", done.stdout + done.stderr)


def test_arduino_builds_its_sketch_and_an_emulated_board_has_the_bits(tmp_path: Path) -> None:
    libraries, own = tmp_path / "libraries", tmp_path / "asked"
    write_package(libraries / NAME, (F32,))
    sketch = libraries / NAME / "examples" / NAME / f"{NAME}.ino"
    said, _ = built_by_arduino(libraries, sketch, tmp_path / "first")
    assert "Sketch uses" in said
    assert NAME not in "".join(line for line in said.splitlines() if "warning" in line)
    own.mkdir()
    for file in (f"{NAME}_test_f32.c", f"{NAME}_test.h"):
        shutil.copy(libraries / NAME / "test" / file, own)
    (own / "asked.ino").write_text(ARDUINO)
    _, program = built_by_arduino(libraries, own / "asked.ino", tmp_path / "second")
    assert said_on_mega(program) == ["0"]
    wrong = libraries / NAME / "src" / f"{NAME}_f32.c"
    wrong.write_text(wrong.read_text().replace("= t0_both.cosine;", "= -t0_both.cosine;"))
    _, program = built_by_arduino(libraries, own / "asked.ino", tmp_path / "third")
    assert said_on_mega(program) == ["2"]


def test_doubles_of_a_board_that_has_none_are_refused_by_a_sentence(tmp_path: Path) -> None:
    libraries = tmp_path / "libraries"
    write_package(libraries / NAME, PRECISIONS)
    sketch = libraries / NAME / "examples" / NAME / f"{NAME}.ino"
    with pytest.raises(AssertionError, match="double has fewer than 64 bits here"):
        built_by_arduino(libraries, sketch, tmp_path / "built")


CALLS = f"""
#include "{NAME}_f32.h"
#include "{NAME}_test.h"
int main(void) {{ return {NAME}_test_f32() + {NAME}_test_f64(); }}
"""
HERE: Mapping[str, str] = {
    "platforms/here/platform.json": '{"name": "here", "title": "here", "version": "1.0.0"}',
    "platforms/here/builder/main.py": "from SCons.Script import Default, DefaultEnvironment\n"
    "Default(DefaultEnvironment().BuildProgram())\n",
    "packages/tool-scons/package.json": '{"name": "tool-scons", "version": "VERSION"}',
    "packages/tool-scons/.piopm": '{"type": "tool", "name": "tool-scons", "version": "VERSION",'
    ' "spec": {"owner": "platformio", "name": "tool-scons"}}',
    "packages/tool-scons/scons.py": "from SCons.Script import main\nmain()\n",
}
"""What PlatformIO would download: a platform, of this machine's compiler, and SCons, a wheel."""


def test_platformio_builds_it_in_a_project_and_the_test_passes(tmp_path: Path) -> None:
    required("pio", "SCons")
    wanted = import_module("platformio.dependencies").get_core_dependencies()["tool-scons"]
    app = tmp_path / "app"
    place = app / "lib" / NAME
    write_package(place, PRECISIONS)
    shutil.copytree(place / "test", app / "src", ignore=shutil.ignore_patterns("main.c"))
    texts = {f"core/{name}": text.replace("VERSION", wanted.strip("~=^"))
             for name, text in HERE.items()}  # fmt: skip
    texts |= {"app/src/main.c": CALLS, "app/platformio.ini": "[env:here]\nplatform = here\n"}
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    settings = ("CORE_DIR=" + str(tmp_path / "core"), "SETTING_ENABLE_TELEMETRY=no",
                "SETTING_CHECK_PLATFORMIO_INTERVAL=9999")  # fmt: skip
    said = told(app, "env", *(f"PLATFORMIO_{each}" for each in settings), "pio", "run")
    assert f"|-- {NAME} @ " in said
    told(app, ".pio/build/here/program")
