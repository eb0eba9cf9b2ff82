"""Examples that hypothesis draws are judged by what comes out, not by how busy the machine is.

Tests of one scene stand side by side. Processes take tests in long runs of neighbours, which share
what they build, and steal at the end.
"""

from collections import defaultdict
from pathlib import Path
from typing import Any
from zlib import crc32

import pytest
from hypothesis import settings

from derive.scene import catalogue

collect_ignore_glob = ["data/*"]
settings.register_profile("derive", deadline=None)
settings.load_profile("derive")
FEW = 1
"""Of a table the quick tests run so many rows, and ``-m long`` the others."""
PART = 24
"""Of a table of long tests, continuous integration runs a row, or one of so many."""
SLOW = {"acrobot", "quadrotor", "rattleback"}
"""Scenes that take seconds to derive: their rows run with ``-m long``."""
BENCH = Path(__file__).parent / "bench"
"""Tests of what only the checkout has run with ``-m long``."""
SCENES = {*catalogue(), *(path.stem for path in Path(__file__).parent.rglob("*.toml"))}


def scene(item: pytest.Item) -> str:
    """Return the name of the scene that a row of a table is about, "" if none."""
    row = getattr(item, "callspec", None)
    names = (Path(v).stem for v in row.params.values() if isinstance(v, str | Path)) if row else ()
    return next((name for name in names if name in SCENES), "")


def _all_but(few: int, rows: list[pytest.Item], name: str) -> list[pytest.Item]:
    """Return the rows of a table but a few, which are spread over it from a place of its own."""
    first, count = crc32(name.encode()), len(rows)
    run = {(first + k * count // few) % count for k in range(few)}
    return [row for place, row in enumerate(rows) if place not in run]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Order the tests by scene, and mark those of slow scenes and what only a whole run has."""
    short, long = (defaultdict[str, list[pytest.Item]](list) for _ in range(2))
    for item in items:
        aside = any(map(item.get_closest_marker, ("browser", "target")))
        if (scene(item) in SLOW or item.path.is_relative_to(BENCH)) and not aside:
            item.add_marker("long")
        if not aside:
            tables = long if item.get_closest_marker("long") else short
            tables[item.nodeid.partition("[")[0]].append(item)
    for name, rows in long.items():
        for row in _all_but(-(-len(rows) // PART), rows, name):
            row.add_marker("whole")
    for name, rows in short.items():
        for row in _all_but(FEW, rows, name):
            row.add_marker("long")
    items.sort(key=scene)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)
