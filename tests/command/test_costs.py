"""The table of costs fits a page, shows every function, and explains every word in it."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from derive import load
from derive.cli import parser
from derive.command.costs import WIDTH, full, print_costs, usual
from derive.command.generate import VIEWS
from derive.library.saving import Saving
from derive.scene import catalogue
from derive.solve.generation import CostRow, Made, few_digits
from derive.solve.several import made_of
from derive.verify.kept import Measuring, figures_of
from derive.verify.search import SAMPLING
from tests.made import library_of

GENERATED = Path(__file__).parents[2] / "generated"
UNKNOWNS = ("hinge_radial", "hinge_side", "hinge_z", "friction", "N", "drive") * 3
FIGURES = ("median_ulp", "largest_within_ulp", "largest_ulp")


def whole_catalogue() -> list[Made]:
    """Return what every scene costs, as its JSON says; a function of each with savings."""
    return [_of_one(name) for name in catalogue()]


def _of_one(scene: str) -> Made:
    text = (GENERATED / scene / f"{scene}.json").read_text(encoding="utf-8")
    found = [f for f in json.loads(text)["functions"] if isinstance(f.get("error"), dict)]
    rows = [
        CostRow(
            scene,
            f["name"],
            f["cost"]["flops"],
            f["cost"].get("div", 0),
            tuple(tuple(_most(f["error"][p], of) for of in FIGURES) for p in ("f32", "f64")),
            "of the largest component, by rounding alone",
        )
        for f in found
    ]
    spared = [Saving(scene, rows[0].function, UNKNOWNS, UNKNOWNS, rows[0].flops, 12345)]
    return Made({}, (), tuple(rows), tuple(spared))


def _most(outputs: dict[str, dict[str, float]], figure: str) -> float:
    return max(row[figure] for row in outputs.values())


@pytest.mark.parametrize("view", [usual, full])
def test_the_table_of_the_whole_catalogue_fits_and_cuts_nothing(view, capsys):
    every = whole_catalogue()
    print_costs(every, view)
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= WIDTH
    assert not any("…" in line for line in lines)
    assert not any(line.endswith(" ") for line in lines)
    shown = [line.split() for line in lines]
    for row in (row for result in every for row in result.costs):
        numbers = [f"{n:.2g}" for of in row.errors for n in of[: 2 if view is usual else 3]]
        assert [row.function, str(row.flops), str(row.divisions), *numbers] in shown


@pytest.mark.parametrize("view", [usual, full])
def test_every_word_of_the_table_is_explained_below_it(view, capsys):
    print_costs([_of_one("edge_runner_flat")], view)
    table, words = capsys.readouterr().out.split("\n\n")
    explained = set(re.findall(r"^(\S.*?)  +\S", words, re.MULTILINE))
    heads = set(re.findall(r"\+ - \* /|[\w/]+", "".join(table.splitlines()[:2]))) - {"function"}
    heads |= set(re.findall(r"^ +(\w[\w ]*): ", table, re.MULTILINE))
    assert {"median", "largest", "/", "+ - * /"} <= heads
    assert ("left out" in heads) == (view is full)
    assert heads <= explained | {"float", "double"}
    assert {"float, double", "u"} <= explained


def test_what_is_asked_for_at_length_is_worked_out_and_shown():
    asked = [parser().parse_args(["generate", *more]).tell for more in ((), ("-v",))]
    assert [VIEWS[tell] for tell in asked] == [usual, full]
    scene = load("propeller_3_blade")
    found = [made_of([scene], GENERATED, tell=tell)[0].savings for tell in asked]
    assert [bool(each) for each in found] == [False, True]


def test_who_loses_most_digits_is_told_where_to_look() -> None:
    measured = figures_of(library_of("heavy_top"), Measuring(SAMPLING, GENERATED)).each
    assert list(few_digits(measured)) == []
    bad = [replace(m, within=m.within * 1e5) for m in measured if m.function == "state_rate"]
    (warned,) = few_digits([*measured, *bad])
    worst = max(bad, key=lambda m: m.within)
    rule = f"state_rate: rounding makes {worst.output} wrong by up to {worst.within:.2g} u in"
    assert warned.startswith(f"{rule} {'double' if worst.precision == 'f64' else 'float'}; ")
