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
MANY, PART = 6, 8
"""Of a test with more than ``MANY`` long cases, continuous integration runs an eighth."""
SLOW = {"acrobot", "quadrotor", "rattleback"}
"""Scenes that take seconds to derive: their rows run with ``-m long``."""
SCENES = {*catalogue(), *(path.stem for path in Path(__file__).parent.rglob("*.toml"))}


def scene(item: pytest.Item) -> str:
    """Return the name of the scene that a row of a table is about, "" if none."""
    row = getattr(item, "callspec", None)
    names = (Path(v).stem for v in row.params.values() if isinstance(v, str | Path)) if row else ()
    return next((name for name in names if name in SCENES), "")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Order the tests by scene, and mark those of slow scenes and what only a whole run has."""
    tables = defaultdict[str, list[pytest.Item]](list)
    for item in items:
        if scene(item) in SLOW and not any(map(item.get_closest_marker, ("browser", "target"))):
            item.add_marker("long")
        if item.get_closest_marker("long"):
            tables[item.nodeid.partition("[")[0]].append(item)
    for name, rows in tables.items():
        if len(rows) > MANY:
            for place, row in enumerate(rows, crc32(name.encode())):
                if place % PART:
                    row.add_marker("whole")
    items.sort(key=scene)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)
