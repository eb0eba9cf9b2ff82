"""The table of proved bounds counts every function of the catalogue once."""

import json
from pathlib import Path

from derive.emit.bounded import WANTED, BoundRow, rows, told
from derive.emit.files import manifests

GENERATED = Path(__file__).parents[2] / "generated"


def test_every_function_of_the_catalogue_is_proved_or_says_why_not() -> None:
    every = [
        (said["scene"], f["name"])
        for said in (json.loads(p.read_text()) for p in manifests(GENERATED))
        for f in said["functions"]
        if f["name"] != "setup" and "same_as" not in f
    ]
    each = rows(GENERATED)
    assert [(row.scene, row.function) for row in each] == every
    assert all((row.ratio is None) == bool(row.why) for row in each)


def test_most_functions_are_proved_and_most_of_them_closely() -> None:
    ratios = [row.ratio for row in rows(GENERATED) if row.ratio is not None]
    assert len(ratios) >= 0.8 * len(rows(GENERATED))
    assert sum(ratio <= WANTED for ratio in ratios) >= 0.75 * len(ratios)


def test_the_table_tells_quartiles_and_reasons() -> None:
    each = [BoundRow("a", str(n), float(n)) for n in range(1, 6)]
    assert told([*each, BoundRow("a", "f", None, "a root")]) == [
        "5 of 6 functions have a proved bound, in float and in double",
        "proved over seen: quartiles 2, 3, 4",
        "at most 3 times what is seen: 3",
        "1 not: a root",
    ]
