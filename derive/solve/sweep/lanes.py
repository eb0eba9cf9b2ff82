"""Members side by side, a lane each: their state moved by steps, their answers, some of them apart.

A state lies in places by turns: after the last step, before it, and before the step before that
one. Which lane a member has changes no bit of it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.program import Program, Quantity
from derive.scene.formula import Arithmetic, evaluate
from derive.scene.functions import FUNCTIONS, PLAIN
from derive.solve.sweep.kit import ByMembers
from derive.solve.sweep.plan import SweepPlan
from derive.solve.sweep.vary import FloatColumn, by_python

COLUMNS: Arithmetic = {
    "number": float,
    **PLAIN,
    "power": lambda base, exponent: base**exponent,
    **{name: lambda x, own=row.floats: by_python(own, x) for name, row in FUNCTIONS.items()},
    "sqrt": np.sqrt,
}
"""Formulas over members: what NumPy rounds as every machine does, else Python's functions."""
ROUNDS = 60
"""Until a start that comes nearer to the constraints must be on them."""
CLOSE = 1e-22
"""The square of a distance, in parts of ranges, from which one more correction leaves rounding."""
ByQuantity = dict[str, NDArray[Any]]
"""(components, lanes) of each quantity."""


@dataclass
class Lanes:
    """Members on their way.

    ids   : of each lane, its member                constants : for all, or of each lane a column
    alone : by component what is held, a number or (lanes,)        held : the same by quantity
    state : after the last steps, a place each      turn : which of them is now
    """

    by: ByMembers
    library: Library
    plan: SweepPlan
    ids: NDArray[np.int64]
    constants: NDArray[Any] | None
    alone: dict[str, Any]
    held: ByQuantity
    state: tuple[ByQuantity, ...]
    turn: int = 0
    calls: dict[tuple[str, int], tuple[Callable[[float], None], list[Any]]] = field(
        default_factory=dict
    )
    fresh: dict[str, list[Any]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.ids)

    @property
    def now(self) -> ByQuantity:
        """Return the state as it is."""
        return self.state[self.turn]

    @property
    def before(self) -> ByQuantity:
        """Return the state before the last step."""
        return self.state[self.turn - 1]

    @property
    def earlier(self) -> ByQuantity:
        """Return the state before the last two steps."""
        return self.state[self.turn - 2]

    def on(self, length: float, count: int = 1) -> None:
        """Take so many steps, each of so many seconds."""
        places = len(self.state)
        for _ in range(count):
            call, _results = self._prepared(self.plan.step, self._following)
            call(length)
            self.turn = (self.turn + 1) % places
        self.fresh.clear()

    def undo(self) -> None:
        """Be where all were before the last step."""
        self._go(self.turn - 1)

    def here(self) -> ByQuantity:
        """Return the state as it is, of its own."""
        return {name: x.copy() for name, x in self.now.items()}

    def to(self, state: ByQuantity, which: NDArray[np.bool_]) -> None:
        """Take some lanes to a state."""
        for name, place in self.now.items():
            place[:, which] = state[name][:, which]
        self.fresh.clear()

    @property
    def _following(self) -> ByQuantity:
        return self.state[(self.turn + 1) % len(self.state)]

    def _go(self, turn: int) -> None:
        self.turn = turn % len(self.state)
        self.fresh.clear()

    def onto(self) -> NDArray[np.bool_]:
        """Bring the lanes onto the constraints; tell which of them could be.

        Each stays where it is once it is there, so no lane changes what becomes of another.
        """
        right = np.ones(len(self), bool)
        for name in self.plan.onto:
            there = np.zeros(len(self), bool)
            for _ in range(ROUNDS):
                off = self._called(name, 0.0, self._following)[-1][0]
                for of, place in self._following.items():
                    place[:, there] = self.now[of][:, there]
                self._go(self.turn + 1)
                there |= off < CLOSE * self._square_of_size()
                if (there | ~np.isfinite(off)).all():
                    break
            right &= there
        return right

    def parts_from(self, state: ByQuantity) -> FloatColumn:
        """Return how far each lane is from a state, in parts of the declared ranges."""
        found = np.zeros(len(self))
        for q in self.library.vocabulary.states:
            wide = float(q.ends[1] - q.ends[0])
            np.maximum(
                found, np.abs(self.now[q.name] - state[q.name]).max(axis=0) / wide, out=found
            )
        return found

    def _square_of_size(self) -> FloatColumn:
        """Return the largest component of each lane in parts of its range, squared, above one."""
        found = np.ones(len(self))
        for q in self.library.vocabulary.states:
            wide = float(q.ends[1] - q.ends[0])
            np.maximum(found, ((self.before[q.name] / wide) ** 2).max(axis=0), out=found)
        return found

    def value(self, component: str) -> Any:
        """Return a component of the state, an answer, or what is held: (lanes,) or a number."""
        for q in self.library.vocabulary.states:
            if component in q.components:
                return self.now[q.name][q.components.index(component)]
        if component in self.plan.answers:
            return self._answer(component, self.plan.answers[component])
        return self.alone[component]

    def residual(self) -> FloatColumn:
        """Return what is zero when the event happens."""
        stop = self.plan.stop
        if stop is None:
            raise ValueError("nothing stops these members")
        found = evaluate(stop.left, _Read(self), COLUMNS)
        whole: FloatColumn = np.array(np.broadcast_to(found, len(self)), dtype=np.float64)
        return whole

    def are_finite(self) -> NDArray[np.bool_]:
        """Tell of which lanes the state is made of numbers."""
        found = np.ones(len(self), bool)
        for place in self.now.values():
            found &= np.isfinite(place).all(axis=0)
        return found

    def chosen(
        self, which: NDArray[np.bool_], state: ByQuantity | None = None, back: int = 0
    ) -> "Lanes":
        """Return some lanes alone, in the state that they are in, or in another.

        back : how many states before it are taken along
        """

        def own(x: Any) -> Any:
            there = isinstance(x, np.ndarray) and x.shape[-1:] == which.shape and x.ndim > 0
            return np.ascontiguousarray(x[..., which]) if there else x

        of = self.now if state is None else state
        each = [of, *(self.state[self.turn - k] for k in range(1, back + 1))]
        places = places_for([{n: own(x) for n, x in one.items()} for one in each], len(self.state))
        lone = self.constants is None or self.constants.ndim == 1
        return Lanes(
            self.by, self.library, self.plan, self.ids[which],
            self.constants if lone else own(self.constants),
            {n: own(x) for n, x in self.alone.items()},
            {n: own(x) for n, x in self.held.items()}, places,
        )  # fmt: skip

    def beside(self, more: Sequence["Lanes"]) -> "Lanes":
        """Return these members with others of the same plan, in the states that they are in."""
        every = [self, *more]

        def all_of(each: Sequence[Any], like: Any) -> Any:
            return np.concatenate(each, axis=-1) if isinstance(like, np.ndarray) else like

        first = {n: all_of([o.now[n] for o in every], x) for n, x in self.now.items()}
        lone = self.constants is None or self.constants.ndim == 1
        return Lanes(
            self.by, self.library, self.plan, np.concatenate([o.ids for o in every]),
            self.constants if lone else all_of([o.constants for o in every], self.constants),
            {n: all_of([o.alone[n] for o in every], x) for n, x in self.alone.items()},
            {n: all_of([o.held[n] for o in every], x) for n, x in self.held.items()},
            places_for([first], len(self.state)),
        )  # fmt: skip

    def _answer(self, component: str, function: str) -> Any:
        if function not in self.fresh:
            self.fresh[function] = self._called(function, 0.0, {})
        for q, found in zip(self.library[function].outputs, self.fresh[function], strict=True):
            if component in q.components:
                return found[q.components.index(component)]
        raise KeyError(component)

    def _called(self, function: str, length: float, into: ByQuantity) -> list[Any]:
        call, results = self._prepared(function, into)
        call(length)
        return results

    def _prepared(
        self, function: str, into: ByQuantity
    ) -> tuple[Callable[[float], None], list[Any]]:
        """Return a call from the state where it is now, and the room for its results."""
        key = (function, self.turn)
        if key not in self.calls:
            program = self.library[function]
            found = [self._room(q, into) for q in program.outputs]
            given = self.held | self.now
            made = self.by.call(function, self._read_by(program), given, found, len(self))
            self.calls[key] = made, found
        return self.calls[key]

    def _room(self, q: Quantity, into: ByQuantity) -> NDArray[Any]:
        place = into.get(q.name.removesuffix("_next"))
        return np.zeros((len(q.components), len(self))) if place is None else place

    def _read_by(self, program: Program) -> NDArray[Any] | None:
        reads = any(q.role == "constants" for q in program.inputs)
        return self.constants if reads else None


class _Read(dict[str, Any]):
    """What a formula asks lanes for, by name."""

    def __init__(self, lanes: Lanes) -> None:
        self.lanes = lanes

    def __contains__(self, name: object) -> bool:
        return name != "pi"

    def __getitem__(self, name: str) -> Any:
        return self.lanes.value(name)


def places_for(there: Sequence[ByQuantity], count: int) -> tuple[ByQuantity, ...]:
    """Return room for so many states: one, those before it from the last place on, nothing."""
    none = ({n: np.zeros_like(x) for n, x in there[0].items()} for _ in range(count - len(there)))
    return there[0], *none, *reversed(there[1:])
