"""A new operator is one row in one table a room, and works from the scene's text to the C."""

import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from derive.program.arithmetic import OPERATORS
from tests.made import thinned

ROOT = Path(__file__).parent.parent.parent
BEFORE = {
    "scene/functions.py": '    "tan": Function(',
    "program/arithmetic.py": '    "atan2": Operator(',
    "lower/derivative.py": '    "sqrt": lambda',
    "verify/operators.py": '    "tan": Meaning(',
}
ROWS = {
    "scene/functions.py": "Function(0, math.tanh, lambda _: iv.mpf([-1, 1]))",
    "program/arithmetic.py": 'Operator("libm", libc="tanh")',
    "lower/derivative.py": """lambda g, v: (
        g.add([g.number(1), g.mul([g.number(-1), g.power(g.call("tanh", *v), 2)])]),
    )""",
    "verify/operators.py": (
        "Meaning(lambda x: x.tanh(), doubles=np.tanh, slope=lambda _, __, y: 1 - y * y)"
    ),
}
SCENE = """
wanted = ["drag", "drag_jacobian"]
[parameters]
m = { unit = "kg", range = [1, 2] }
k = { unit = "N m", range = [1, 2] }
[coordinates]
phi = { unit = "rad", range = [-1, 1] }
[frames.arm]
turned = ["y phi"]
[bodies.bob]
frame = "arm"
shape = "point"
mass = "m"
centre = ["0", "0", "-1"]
[loads]
pin = { on = "bob", force = "?pin", couple = ["?cx", "-k*tanh(2*phi)", "?cz"] }
[results]
drag = "phi_ddot*tanh(phi)"
"""
MOST = 8.0  # u
RUN = """
import json, sys
from pathlib import Path
from derive.check.compiler import find_compiler
from derive.check.emitted import Files, casadi_module, loaded
from derive.emit.files import scene_files
from derive.library.library import library
from derive.scene import parse_scene
from derive.verify.prove import prove
from derive.verify.search import Sampling
from derive.verify.stated import figures
made = library(parse_scene(sys.stdin.read(), "odd"))
prove(made)
few = Sampling(samples=64, rounds=1, batch=16, balls=1, corners=1)
print(json.dumps([[m.median, m.worst] for m in figures(made, few)]))
texts = {name.partition("/")[2]: text for name, text in scene_files(made, ()).items()}
files, here = Files(texts, ""), Path(sys.argv[1])
for one in loaded(made, files, here, find_compiler()):
    given = {q.name: [0.75 + 0.25 * k for k in range(len(q.components))]
             for q in made["drag"].inputs if q.name != "constants"}
    if "setup" in one.functions:
        names = [q.name for q in made.setup.inputs]
        given |= one.functions["setup"](dict.fromkeys(names, [1.5]))
    print(json.dumps(one.functions["drag_jacobian"](given)))
module = casadi_module(made, files, here)
names = module.PARAMETERS
drag, slope = module.drag_jacobian()([1.5] * len(names), 0.75)
print(json.dumps({"drag": [float(drag)], "jacobian": [float(slope)]}))
"""


def spread(folder: Path, rooms: dict[str, str]) -> None:
    """Copy the package, with a row for the hyperbolic tangent in the tables of some rooms."""
    for name in ("derive", "templates"):
        shutil.copytree(ROOT / name, folder / name)
    for file, row in rooms.items():
        path = folder / "derive" / file
        text = path.read_text(encoding="utf-8")
        assert text.count(BEFORE[file]) == 1
        new = f'    "tanh": {row},\n{BEFORE[file]}'
        path.write_text(text.replace(BEFORE[file], new), encoding="utf-8")


def ran(folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", RUN, str(folder / "made")]
    return subprocess.run(
        command, input=SCENE, cwd=folder, capture_output=True, text=True, check=False
    )


@pytest.mark.long
def test_a_row_a_room_is_all_that_a_new_operator_takes(tmp_path: Path) -> None:
    spread(tmp_path, ROWS)
    done = ran(tmp_path)
    assert done.returncode == 0, done.stderr
    once, twice = math.tanh(0.75), math.tanh(1.5)
    slope = -2 * (1 - twice**2) * once - twice * (1 - once**2)
    errors, *lines = done.stdout.splitlines()
    each = json.loads(errors)
    assert len(each) == 6  # drag, and both of drag_jacobian, in float and in double
    assert all(0 < median <= worst < MOST for median, worst in each)
    for line, room in zip(lines, (1e-6, 1e-15, 1e-15), strict=True):
        found = json.loads(line)
        assert found["drag"] == pytest.approx([-twice * once], rel=room)
        assert found["jacobian"] == pytest.approx([slope], rel=room)


@pytest.mark.long
@pytest.mark.parametrize("file", thinned(ROWS, len(ROWS)))
def test_without_one_of_the_rows_it_does_not_work(file: str, tmp_path: Path) -> None:
    spread(tmp_path, {name: row for name, row in ROWS.items() if name != file})
    assert "tanh" in ran(tmp_path).stderr


def test_every_room_has_at_most_one_of_the_tables() -> None:
    rooms = [file.partition("/")[0] for file in ROWS]
    assert len(set(rooms)) == len(rooms)
    assert "tanh" not in OPERATORS
