"""A balance of forces or moments of some bodies, and its values at trial points."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from numpy.typing import NDArray

from derive.mechanics.frames import Located
from derive.mechanics.own_axes import frame_called
from derive.mechanics.probe import NOTHING, PROBES
from derive.mechanics.sheet import AXES


@dataclass(frozen=True)
class Balance:
    """One equation: bodies cut free, force or moment about a point, along an axis of a frame."""

    bodies: tuple[str, ...]
    kind: Literal["force", "moment", "constraint", "virtual power"]
    point: Located | None
    spot: str
    frame: str
    axis: str
    central: bool = False  # about the mass centre of its one body, whatever the spot is called

    def __str__(self) -> str:
        return self.told({})

    def told(self, spoken: Mapping[str, str]) -> str:
        """Return the balance in words; ``spoken`` has those for what the user gave no names."""
        if self.kind == "constraint":
            return f"second rate of constraint {self.spot}"
        if self.kind == "virtual power":
            return f"virtual power of all bodies by the rate of {self.spot}"
        about = f" about {spoken.get(self.spot, self.spot)}" if self.kind == "moment" else ""
        frame = spoken.get(self.frame, f"of {frame_called(self.frame)}")
        along = f"{self.axis} {frame}".rstrip()
        along = along if self.axis in AXES else f"the axis of {self.axis}"
        bodies = " + ".join(spoken.get(body, body) for body in self.bodies)
        return f"{self.kind} on {bodies}{about} along {along}"


@dataclass(frozen=True, eq=False)
class ValuedBalance:
    """A balance with its coefficients at each trial point: the rest first, then the unknowns.

    The last point is at rest, where what is independent elsewhere may not be.

    outboard : whether it is of all that a frame carries
    """

    balance: Balance
    values: tuple[NDArray[Any], ...]
    outboard: bool = False

    @cached_property
    def holds(self) -> frozenset[int]:
        """Return which unknowns enter."""
        found = set()
        for row in self.values[:PROBES]:
            size = max(abs(x) for x in row)
            found |= {k - 1 for k, x in enumerate(row) if k and abs(x) > NOTHING * size}
        return frozenset(found)

    @cached_property
    def empty(self) -> bool:
        """Tell whether nothing is left: the balance holds by itself."""
        return all(max(abs(x) for x in row) <= NOTHING for row in self.values[:PROBES])

    @property
    def lasts(self) -> bool:
        """Tell whether it still says something where nothing but a steady motion is left."""
        rest = self.values[-1]
        return bool(abs(rest[0]) > NOTHING * max(map(abs, rest)))
