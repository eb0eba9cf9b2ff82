"""A machine as a cloud of particles in the inertial frame: positions in time, and nothing else.

Forces are masses times accelerations of particles, accelerations are read off the positions. No
inertia tensor, angular momentum, transport theorem or choice of balances is known here, so what
this agrees with is right for other reasons.
"""

from derive.cloud.solution import Answers, answers

__all__ = ["Answers", "answers"]
