"""Examples that hypothesis draws are judged by what comes out, not by how busy the machine is.

Processes take tests in long runs of neighbours, which share what they build, and steal at the end.
"""

from typing import Any

import pytest
from hypothesis import settings

settings.register_profile("derive", deadline=None)
settings.load_profile("derive")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)
