"""Members at their start: constants of each, attitudes of length one, loops closed."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.program import Quantity
from derive.program.status import RIGHT
from derive.solve.sweep.kit import ByMembers
from derive.solve.sweep.lanes import Lanes, places_for
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.vary import FloatColumn

UNCLOSED = -1
"""What stands in the place of set-up's status where no start fulfils the constraints."""
FAR_OFF = -2
"""The same where it would be another start than the one that was meant."""


def lanes_begun(
    by: ByMembers,
    library: Library,
    plan: SweepPlan,
    given: Mapping[str, FloatColumn | float],
    ids: NDArray[np.int64],
) -> tuple[Lanes, NDArray[np.int32]]:
    """Return members at their start, and what set-up says of each: 0 is right, or UNCLOSED.

    given : each component, a number for all or (all members,)
    """
    own = {n: x[ids] if isinstance(x, np.ndarray) else x for n, x in given.items()}
    count = len(ids)

    def rows(q: Quantity) -> NDArray[Any]:
        middle = float(((q.low or 0) + (q.high or 0)) / 2)
        each = [np.broadcast_to(own.get(c, middle), count) for c in q.components]
        return np.array(each, dtype=np.float64)

    setup = list(library.setup.inputs)
    constants, status = None, np.zeros(count, np.int32)
    if setup and not library.fixed:
        varies = any(isinstance(own.get(c), np.ndarray) for q in setup for c in q.components)
        parameters = np.concatenate([rows(q) for q in setup])
        constants, status = by.setup(parameters if varies else parameters[:, :1].copy())
        if not varies:
            constants, status = constants[:, 0].copy(), np.repeat(status, count)
    held = _held(library, plan.functions)
    state = {q.name: rows(q) for q in library.vocabulary.states}
    for name in plan.turned:
        w, x, y, z = state[name]
        state[name] /= np.sqrt(w * w + x * x + y * y + z * z)
    places = places_for([state], 3 if plan.stop else 2)
    lanes = Lanes(by, library, plan, ids, constants, own, {q.name: rows(q) for q in held},
                  places)  # fmt: skip
    if plan.onto:
        drawn = lanes.here()
        status = np.where((status == RIGHT) & ~lanes.onto(), UNCLOSED, status)
        far = lanes.parts_from(drawn) > plan.near
        status = np.where((status == RIGHT) & far, FAR_OFF, status)
    return lanes, status


def _held(library: Library, functions: Sequence[str]) -> list[Quantity]:
    """Return what functions are given beside the state, constants and the length of a step."""
    states = {q.name for q in library.vocabulary.states}
    each = [q for name in functions for q in library[name].inputs]
    return [q for q in {q.name: q for q in each}.values()
            if q.role != "constants" and q.name not in (*states, "time_step")]  # fmt: skip
