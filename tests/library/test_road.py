"""The road from a file to what is emitted is as library/__init__ tells it, stage by stage."""

import ast
import importlib
import inspect
import re
from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

import derive.library

PAGE = Path(__file__).parents[2] / "docs" / "architecture.md"
STAGE = re.compile(r"^    (\S.*?) +-> (\S.*?)  +([A-Za-z_.]+)$", re.MULTILINE)
INSIDE = {"Op", "Program"}
"""What the library is put together from."""
STAGES = STAGE.findall(derive.library.__doc__ or "")


def function_at(where: str) -> Callable[..., Any]:
    """Return the function of a dotted name within the package, or the method of a class there."""
    module = ".".join(part for part in where.split(".")[:-1] if part.islower())
    found: Any = importlib.import_module(f"derive.{module}")
    for name in where.removeprefix(f"{module}.").split("."):
        found = getattr(found, name)
    return found  # type: ignore[no-any-return]


def told(function: Callable[..., Any]) -> tuple[set[str], set[str]]:
    """Return the names of types that go into a function, a method's class too, and come out."""
    (own,) = ast.parse(dedent(inspect.getsource(function))).body
    assert isinstance(own, ast.FunctionDef)
    given = [ast.unparse(a.annotation) for a in own.args.args if a.annotation is not None]
    given += function.__qualname__.split(".")[:-1]
    assert own.returns is not None
    return words(" ".join(given)), words(ast.unparse(own.returns))


def words(annotation: str) -> set[str]:
    """Return the last names of the types in an annotation."""
    return {name.rpartition(".")[2] for name in re.findall(r"[\w.]+", annotation)}


def faults(stages: list[tuple[str, str, str]]) -> list[str]:
    """Return the stages whose function does not take what comes in, or give what goes out."""
    found = []
    for given, returned, where in stages:
        takes, gives = told(function_at(where))
        if not (words(given) <= takes and words(returned) <= gives):
            found.append(f"{where}: {sorted(takes)} -> {sorted(gives)}")
    return found


def test_every_stage_takes_and_gives_what_the_road_says() -> None:
    assert len(STAGES) == 12
    assert faults(STAGES) == []


def test_a_wrong_stage_is_found() -> None:
    given, returned, where = STAGES[-1]
    assert faults([(returned, given, where)]) != []


def test_what_goes_out_of_a_stage_goes_into_a_later_one_or_is_emitted() -> None:
    made = [words(returned) for _, returned, _ in STAGES]
    taken = [words(given) for given, _, _ in STAGES]
    for n, out in enumerate(made[:-3]):
        assert any(out & into for into in taken[n + 1 :]) or out & INSIDE


def test_the_page_on_what_stands_where_opens_with_the_road() -> None:
    head = PAGE.read_text(encoding="utf-8").split("\n## ")[0]
    assert STAGE.findall(head) == STAGES


@pytest.mark.parametrize("where", [stage[2] for stage in STAGES])
def test_every_stage_says_what_it_returns(where: str) -> None:
    said = inspect.getdoc(function_at(where))
    assert said is not None
    assert said.startswith("Return")
