"""Instructions of a report are those of the function: more work takes as many more."""

import shutil
from pathlib import Path

import pytest

from derive.library.library import Library, library
from derive.program.precision import F64
from derive.report.driver import drivers
from derive.report.instructions import Instructions, instructions
from derive.report.price import Nanoseconds
from derive.report.whole import without
from derive.scene import parse_scene

ENERGY = """
wanted = ["kinetic_energy"]
parameters.A = {{ unit = "kg m^2", range = [1, 2], meaning = "moment" }}
{0}
body = {{ kind = "principal", moments = ["A", "{1}", "{2}"] }}
known = {{ angular_acceleration = [0, 0, 0], angular_velocity = {{ range = [1, 2] }} }}
"""
OTHERS = "\n".join(
    f'parameters.{x} = {{ unit = "kg m^2", range = [1, 2], meaning = "moment" }}' for x in "BC"
)
THERE = shutil.which("gcc") and shutil.which("valgrind")


def made(others: str, *names: str) -> Library:
    return library(parse_scene(ENERGY.format(others, *names), "energy"))


def counted(own: Library, folder: Path) -> list[float]:
    (driver,) = drivers(own, (F64,), folder)
    found = instructions(driver, "fast", own.functions, None, {}, folder)
    return [one.count for one in found]


@pytest.mark.long
@pytest.mark.skipif(not THERE, reason="needs gcc and valgrind")
def test_a_function_takes_the_instructions_that_its_operations_and_arguments_need(
    tmp_path: Path,
) -> None:
    few, many = made("", "A", "A"), made(OTHERS, "B", "C")
    (less,), (more,) = (counted(own, tmp_path) for own in (few, many))
    flops = many.functions[0].flops() - few.functions[0].flops()
    arguments = len(many.functions[0].inputs) - len(few.functions[0].inputs)
    assert flops > 0
    # a flop and its load, at most; of an argument its place, its load, and room for one more
    assert flops <= more - less <= 2 * flops + 8 * max(arguments, 1)
    assert few.functions[0].flops() < less < 100


def test_without_valgrind_nothing_is_counted_and_it_is_said_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = made("", "A", "A")
    (driver,) = drivers(own, (F64,), tmp_path)
    monkeypatch.setattr("derive.report.instructions.is_there", lambda: False)
    assert instructions(driver, "fast", own.functions, None, {}, tmp_path) == []
    times = [Nanoseconds("kinetic_energy", "fast", "f64", 1.0, 1.0, 1.0)]
    assert sum("no valgrind" in said for said in without(times, [])) == 1
    assert not any("valgrind" in said for said in without(times, [COUNT]))


COUNT = Instructions("kinetic_energy", "fast", "f64", 10.0)
