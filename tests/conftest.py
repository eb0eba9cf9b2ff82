"""Examples that hypothesis draws are judged by what comes out, not by how busy the machine is.

Processes take tests in long runs of neighbours, which share what they build, and steal at the end.
"""

from collections import defaultdict
from typing import Any
from zlib import crc32

import pytest
from hypothesis import settings

settings.register_profile("derive", deadline=None)
settings.load_profile("derive")
MANY, PART = 9, 3
"""Of a test with more than ``MANY`` long cases, continuous integration runs a third."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what only a whole run has: two rows of three, from another row on in each table."""
    tables = defaultdict[str, list[pytest.Item]](list)
    for item in items:
        if item.get_closest_marker("long"):
            tables[item.nodeid.partition("[")[0]].append(item)
    for name, rows in tables.items():
        if len(rows) > MANY:
            for place, row in enumerate(rows, crc32(name.encode())):
                if place % PART:
                    row.add_marker("whole")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)
