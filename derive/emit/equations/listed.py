"""The list of symbols: each that stands in an equation once, with its unit and its meaning."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from sympy import Symbol

from derive.emit.equations.called import meaning_called
from derive.emit.equations.dimensions import joined_dimensions, raised_dimension
from derive.emit.equations.lettered import decimal_value
from derive.emit.equations.naming import label_between
from derive.emit.equations.section import Section
from derive.library.library import Library
from derive.program.program import Quantity
from derive.scene import Scene
from derive.scene.results import MATRICES
from derive.scene.unit import Dimension, dimension, spelled

IN_OWN_UNITS = ", each in its own unit"


@dataclass(frozen=True)
class Listed:
    """Symbols with one unit and one meaning: their names, and how these are written."""

    names: tuple[str, ...]
    shown: tuple[str, ...]
    unit: str
    meaning: str
    style: str = "scalar"


def listed(
    known: Library, sections: Sequence[Section], values: Mapping[str, Fraction]
) -> Iterator[Listed]:
    """Yield what is told of every symbol: those of the scene first, then what stands between.

    values : of parameters that are letters
    """
    rows = [row for one in sections for row in _of_scene(known, one, values)]
    listed_: set[str] = set()
    kept: dict[int, Listed] = {}
    for place in sorted(range(len(rows)), key=lambda k: (-len(rows[k].names), k)):
        row = rows[place]
        new = [k for k, name in enumerate(row.names) if name not in listed_]
        if new:
            names, shown = ([each[k] for k in new] for each in (row.names, row.shown))
            kept[place] = replace(row, names=tuple(names), shown=tuple(shown))
            listed_ |= {*names}
    yield from (kept[place] for place in sorted(kept))
    for one in sections:
        for row in _between(known, one):
            if row.names[0] not in listed_:
                listed_.add(row.names[0])
                yield row


def _of_scene(known: Library, one: Section, values: Mapping[str, Fraction]) -> Iterator[Listed]:
    """Yield rows for the quantities of a scene that stand in a section."""
    own = known.mechanism.posed(one.name)
    symbols = own.words.sheet.symbols
    for q in own.vocabulary.every():
        used = [(c, s) for c in q.components
                if (s := one.answers.get(c, symbols[c])) in one.names]  # fmt: skip
        units = [_unit(own.scene, q, c) for c, _ in used]
        for unit in dict.fromkeys(units):
            each = [s for (_, s), its in zip(used, units, strict=True) if its == unit]
            names = tuple(one.names[s] for s in each)
            meaning = q.meaning.removesuffix(IN_OWN_UNITS) + _more(q, one, each, values)
            yield Listed(names, tuple(one.shown[s] for s in each), unit, meaning)


def _more(q: Quantity, one: Section, each: Iterable[Symbol], values: Mapping[str, Fraction]) -> str:
    """Return what is added to a meaning: a value, and the scene's word for a letter."""
    value = f" = {decimal_value(values[q.name])}" if q.name in values else ""
    words = [one.names[s] for s in each if "_" not in one.names[s]
             and one.names[s] not in one.shown[s].split("_")
             and len(one.names[s]) > 1]  # fmt: skip
    return value + (f", '{words[0]}' in the scene" if words else "")


def _between(known: Library, one: Section) -> Iterator[Listed]:
    """Yield rows for what equations name on the way."""
    for symbol, name in one.names.items():
        if symbol not in one.called:
            unit = spelled(one.units[symbol]) if symbol in one.units else "1"
            meaning = meaning_called(label_between(one, symbol), known.scene.spoken)
            yield Listed((name,), (one.shown[symbol],), unit, meaning)


def _unit(scene: Scene, q: Quantity, component: str) -> str:
    """Return the unit of a component, entries of matrices of small motion by what they join."""
    if q.unit or q.name not in MATRICES:
        return q.unit or "1"
    row, column = (int(n) - 1 for n in component.rsplit("_", 2)[1:])
    speeds = [
        _speed(m.unit, m.kind)
        for m in (*scene.coordinates, *scene.speeds)
        if m.free and not m.dependent
    ]
    power = joined_dimensions(dimension("W"), raised_dimension(speeds[row], Fraction(-1)))
    per = joined_dimensions(power, raised_dimension(speeds[column], Fraction(-1)))
    order = {"mass_matrix": 1, "damping_matrix": 0, "stiffness_matrix": -1}[q.name]
    return spelled(joined_dimensions(per, raised_dimension(dimension("s"), Fraction(order))))


def _speed(unit: str, kind: str) -> Dimension:
    each = dimension(unit)
    return joined_dimensions(each, dimension("1/s")) if kind == "coordinate" else each
