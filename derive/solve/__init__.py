"""A scene and values in, numbers out: answers, roots of a steady motion, principal axes.

>>> from derive.solve import opened
>>> runner = opened("edge_runner_flat")
>>> data = {"m": 1200, "r": 0.6, "L": 0.9, "W": 3.2, "g": 9.81}
>>> round(runner.answer("N", data)["N"], 9)
15458.4
"""

from derive.solve.instrument import Instrument, opened
from derive.solve.motions import frequencies, growth, limits, roots
from derive.solve.principal import PrincipalAxes, principal_axes
from derive.solve.simulation import Simulation, plot, simulated

__all__ = [
    "Instrument",
    "PrincipalAxes",
    "Simulation",
    "frequencies",
    "growth",
    "limits",
    "opened",
    "plot",
    "principal_axes",
    "roots",
    "simulated",
]
