"""Packages in the tools that they are for: built, found, checked by their own rules, run on a core.

`pip install -e '.[target]'` brings the tools that are wheels.
"""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from derive.check.target.build import linked
from derive.check.target.core import CORES, FLAGS
from derive.check.target.run import said_on_board
from derive.program.precision import PRECISIONS
from tests.check.target.packaged import NAME, required, told, write_package

pytestmark = pytest.mark.target


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a package."""
    folder = tmp_path_factory.mktemp("tools") / NAME
    write_package(folder, PRECISIONS)
    return folder


def cmake(folder: Path, text: str, *options: str) -> str:
    """Return what configuring, building and testing a project of CMake says."""
    required("cmake", "ctest")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "CMakeLists.txt").write_text(text)
    return built_by_cmake(folder, *options)


def built_by_cmake(folder: Path, *options: str) -> str:
    said = told(folder, "cmake", "-S", ".", "-B", "build", *options)
    said += told(folder, "cmake", "--build", "build")
    return said + told(folder, "ctest", "--test-dir", "build", "--output-on-failure")


USES = f"""
enable_testing()
file(WRITE ${{CMAKE_BINARY_DIR}}/use.c
  "#include \\"{NAME}_test.h\\"\\n"
  "int main(void) {{ return {NAME}_test_f32() + {NAME}_test_f64(); }}\\n")
add_executable(use ${{CMAKE_BINARY_DIR}}/use.c
  ${{TESTS}}/{NAME}_test_f32.c ${{TESTS}}/{NAME}_test_f64.c)
target_include_directories(use PRIVATE ${{TESTS}})
add_test(NAME use COMMAND use)
"""
AVAILABLE = f"FetchContent_MakeAvailable({NAME})"
HEAD = "cmake_minimum_required(VERSION 3.20)\nproject(app C)\n"


def test_cmake_builds_tests_installs_and_finds_it(place: Path, tmp_path: Path) -> None:
    required("cmake", "ctest")
    own = tmp_path / "own"
    shutil.copytree(place, own)
    assert "100% tests passed" in built_by_cmake(own)
    told(own, "cmake", "--install", "build", "--prefix", str(tmp_path / "prefix"))
    link = f"target_link_libraries(use PRIVATE {NAME}::{NAME})\n"
    finds = f"{HEAD}find_package({NAME} 0.1 REQUIRED){USES}{link}"
    where = (f"-DCMAKE_PREFIX_PATH={tmp_path / 'prefix'}", f"-DTESTS={place / 'test'}")
    assert "100% tests passed" in cmake(tmp_path / "finds", finds, *where)


@pytest.mark.parametrize("how", [
    f"add_subdirectory({{place}} {NAME})",
    f"include(FetchContent)\nFetchContent_Declare({NAME} SOURCE_DIR {{place}})\n{AVAILABLE}",
])  # fmt: skip
def test_another_project_of_cmake_takes_it(how: str, place: Path, tmp_path: Path) -> None:
    link = f"target_link_libraries(use PRIVATE {NAME}::{NAME})\n"
    text = HEAD + how.format(place=place) + USES + link
    said = cmake(tmp_path, text, f"-DTESTS={place / 'test'}")
    assert "100% tests passed" in said
    assert f"{NAME}_example" not in said


ESP_IDF = f"""{HEAD}
function(idf_component_register)
  cmake_parse_arguments(PARSE_ARGV 0 own "" "" "SRCS;INCLUDE_DIRS")
  add_library(component ${{own_SRCS}})
  target_include_directories(component PUBLIC ${{own_INCLUDE_DIRS}})
endfunction()
set(ESP_PLATFORM 1)
add_subdirectory({{place}} component)
{{uses}}
target_link_libraries(use PRIVATE component m)
"""
ZEPHYR = f"""{HEAD}
macro(zephyr_library_named name)
  add_library(${{name}})
  set(own ${{name}})
endmacro()
function(zephyr_library_sources_ifdef feature)
  if(${{feature}})
    target_sources(${{own}} PRIVATE ${{ARGN}})
  endif()
endfunction()
function(zephyr_include_directories)
  include_directories(${{ARGN}})
