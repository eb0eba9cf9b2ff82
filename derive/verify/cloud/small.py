"""Small motion by the cloud: how its accelerations change with places and velocities."""

from collections.abc import Mapping
from typing import Any

from mpmath import matrix, mp, mpf

from derive.scene import Input, Scene
from derive.verify.cloud.fulfilled import fulfilled
from derive.verify.cloud.series import DIGITS
from derive.verify.cloud.solution import CloudAnswers, answers

STEP = mpf(10) ** -15  # a central difference of 50 digits keeps twenty


def slopes_about_rest(machine: Scene, given: Mapping[str, float]) -> tuple[Any, Any]:
    """Return the derivatives of the accelerations by velocities and by places, (n, n) each.

    They are minus M^-1 D and minus M^-1 K of the linearised motion.
    """
    free = [m for m in (*machine.coordinates, *machine.speeds) if m.free and not m.dependent]
    velocities = [m.rate.name if isinstance(m.rate, Input) else m.name for m in free]
    places = [m.name if m.kind == "coordinate" else "" for m in free]
    with mp.workdps(DIGITS):
        base = _base(machine, given)
        found = []
        for names in (velocities, places):
            table = matrix(len(free), len(free))
            for k, name in enumerate(names):
                if name:
                    column = _difference(machine, base, name)
                    for i, m in enumerate(free):
                        table[i, k] = column[m.unknown]
            found.append(table)
        return found[0], found[1]


def is_at_rest(machine: Scene, given: Mapping[str, float]) -> bool:
    """Tell whether the motion of the scene goes on without any acceleration."""
    free = [m.unknown for m in (*machine.coordinates, *machine.speeds) if m.free]
    with mp.workdps(DIGITS):
        found = answers(machine, _base(machine, given)).unknowns
        return all(abs(found.get(name, mpf(1))) < STEP for name in free)


def _base(machine: Scene, given: Mapping[str, float]) -> dict[str, Any]:
    """Return the motion about which the scene is linearised."""
    values = {name: mpf(x) for name, x in given.items()}
    unset = [name for name, f in machine.about.items() if f.name != name]
    start = CloudAnswers(machine, values | dict.fromkeys(unset, mpf(0)))
    return values | {name: start.result(f) for name, f in machine.about.items()}


def _difference(machine: Scene, base: Mapping[str, Any], name: str) -> dict[str, Any]:
    follow = [m.rate.name if isinstance(m.rate, Input) else m.name
              for m in (*machine.coordinates, *machine.speeds) if m.dependent]  # fmt: skip

    def moved(side: int) -> dict[str, Any]:
        there = dict(base) | {name: base[name] + side * STEP}
        if machine.constraints:
            there = fulfilled(machine, there, follow) or there
        return answers(machine, there).unknowns

    ahead, behind = (moved(side) for side in (1, -1))
    return {n: (ahead[n] - behind[n]) / (2 * STEP) for n in ahead if n in behind}
