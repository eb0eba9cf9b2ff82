"""The module of the craft with its C beside it, and a cache in which three steps are compiled."""

from pathlib import Path
from types import ModuleType

import pytest

from derive.emit.casadi_module import imported
from tests.check.craft import texts


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("external")


@pytest.fixture(scope="module")
def module(workshop: Path) -> ModuleType:
    """Return the module of the principal body, its sources beside it."""
    place = imported("craft_casadi", texts("principal")["craft_casadi.py"], workshop)
    folder = Path(str(place.__file__)).parent
    for name, text in texts("principal").items():
        (folder / name).write_text(text, encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def cache_of_three(module: ModuleType, workshop: Path) -> Path:
    """Return a cache folder in which three steps are compiled."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(workshop / "cache"))
        module.external(3)
    return workshop / "cache"