endfunction()
set(CONFIG_DERIVE_HEAVY_TOP y)
set(CONFIG_DERIVE_HEAVY_TOP_F32 y)
set(CONFIG_DERIVE_HEAVY_TOP_F64 y)
add_subdirectory({{place}}/zephyr module)
include_directories({{place}}/src)
{{uses}}
target_link_libraries(use PRIVATE {NAME} m)
"""


@pytest.mark.parametrize("stands_in", [ESP_IDF, ZEPHYR], ids=["esp-idf", "zephyr"])
def test_what_other_systems_add_to_cmake_is_told_the_sources(
    stands_in: str, place: Path, tmp_path: Path
) -> None:
    text = stands_in.replace("{place}", str(place)).replace("{uses}", USES)
    assert "100% tests passed" in cmake(tmp_path, text, f"-DTESTS={place / 'test'}")


def test_make_builds_and_tests_it(place: Path, tmp_path: Path) -> None:
    required("make")
    shutil.copytree(place, own := tmp_path / "own")
    told(own, "make", "check", "example", "CFLAGS=-O2 -Wall -Wextra -Werror")
    assert (own / "build" / f"lib{NAME}.a").is_file()
    wrong = own / "src" / f"{NAME}_f32.c"
    wrong.write_text(wrong.read_text().replace("    return 0;", "    return 1;"))
    assert subprocess.run(["make", "check"], cwd=own, check=False, capture_output=True).returncode


PLATFORMIO = """
import sys
from platformio.package.manifest.parser import ManifestParserFactory
from platformio.package.manifest.schema import ManifestSchema
# Its list of licences comes from the network; ours is one of them.
ManifestSchema.load_spdx_licenses = staticmethod(lambda: {"licenses": [{"licenseId": "MIT"}]})
said = ManifestParserFactory.new_from_file(sys.argv[1]).as_dict()
print(ManifestSchema().load_manifest(said)["name"])
"""


def test_platformio_takes_its_manifest_and_arduinos(place: Path, tmp_path: Path) -> None:
    required("platformio")
    for file in ("library.json", "library.properties"):
        said = told(place, sys.executable, "-c", PLATFORMIO, file)
        assert said.split() == [NAME]
    text = (place / "library.json").read_text().replace('"0.1.0"', '"first"')
    (tmp_path / "library.json").write_text(text)
    with pytest.raises(AssertionError, match="version"):
        told(tmp_path, sys.executable, "-c", PLATFORMIO, "library.json")


def test_esp_idf_takes_its_manifest(place: Path, tmp_path: Path) -> None:
    required("compote")
    command = ("compote", "manifest", "lint")
    told(place, *command, "idf_component.yml")
    text = (place / "idf_component.yml").read_text()
    (tmp_path / "idf_component.yml").write_text(text.replace('"0.1.0"', '"first"'))
    with pytest.raises(AssertionError, match="version"):
        told(tmp_path, *command, "idf_component.yml")


KCONFIG = """
import sys, kconfiglib
found = kconfiglib.Kconfig(sys.argv[1], warn_to_stderr=False)
print([w for w in found.warnings if "REQUIRES_FULL_LIBC" not in w])  # Zephyr's own
found.syms["DERIVE_HEAVY_TOP"].set_value("y")
print(*(s.name for s in found.unique_defined_syms if s.str_value == "y"))
"""


def test_zephyr_reads_its_module_and_its_options(place: Path) -> None:
    required("kconfiglib")
    said = told(place, sys.executable, "-c", KCONFIG, "zephyr/Kconfig").splitlines()
    own = "DERIVE_HEAVY_TOP"
    assert said == ["[]", f"{own} {own}_F32 {own}_F64"]
    # As https://docs.zephyrproject.org/latest/develop/modules.html has it.
    lines = (place / "zephyr" / "module.yml").read_text().splitlines()
    assert lines[1:] == [f"name: {NAME}", "build:", "  cmake: zephyr", "  kconfig: zephyr/Kconfig"]
    assert (place / "zephyr" / "CMakeLists.txt").is_file()


SAYS = """
#include "board.h"
#include "heavy_top_test.h"
int main(void)
{
    const char *const found[3] = {"no double\\n", "all\\n", "other bits\\n"};
    say(found[ASKED() > 0 ? 2 : ASKED() + 1]);
    return 0;
}
"""


@pytest.mark.parametrize(("core", "precision", "says"), [
    ("m4f", "f32", "all"), ("m4f", "f64", "no double"), ("m3", "f64", "no double"),
    ("m7", "f64", "all"), ("m0plus", "f32", "all"), ("rv32imac", "f64", "all"),
])  # fmt: skip
def test_the_test_of_a_package_tells_on_its_core(
    core: str, precision: str, says: str, place: Path, tmp_path: Path
) -> None:
    (tmp_path / "says.c").write_text(SAYS)
    on, own = CORES[core], f"{NAME}_test_{precision}"
    units = (
        "says.c",
        str(place / "test" / f"{own}.c"),
        str(place / "src" / f"{NAME}_{precision}.c"),
    )
    include = (f"-I{place / 'src'}", f"-I{place / 'test'}", f"-DASKED={own}")
    program = linked(on, (*include, *FLAGS[2:], *units), tmp_path, "test.elf")
    assert said_on_board(on, program).split("\n")[0] == says
