"""A scene whose constants are made of numbers alone: set-up has no argument, anywhere."""

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import derive
from derive.check.compiler import WARNINGS, find_compiler
from derive.solve.bound import By
from tests.solve.test_function import bits

SCENE = {
    "wanted": ["kinetic_energy"],
    "parameters": {"B": {"unit": "kg m^2", "value": 0.75}},
    "body": {"kind": "principal", "moments": [1, "sqrt(2)*B", 1]},
}


@pytest.mark.parametrize("by", ["compiler", "casadi"])
def test_a_function_makes_its_constants_of_nothing(by: By) -> None:
    scene = derive.load(SCENE, name="still")
    function = scene.function("kinetic_energy", by=by)
    rates = np.array([[1.0, 2.0, 3.0], [0.0, 2.0, 0.0]])
    many = function(rates)
    assert many == pytest.approx([5 + 1.5 * np.sqrt(2), 1.5 * np.sqrt(2)], rel=1e-15)
    assert bits(many) == bits(np.array([function(row) for row in rates]))


def test_the_files_have_no_empty_argument_and_no_warning(tmp_path: Path) -> None:
    made = derive.load(SCENE, name="still").generate(tmp_path, samples=64, parts="batch")
    assert made
    compiler = [*find_compiler().command, "-std=c99", "-O2", *WARNINGS, "-Werror", "-c"]
    folder = tmp_path / "still"
    sources = sorted(folder.glob("*.c"))
    head = (folder / "still_f64.h").read_text(encoding="utf-8")
    lines = re.findall(r"^ \*     (.*)$", head.split("Use:")[1].split("Outputs")[0], re.MULTILINE)
    (folder / "use.c").write_text(
        '#include "still_f64.h"\nint use(void);\nint use(void)\n{\n'
        + "\n".join(lines) + "\nreturn kinetic_energy > 0.0;\n}\n", encoding="utf-8"
    )  # fmt: skip
    assert len(sources) == 4
    for source in (*sources, folder / "use.c"):
        told = [*compiler, str(source), "-o", str(tmp_path / "x.o")]
        done = subprocess.run(told, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
