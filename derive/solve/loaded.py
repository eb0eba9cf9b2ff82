"""A scene by its name, its file or a dict: what everything begins with."""

from collections.abc import Mapping
from pathlib import Path

from derive.scene import SceneError, contents, document_text
from derive.solve.handle import Handle, handle


def load(source: str | Path | Mapping[str, object], name: str = "") -> Handle:
    """Return a scene: of the catalogue by its name, of a file by its path, or of a dict.

    source : a dict is the parsed form of a TOML file, and read as strictly
    name   : what the scene of a dict is called; a file's is its stem

    Raises DeriveError with one sentence if there is no such scene or it breaks a rule.

    >>> load("heavy_top").wanted
    ('state_rate', 'state_rate_jacobian', 'kinetic_energy', 'angular_momentum')
    """
    if not isinstance(name, str):
        raise SceneError(f"a scene's name is a text, not {type(name).__name__}")
    if isinstance(source, Mapping):
        if not name:
            raise SceneError("a scene that is a dict needs a name: load(..., name='rotor')")
        return handle(document_text(source, name), name, f"{name}.toml", ())
    if not isinstance(source, str | Path):
        raise SceneError(f"a scene is a name, a path or a dict, not {type(source).__name__}")
    text, stem = contents(source)
    if name not in ("", stem):
        raise SceneError(f"scene '{stem}': a file names its scene; rename it to '{name}.toml'")
    return handle(text, stem, str(source), ())
