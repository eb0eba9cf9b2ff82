"""Equations of motion of rotating bodies: derived from particles, printed as checked C and CasADi.

    import derive

    scene = derive.load("heavy_top")          # of the catalogue, a TOML file, or a dict
    scene                                     # what it wants, and what may be given to it
    rate = scene.function("state_rate")       # for NumPy arrays, whole batches too
    scene.solve(values)                       # every answer; roots, frequencies, simulate, ...
    scene.generate("generated")               # C, CasADi, JSON and HTML

Whatever is refused is refused by a ``DeriveError`` of one sentence. docs/python.md tells it all.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from derive.control import Trajectory, steer
    from derive.emit.files import Difference
    from derive.report import SceneReport
    from derive.scene import DeriveError, catalogue
    from derive.solve.answers import Answered
    from derive.solve.function import SceneFunction
    from derive.solve.generation import Generation
    from derive.solve.handle import Handle
    from derive.solve.loaded import load
    from derive.solve.principal import PrincipalAxes, principal_axes
    from derive.solve.several import Comparison, compare, generate
    from derive.solve.simulation import Simulation
    from derive.solve.sweep import Ensemble

__version__ = "0.1.0"
__all__ = [
    "Answered",
    "Comparison",
    "DeriveError",
    "Difference",
    "Ensemble",
    "Generation",
    "Handle",
    "PrincipalAxes",
    "SceneFunction",
    "SceneReport",
    "Simulation",
    "Trajectory",
    "catalogue",
    "compare",
    "generate",
    "load",
    "principal_axes",
    "steer",
]
PLACES = {
    "derive.control": ("Trajectory", "steer"),
    "derive.emit.files": ("Difference",),
    "derive.report": ("SceneReport",),
    "derive.scene": ("DeriveError", "catalogue"),
    "derive.solve.answers": ("Answered",),
    "derive.solve.function": ("SceneFunction",),
    "derive.solve.generation": ("Generation",),
    "derive.solve.handle": ("Handle",),
    "derive.solve.loaded": ("load",),
    "derive.solve.principal": ("PrincipalAxes", "principal_axes"),
    "derive.solve.several": ("Comparison", "compare", "generate"),
    "derive.solve.simulation": ("Simulation",),
    "derive.solve.sweep": ("Ensemble",),
}
"""Where each name stands: its module is imported when it is first asked for, not before."""


def __dir__() -> list[str]:
    """Return what there is."""
    return sorted({*globals(), *__all__})


if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """Return a name of the interface, imported now."""
        place = next((module for module, names in PLACES.items() if name in names), None)
        if place is None:
            raise AttributeError(f"module 'derive' has no attribute '{name}'")
        return getattr(import_module(place), name)
