"""Where members begin that cannot as they are drawn: attitudes have length one, loops are closed.

Of all states around the start that is set, whose varying components are as drawn, one that fulfils
the constraints is come nearer to step by step, distances counted in parts of the declared ranges.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from derive.library.library import Library
from derive.library.on_constraints import homing_of
from derive.motion.constrained import Homing, nearer, reaches
from derive.program.program import Program
from derive.scene import SceneError
from derive.scene.results import DISTANCES
from derive.scene.table import MANY
from derive.solve.instrument import Instrument
from derive.solve.onto_constraints import start_on_constraints
from derive.solve.sweep.vary import Spread

PLACES, RATES = "onto_places", "onto_rates"


@dataclass(frozen=True)
class Closing:
    """How members are brought to their start: attitudes to length one, then onto constraints.

    turned  : attitudes of which components vary        programs : of places first, then of rates
    moved   : components of the state that all this may change
    crowded : those among them that vary, and would follow nothing if there was more to move
    """

    turned: tuple[str, ...] = ()
    programs: tuple[Program, ...] = ()
    moved: tuple[str, ...] = ()
    crowded: tuple[str, ...] = ()

    @property
    def doubts(self) -> tuple[str, ...]:
        """Return a sentence on components that do not begin as they are drawn."""
        if not self.crowded:
            return ()
        says = f"{', '.join(self.crowded)} vary, and too little is left to fulfil the constraints"
        return (f"{says}: these are moved, too, and columns such as {self.crowded[0]}@0 tell how",)


def closing_of(library: Library, varied: Collection[str]) -> Closing:
    """Return how members begin, of which some components vary."""
    states = library.vocabulary.states
    turned = {
        q.name: q.components for q in states if q.is_quaternion and {*q.components} & {*varied}
    }
    if not library.scene.constraints:
        return Closing(tuple(turned), moved=tuple(c for own in turned.values() for c in own))
    held = homing_of(library, library[DISTANCES], library.constants)
    size = {c: (q.ends[1] - q.ends[0]) ** 2 for q in states for c in q.components}
    each = {PLACES: replace(held, rates=(), moving=_weighed(held.moving, size)),
            RATES: replace(held, places=(), driving=_weighed(held.driving, size))}  # fmt: skip
    lengths = {c for own in turned.values() for c in own}
    programs, moved = list[Program](), {*lengths}
    for name, whole in each.items():
        if not (whole.places or whole.rates):
            continue
        own = _without(whole, varied)
        rows = reaches(states, own)
        if _rank(rows) < len(rows):
            own, rows = whole, reaches(states, whole)
        programs.append(nearer(name, states, own))
        moved |= set[str]().union(*rows)
    kept = tuple(c for q in states for c in q.components if c in moved)
    crowded = tuple(c for c in kept if c in varied and c not in lengths)
    return Closing(tuple(turned), tuple(programs), kept, crowded)


def _weighed(names: Collection[str], size: Mapping[str, Fraction]) -> dict[str, Fraction]:
    return {c: size[c] for c in names}


def _without(held: Homing, names: Collection[str]) -> Homing:
    return replace(
        held,
        moving={c: w for c, w in held.moving.items() if c not in names},
        driving={c: w for c, w in held.driving.items() if c not in names},
    )


def _rank(rows: list[set[str]]) -> int:
    """Return how many conditions can each have a component of its own to be corrected by."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import structural_rank

    names = sorted(set[str]().union(*rows))
    there = np.array([[c in row for c in names] for row in rows], int).reshape(len(rows), -1)
    return int(structural_rank(csr_array(there))) if names else 0


def require_middle_near(
    found: Instrument, spreads: Collection[Spread], values: Mapping[str, float]
) -> None:
    """Raise SceneError if the member whose numbers are in their middles does not begin near by."""
    middles = {s.name: s.middle for s in spreads}
    try:
        start_on_constraints(found, {**values, **middles})
    except SceneError as refused:
        few = ", ".join(f"{name}={x:.6g}" for name, x in [*middles.items()][:MANY])
        raise SceneError(f"{refused}; so it is in the middle of what varies, {few}") from None
