"""A scene's CasADi file as a user would import it: the printed text as a module."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import mkdtemp
from types import ModuleType


def imported(name: str, text: str, folder: Path) -> ModuleType:
    """Return the module ``name`` that ``text`` is, its file written below ``folder``.

    Raises ImportError if the file cannot be loaded, and whatever the text raises.
    """
    # A folder of its own: Python's cache knows a file by its path, second and length alone.
    path = Path(mkdtemp(prefix=f"{name}-", dir=folder)) / f"{name}.py"
    path.write_text(text, encoding="utf-8")
    spec = spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is not a Python module")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
