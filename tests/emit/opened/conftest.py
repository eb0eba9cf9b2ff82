"""One window for all pages that a process opens."""

from collections.abc import Iterator
from typing import Any

import pytest

from tests.emit.opened.opened import window


@pytest.fixture(scope="session")
def shown() -> Iterator[Any]:
    with window() as page:
        yield page
