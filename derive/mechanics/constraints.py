"""What must hold of a machine's motion, as scalars that are zero, with their rates.

Rates and second rates follow by differentiation; the last are linear in the accelerations. A force
pair at two points that meet, or a generalized force, enforces each.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from sympy import Expr, Integer, Matrix, Symbol

from derive.lecture.stated import by_law
from derive.mechanics.bodies import centre, centre_velocity
from derive.mechanics.frames import Frames, Located
from derive.scene import Input, SceneError
from derive.scene.constraint import Constraint, Meeting


@dataclass(frozen=True)
class Tie:
    """A scalar that is zero in every motion, its rate, and the rate that holds accelerations.

    place  : zero by where things are, None if the condition is of rates
    first  : zero by how things move          second : zero by how they accelerate
    factor : the unknown that enforces it, None if a load that the user declared does
    """

    name: str
    says: str
    place: Expr | None
    first: Expr
    second: Expr
    factor: Symbol | None
    generalized: bool = False


def ties(frames: Frames) -> tuple[Tie, ...]:
    """Return all that the constraints of a machine ask for, one scalar each."""
    return tuple(c for one in frames.machine.constraints for c in _conditions(frames, one))


def _conditions(frames: Frames, one: Constraint) -> Iterator[Tie]:
    sheet = frames.sheet
    if one.meeting is None:
        value = frames.words.expression(one.zero)
        factor = sheet.symbols[one.factor] if one.factor else None
        yield _made(frames, one.name, one, (value, one.of_rates), factor, generalized=True)
        return
    meeting = one.meeting
    column = _velocities(frames, meeting) if one.of_rates else _places(frames, one.name, meeting)
    for axis, direction in zip(meeting.axes, meeting.directions, strict=True):
        own = sheet.symbols.get(f"{one.name}_{axis}") if one.load == one.name else None
        name = f"{one.name} along {axis}"
        along = (frames.words.column(direction).T * column)[0]
        yield _made(frames, name, one, (along, one.of_rates), own)


def _made(
    frames: Frames, name: str, one: Constraint, value: tuple[Expr, bool], factor: Symbol | None,
    *, generalized: bool = False,
) -> Tie:  # fmt: skip
    sheet, (own, of_rates) = frames.sheet, value
    try:
        first = own if of_rates else sheet.rate(own)
        second = sheet.rate(first)
    except SceneError as error:
        raise SceneError(f"constraint '{one.name}': {error}") from None
    if first.free_symbols & sheet.unknowns:
        raise SceneError(f"constraint '{one.name}' holds an acceleration; it must be of rates")
    return Tie(name, one.name, None if of_rates else own, first, second, factor, generalized)


def _places(frames: Frames, name: str, meeting: Meeting) -> Matrix:
    """Return the vector from one point to the other, along the axes of the meeting."""
    here = (meeting.frame, frames.words.column(meeting.at))
    there = (meeting.to_frame, frames.words.column(meeting.to))
    try:
        return frames.apart(there, here, meeting.along)
    except SceneError as error:
        raise SceneError(f"constraint '{name}': {error}") from None


def _velocities(frames: Frames, meeting: Meeting) -> Matrix:
    """Return the velocity of one body's particle beside the other's, along the meeting's axes."""
    on = _particle(frames, meeting.on, (meeting.frame, frames.words.column(meeting.at)))
    found = frames.carried(on, frames.own(meeting.on), meeting.along)
    if meeting.against:
        there = (meeting.to_frame, frames.words.column(meeting.to))
        other = _particle(frames, meeting.against, there)
        found = found - frames.carried(other, frames.own(meeting.against), meeting.along)
    return found


def _particle(frames: Frames, body: str, place: Located) -> Matrix:
    """Return the velocity of a body's particle at a place, along the body's own axes."""
    own = frames.own(body)
    known = {
        "rho_i": frames.apart(centre(frames, body), place, own),
        "omega": frames.turning_of_body(body),
    }
    return centre_velocity(frames, body) + by_law("velocity_of_particle", known)


@dataclass
class Partials:
    """How velocities change with the rates of what moves, through all that is named."""

    frames: Frames

    def __post_init__(self) -> None:
        """Begin with nothing remembered."""
        self._known: dict[tuple[Symbol, Symbol], Expr] = {}

    @cached_property
    def rates(self) -> dict[str, Symbol]:
        """Return the rates that motion is made of, by what moves: of coordinates, and speeds."""
        machine, symbols = self.frames.machine, self.frames.sheet.symbols
        found = {c.name: symbols[c.rate.name] for c in machine.coordinates
                 if isinstance(c.rate, Input)}  # fmt: skip
        return found | {s.name: symbols[s.name] for s in machine.speeds}

    def by(self, value: Expr, rate: Symbol) -> Expr:
        """Return the slope of a velocity by a rate."""
        return sum(
            (value.diff(s) * slope
             for s in sorted(value.free_symbols, key=str) if (slope := self._of(s, rate)) != 0),
            Integer(0),
        )  # fmt: skip

    def of_column(self, values: Matrix, rate: Symbol) -> Matrix:
        """Return the slopes of a column's components."""
        return values.applyfunc(lambda value: self.by(value, rate))

    def _of(self, symbol: Symbol, rate: Symbol) -> Expr:
        if symbol == rate:
            return symbol / symbol
        key = (symbol, rate)
        if key not in self._known:
            sheet = self.frames.sheet
            own = sheet.definitions.get(symbol)
            slope = self.by(own, rate) if own is not None else 0 * symbol
            label = f"{sheet.label(symbol)}.by.{sheet.label(rate)}"
            self._known[key] = sheet.named(label, slope) if own is not None else slope
        return self._known[key]


def symbols_held(held: Sequence[Tie]) -> frozenset[Symbol]:
    """Return all that the second rates of conditions hold, and what enforces them."""
    found = {s for c in held for s in c.second.free_symbols}
    return frozenset(found | {c.factor for c in held if c.factor is not None})


def curved(frames: Frames, value: Expr) -> bool:
    """Tell whether a value is no line in the rates that it is of."""
    by = Partials(frames)
    slopes = [by.by(value, rate) for rate in by.rates.values()]
    return any(by.by(slope, rate) != 0 for slope in slopes for rate in by.rates.values())
