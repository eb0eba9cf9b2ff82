"""A machine as a cloud of particles in the inertial frame: positions in time, and nothing else.

Forces are masses times accelerations of particles, accelerations are read off the positions. Of a
body's declared tensor only particles are made that have it; no angular momentum, transport theorem
or choice of balances is known here, so what this agrees with is right for other reasons.
"""

from derive.verify.cloud.solution import CloudAnswers, answers

__all__ = ["CloudAnswers", "answers"]
