"""Set-up that tries its parameters against their ranges: alike in C, in CasADi and in a run."""

import json
from dataclasses import replace
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

from derive.check.compiler import find_compiler
from derive.check.emitted import Files, casadi_module, loaded
from derive.cli import main
from derive.emit.files import scene_files
from derive.library.library import Library
from derive.library.ranges import with_ranges_tried
from derive.program.status import RANGE, RIGHT, statuses
from tests.made import library_of

NAME = "heavy_top"


def trials(library: Library) -> list[list[float]]:
    """Return parameters in the middle of their ranges, and each at its ends and beyond them."""
    ends = [tuple(map(float, q.ends)) for q in library.setup.inputs]
    middle = [(a + b) / 2 for a, b in ends]
    return [middle] + [
        [*middle[:place], x, *middle[place + 1 :]]
        for place, (a, b) in enumerate(ends)
        for x in (a, b, 0.999 * a, 1.001 * b, -inf, nan)
    ]


def in_a_run(library: Library, dtype: type) -> list[int]:
    columns = [np.array(column, dtype) for column in zip(*trials(library), strict=True)]
    return [int(x) for x in statuses(library.setup, columns, dtype)]


def test_c_and_casadi_refuse_what_a_run_refuses(tmp_path: Path) -> None:
    library = with_ranges_tried(library_of(NAME))
    texts = {n.partition("/")[2]: t for n, t in scene_files(library, ()).items()}
    files, names = Files(texts, ""), [q.name for q in library.setup.inputs]
    wanted = in_a_run(library, np.float64)
    assert wanted.count(RANGE) == 2 * len(names)
    assert wanted.count(RIGHT) == 1 + 2 * len(names)
    for one in loaded(library, files, tmp_path, find_compiler()):
        own = in_a_run(library, one.precision.dtype)
        assert own == wanted
        found = [
            one.functions["setup"](dict(zip(names, ([x] for x in given), strict=True)))["status"]
            for given in trials(library)
        ]
        assert [int(x) for (x,) in found] == own
    status = casadi_module(library, files, tmp_path).setup_status()
    assert [int(status(given)) for given in trials(library)] == wanted


def test_a_range_that_is_not_tried_is_noticed() -> None:
    library = with_ranges_tried(library_of(NAME))
    wanted = in_a_run(library, np.float64)
    for left_out in (rule for rule in library.setup.rules if rule.status == RANGE):
        rules = tuple(rule for rule in library.setup.rules if rule is not left_out)
        lax = replace(library, setup=replace(library.setup, rules=rules))
        assert in_a_run(lax, np.float64) != wanted


@pytest.mark.long
def test_header_json_and_command_say_that_ranges_are_tried_and_at_what_cost(
    tmp_path: Path,
) -> None:
    command = ["generate", NAME, "--samples", "64", "--check-ranges", "--out", str(tmp_path)]
    assert main(command) == 0
    header = (tmp_path / NAME / f"{NAME}_f32.h").read_text(encoding="utf-8")
    assert "6 a parameter is outside of its range." in header
    assert "and 10 comparisons with the ends of ranges." in header
    assert "--samples 64 --check-ranges`" in header
    said = json.loads((tmp_path / NAME / f"{NAME}.json").read_text(encoding="utf-8"))
    assert said["functions"][0]["status"]["6"] == "a parameter is outside of its range"
    assert main([*command, "--check"]) == 0


@pytest.mark.parametrize(("typed", "says"), [
    ([], "--check-ranges takes scenes, but none was named"),
    (["attitude"], "there is no set-up that could check ranges"),
    ([NAME, "--fixed", "A=0.0015,C=0.0006,m=0.5,g=9.81,l=0.07"], "l must be within 0.02 .. 0.06"),
])  # fmt: skip
def test_what_cannot_be_tried_is_refused_by_a_sentence(
    typed: list[str], says: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["generate", *typed, "--check-ranges", "--out", str(tmp_path)]) == 2
    assert says in " ".join(capsys.readouterr().err.split())
