"""Every answer of a scene at given values: its functions, steady motions, small motions."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite

from derive.scene import DeriveError, Input, SceneError
from derive.scene.machine import LEFT_OVER, Steady
from derive.scene.unit import behind
from derive.scene.wanted import moves
from derive.solve.instrument import Instrument
from derive.solve.motions import SmallMotion, roots, small_motion

Lasting = Mapping[str, Mapping[str, float]]
"""Values in steady motions, by what each is called."""


@dataclass(frozen=True)
class AnswerRow:
    """One value: of which function or motion it is, what it is called, its unit."""

    of: str
    name: str
    value: float
    unit: str


class AnswerError(DeriveError, KeyError):
    """An answer that there is not, or of which there are several."""

    def __str__(self) -> str:
        """Return the sentence, which a KeyError would put in quotation marks."""
        return str(self.args[0])


@dataclass(frozen=True, repr=False)
class Answered:
    """What a scene answers at given values, and what it cannot answer without further ones.

    unanswered : of each function without answer, the components that are not set
    doubts     : warnings about the values, of inertias that no masses have and the like
    """

    rows: tuple[AnswerRow, ...]
    unanswered: Mapping[str, tuple[str, ...]]
    doubts: tuple[str, ...]

    def __getitem__(self, name: str) -> float:
        """Return the value of an answer. Raises AnswerError if there is none, or several differ."""
        values = [*dict.fromkeys(self.all(name))]
        if len(values) == 1:
            return values[0]
        found = f"{len(values)} values; see rows" if values else "no answer"
        raise AnswerError(f"'{name}' has {found}")

    def all(self, name: str) -> tuple[float, ...]:
        """Return every value of an answer, of several steady motions one each."""
        return tuple(row.value for row in self.rows if row.name == name)

    def __repr__(self) -> str:
        """Return the answers as a table, with units."""
        of, name = (max((len(getattr(row, key)) for row in self.rows), default=0)
                    for key in ("of", "name"))  # fmt: skip
        lines = [f"{row.of:{of}}  {row.name:{name}}  {row.value:.12g}{behind(row.unit)}"
                 for row in self.rows]  # fmt: skip
        lines += [f"{each} needs {', '.join(names)}" for each, names in self.unanswered.items()]
        return "\n".join([*lines, *(f"warning: {doubt}" for doubt in self.doubts)])


def every_answer(found: Instrument, values: Mapping[str, float]) -> Answered:
    """Return all that the values of components let a scene answer.

    What only the unknowns of steady motion are missing for is answered at every root of it. Steps
    in time are answers of no instant: a simulation takes them.
    Raises SceneError for values without an answer.
    """
    rows: list[AnswerRow] = []
    unanswered: dict[str, tuple[str, ...]] = {}
    scene = found.library.scene
    lasting = _lasting(found, values)
    motions = {said: own for each in lasting.values() for said, own in each.items()}
    sought = {c for name in lasting for c in _sought(found, name, values)}
    for name in scene.wanted:
        missing = _missing(found, name, values)
        if name in lasting:
            rows.extend(_found(found, name, lasting[name]))
        elif missing and (own := _enough(motions, missing)):
            rows.extend(() if moves(name) else _at_each(found, name, own))
        elif missing:
            unanswered[name] = tuple(c for c in missing if c not in sought) or missing
        elif not moves(name):
            rows.extend(_rows(found, name, values))
    each: Sequence[Mapping[str, float]] = [*motions.values()] or [values]
    doubts = dict.fromkeys(doubt for own in each for doubt in found.doubts(own))
    nowhere = [_nowhere(scene.steady[name]) for name, own in lasting.items() if not own]
    return Answered(tuple(rows), unanswered, (*doubts, *nowhere))


def _lasting(found: Instrument, values: Mapping[str, float]) -> dict[str, Lasting]:
    scene = found.library.scene
    return {name: own for name in scene.wanted if name in scene.steady
            if (own := _steady_motions(found, name, values)) is not None}  # fmt: skip


def motions_around(found: Instrument, values: Mapping[str, float]) -> list[Mapping[str, float]]:
    """Return the values of all motions that small ones are around: as given, or each steady one."""
    asked = "linearised" in found.library.scene.wanted
    missing = _missing(found, "linearised", values) if asked else ()
    if not missing:
        return [values]
    lasting = _lasting(found, values).values()
    motions = {said: own for each in lasting for said, own in each.items()}
    every = [*_enough(motions, missing).values()]
    return every if every or motions or any(not own for own in lasting) else [values]


def small_motion_of(found: Instrument, values: Mapping[str, float]) -> SmallMotion:
    """Return small motion around the only motion that values tell.

    Raises SceneError where there are several, or none.
    """
    each = motions_around(found, values)
    if len(each) != 1:
        says = f"small motion is around one steady motion; with these values there are {len(each)}"
        raise SceneError(f"scene '{found.name}': {says}: `solve` tells of all")
    return small_motion(found, each[0])


def _enough(motions: Lasting, missing: Iterable[str]) -> Lasting:
    """Return the steady motions that have all that is missing."""
    return {said: own for said, own in motions.items() if own.keys() >= {*missing}}


def _steady_motions(found: Instrument, name: str, values: Mapping[str, float]) -> Lasting | None:
    """Return the values with each root of a steady motion, None if none is to be found yet."""
    sought = _sought(found, name, values)
    if not sought or _missing(found, name, values):
        return None
    said = "steady motion" if name == "steady" else f"{name}, motion"
    still = dict.fromkeys(sought, 0.0)
    return {f"{said} {number}": {**still, **values, **root}
            for number, root in enumerate(roots(found, values, name), 1)}  # fmt: skip


def _sought(found: Instrument, name: str, values: Mapping[str, float]) -> tuple[str, ...]:
    """Return what a steady motion says that is to be found: its unknowns, rates that are 0 in it.

    Free coordinates rest where what vanishes is a balance.
    """
    scene = found.library.scene
    steady = scene.steady[name]
    if all(n in values for n in steady.unknown):
        return ()
    rates = [c.rate.name for c in scene.coordinates if c.free and isinstance(c.rate, Input)]
    return (*steady.unknown, *(() if steady.vanishes else rates))


def _found(found: Instrument, name: str, motions: Lasting) -> Iterator[AnswerRow]:
    unit = {c: q.unit for q in found.quantities() for c in q.components}
    for said, motion in motions.items():
        for unknown in found.library.scene.steady[name].unknown:
            yield AnswerRow(said, unknown, motion[unknown] + 0.0, unit[unknown])  # no -0


def _nowhere(steady: Steady) -> str:
    """Return the sentence on a steady motion that was looked for and is nowhere."""
    names = " and ".join(f"'{name}'" for name in steady.unknown)
    return f"no steady motion was found in the declared range of {names}"


def _at_each(found: Instrument, name: str, motions: Lasting) -> Iterator[AnswerRow]:
    """Yield what a function answers in every steady motion."""
    for said, motion in motions.items():
        for row in _rows(found, name, motion):
            yield replace(row, of=f"{row.of} in {said}")


def _missing(found: Instrument, name: str, values: Mapping[str, float]) -> tuple[str, ...]:
    steady = found.library.scene.steady.get(name)
    given = (*values, *(steady.unknown if steady else ()))
    lacking = [c for c in found.needed(name.removesuffix("_jacobian")) if c not in given]
    known = {c for q in found.quantities() for c in q.components}
    return tuple(c for c in lacking if c in known or not moves(name))


def _rows(found: Instrument, name: str, values: Mapping[str, float]) -> Iterator[AnswerRow]:
    units = {c: q.unit for q in found.library[name].outputs for c in q.components}
    for component, value in found.answer(name, values).items():
        if not isfinite(value):
            raise SceneError(
                f"scene '{found.name}': '{name}' must be finite, but with these values "
                f"{component} is {value}"
            )
        shown = f"{component}, {LEFT_OVER}" if name in found.library.scene.steady else component
        yield AnswerRow(name, shown, value + 0.0, units[component])  # no -0
    if name == "linearised":
        small = small_motion(found, values)
        for number, value in enumerate(small.frequencies, 1):
            yield AnswerRow("small motion", f"frequency {number}", value, "rad/s")
        yield AnswerRow("small motion", "growth", small.growth, "1/s")
