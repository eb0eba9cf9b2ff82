"""A scene in, with where it is to go and what that may cost; the trajectory out that costs least.

`plant` makes functions of CasADi of the scene's own equations, `task` reads where to go, `direct`
finds a trajectory on a grid of time by IPOPT, `arcs` refines it between the times at which inputs
switch, `conditions` looks whether Pontryagin's hold, and flies the inputs; `steering` does it all.
"""

from derive.control.steering import steer
from derive.control.trajectory import Trajectory

__all__ = ["Trajectory", "steer"]
