"""The program of docs/batch.md prints what stands below it, and the JSON tells how to call."""

import ctypes
import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derive.check.compiler import Compiler, find_compiler
from derive.emit.c.members_file import OVER_MEMBERS, VECTOR_OPTIONS, members_files
from derive.emit.c.source import c_files
from derive.emit.manifest import manifest
from derive.library.fixed import with_fixed
from derive.solve.generation import EXTENTS, extent_of
from derive.solve.members import shared_members
from tests.made import library_of
from tests.pages import blocks

PAGE = Path(__file__).parent.parent.parent / "docs" / "batch.md"


def test_the_program_of_the_page_prints_what_stands_below_it(tmp_path: Path) -> None:
    (program,) = [block for block in blocks(PAGE) if block.language == "c"]
    made = library_of("heavy_top")
    texts = c_files(made, ()) | members_files(made, ()) | {"main.c": program.text}
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    sources = ("main.c", "heavy_top_f64.c", "heavy_top_batch_f64.c")
    command = (*find_compiler().command, "-std=c99", *VECTOR_OPTIONS, *sources, "-o", "main", "-lm")
    subprocess.run(command, cwd=tmp_path, check=True)
    done = subprocess.run("./main", cwd=tmp_path, check=True, capture_output=True, text=True)
    assert done.stdout == program.shown


def test_the_json_is_enough_to_call_a_function(tmp_path: Path) -> None:
    made = library_of("heavy_top")
    told = json.loads(manifest(made, (), parts=[OVER_MEMBERS]))["batch"]
    texts = c_files(made, ()) | members_files(made, ())
    own = {name: text for name, text in texts.items() if "_f64" in name}
    assert {told["files"]["f64"]["header"], told["files"]["f64"]["source"]} < own.keys()
    file = shared_members(own, tmp_path, Compiler(find_compiler().command), told["options"])
    shared, many = ctypes.CDLL(str(file)), 5
    arrays: dict[str, Any] = {"members": many, "stride": many}
    arrays |= {n: np.full(many, x) for n, x in (("A", 2.0), ("C", 1.0), ("m", 3.0), ("g", 9.0))}
    arrays |= {"l": np.arange(many, dtype=float), "status": np.full(many, 9, np.int32)}
    arrays |= {"constants": np.zeros((6, many)), "theta": np.full(many, np.pi / 2)}
    arrays |= {n: np.zeros((3, many)) for n in ("omega", "coordinate_rates", "omega_dot")}
    setup, rate, *_ = told["functions"]
    assert (setup["name"], rate["name"], rate["vectors"]) == ("setup", "state_rate", True)
    for of, symbol in ((setup, setup["symbols"]["f64"]), (rate, rate["each"]["f64"])):
        given = [arrays[name] for name in of["arguments"]]
        shared[symbol](*map(_argument, given))
    assert arrays["status"].tolist() == [0] * many
    assert arrays["omega_dot"][0].tolist() == [13.5 * k for k in range(many)]


def _argument(value: object) -> object:
    if isinstance(value, int):
        return ctypes.c_ssize_t(value)
    assert isinstance(value, np.ndarray)
    return ctypes.c_void_p(value.ctypes.data)


def test_without_the_option_nothing_speaks_of_members() -> None:
    made = library_of("heavy_top")
    assert OVER_MEMBERS not in json.loads(manifest(made, ()))
    assert not any("_batch_" in text for text in c_files(made, ()).values())


def test_fixed_parameters_leave_one_set_of_constants() -> None:
    values = {"A": 0.0015, "C": 0.0006, "m": 0.6, "g": 9.8, "l": 0.04}
    texts = members_files(with_fixed(library_of("heavy_top"), values), ())
    assert not any("setup" in text or "_each" in text.partition("#ifndef")[2]
                   for name, text in texts.items() if name.endswith(".h"))  # fmt: skip


@pytest.mark.parametrize("whole", EXTENTS)
def test_options_add_up(whole: str) -> None:
    assert extent_of(EXTENTS[whole]) == whole
