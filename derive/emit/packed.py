"""A scene's motion as solvers take it: all states as x, all inputs as u, all parameters as p.

The same names, units, ranges and scales stand in the CasADi module and in the JSON.
"""

from dataclasses import dataclass

from derive.library.external import STEPS, step_inputs
from derive.library.library import Library
from derive.program.program import Program, Quantity, placed


@dataclass(frozen=True)
class Packed:
    """What x, u and the parameters hold, and the functions that are packed, None where none is."""

    states: tuple[Quantity, ...]
    inputs: tuple[Quantity, ...]
    parameters: tuple[Quantity, ...]
    rate: Program
    step: Program | None

    def given(self) -> tuple[Quantity, ...]:
        """Return all quantities, states first."""
        return self.states + self.inputs + self.parameters

    def attitudes(self) -> list[int]:
        """Return where quaternions begin among the states' components."""
        return [place.start for q, place in placed(self.states) if q.is_quaternion]


def packed(library: Library) -> Packed | None:
    """Return what is packed of a scene; None for one whose rates nobody asked for."""
    known = {p.name: p for p in (*library.printed(), *library.rates)}
    if "state_rate" not in known:
        return None
    step = next((known[name] for name in (*STEPS, "step_lie") if name in known), None)
    return Packed(
        library.vocabulary.states,
        step_inputs(library),
        library.setup.inputs if library.constants else (),
        known["state_rate"],
        step,
    )


def range_of(q: Quantity) -> tuple[float, float]:
    """Return the range of each component, of an attitude -1 to 1."""
    low, high = (-1, 1) if q.is_quaternion else q.ends
    return float(low), float(high)


def scale_of(q: Quantity) -> float:
    """Return what a component is divided by to be about 1: the largest size in its range."""
    return max(map(abs, range_of(q)))
