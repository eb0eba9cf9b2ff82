"""Every answer of a scene at given values: its functions, steady motions, small motions."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite

from derive.scene import SceneError
from derive.scene.machine import LEFT_OVER
from derive.scene.unit import behind
from derive.solve.instrument import Instrument
from derive.solve.motions import roots, small_motion


@dataclass(frozen=True)
class AnswerRow:
    """One value: of which function or motion it is, what it is called, its unit."""

    of: str
    name: str
    value: float
    unit: str


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
        """Return the value of an answer. Raises KeyError if there is none, or more than one."""
        (value,) = self.all(name) if len(self.all(name)) == 1 else (None,)
        if value is None:
            found = f"{len(self.all(name))} values; see rows" if self.all(name) else "no answer"
            raise KeyError(f"'{name}' has {found}")
        return value

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

    Raises SceneError for values without an answer.
    """
    rows: list[AnswerRow] = []
    unanswered: dict[str, tuple[str, ...]] = {}
    for name in found.library.scene.wanted:
        missing = _missing(found, name, values)
        if missing:
            unanswered[name] = missing
        else:
            rows.extend(_rows(found, name, values))
    return Answered(tuple(rows), unanswered, found.doubts(values))


def _unknowns(found: Instrument, name: str, values: Mapping[str, float]) -> tuple[str, ...]:
    """Return the unknowns of a steady motion that is to be found; none if they are all set."""
    scene = found.library.scene
    steady = scene.steady if name == "steady" else None
    return () if steady is None or all(n in values for n in steady.unknown) else steady.unknown


def _missing(found: Instrument, name: str, values: Mapping[str, float]) -> tuple[str, ...]:
    given = (*values, *_unknowns(found, name, values))
    return tuple(c for c in found.needed(name.removesuffix("_jacobian")) if c not in given)


def _rows(found: Instrument, name: str, values: Mapping[str, float]) -> Iterator[AnswerRow]:
    if _unknowns(found, name, values):
        unit = {c: q.unit for q in found.quantities() for c in q.components}
        for number, root in enumerate(roots(found, values), 1):
            for unknown, value in root.items():
                yield AnswerRow(f"steady motion {number}", unknown, value + 0.0, unit[unknown])
        return
    units = {c: q.unit for q in found.library[name].outputs for c in q.components}
    for component, value in found.answer(name, values).items():
        if not isfinite(value):
            raise SceneError(
                f"scene '{found.name}': '{name}' must be finite, but with these values "
                f"{component} is {value}"
            )
        shown = f"{component}, {LEFT_OVER}" if name == "steady" else component
        yield AnswerRow(name, shown, value + 0.0, units[component])  # no -0
    if name == "linearised":
        small = small_motion(found, values)
        for number, value in enumerate(small.frequencies, 1):
            yield AnswerRow("small motion", f"frequency {number}", value, "rad/s")
        yield AnswerRow("small motion", "growth", small.growth, "1/s")
