"""Formulas that a scene gives names to: each written out, and in which scopes its name may stand.

A name may stand wherever all that it is made of may; formulas may use each other in any order, but
not in a circle.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from derive.scene.declaration import SceneError
from derive.scene.entries import FORMULA
from derive.scene.entry import Reading, entries_of
from derive.scene.escape import brief
from derive.scene.formula import Formula, symbols
from derive.scene.names import identifier
from derive.scene.scope import Scope, as_formula, check_symbols, without_names
from derive.scene.table import Table
from derive.scene.table import unit as unit_of
from derive.scene.unit import NONE, Dimension, UnitError, dimension_of, spelled


@dataclass(frozen=True)
class Named:
    """A formula with a name: as it is typed and written out, and the unit that it says to have."""

    name: str
    typed: Formula
    formula: Formula
    unit: Dimension | None
    meaning: str

    @property
    def label(self) -> str:
        """Return what a sentence calls it."""
        return f"formula '{self.name}'"


def read_named(given: Table) -> tuple[Named, ...]:
    """Return the named formulas of a scene file, each after those that it uses."""
    waiting = {key: _named(key, value) for key, value in given.entries.items()}
    found: dict[str, Named] = {}
    while waiting:
        ready = [n for n, one in waiting.items() if waiting.keys().isdisjoint(symbols(one.typed))]
        if not ready:
            raise SceneError(_circle(waiting))
        for name in ready:
            one = waiting.pop(name)
            meanings = {n: own.formula for n, own in found.items()}
            found[name] = replace(one, formula=without_names(one.typed, one.label, meanings))
    return tuple(found.values())


def _named(name: str, value: object) -> Named:
    label = f"formula '{identifier(name, 'a formula')}'"
    own = Table(label, value if isinstance(value, dict) else {"formula": value})
    said = entries_of(own, FORMULA, Reading())
    typed = as_formula(said["formula"], label)
    unit = unit_of(own) if "unit" in own.entries else None
    return Named(name, typed, typed, unit, said["meaning"] or "")


def _circle(waiting: Mapping[str, Named]) -> str:
    """Return the sentence on formulas that use each other in a circle."""
    chain = [next(iter(waiting))]
    while (used := _first(waiting, chain[-1])) not in chain:
        chain.append(used)
    circle = [*chain[chain.index(used) :], used]
    if len(circle) == 2:
        return f"formula '{used}' uses itself, '{brief(waiting[used].typed)}'"
    return f"formulas use each other in a circle: {', '.join(map(brief, circle))}"


def _first(waiting: Mapping[str, Named], name: str) -> str:
    return next(n for n in symbols(waiting[name].typed) if n in waiting)


def widened(scope: Scope, named: Iterable[Named]) -> Scope:
    """Return a scope with the names of formulas that are made of what may stand in it."""
    named = tuple(named)
    own = {one.name for one in named}
    dimensions = {n: d for n, d in scope.dimensions.items() if n not in own}
    others = {n: says for n, says in scope.others.items() if n not in own}
    meanings: dict[str, Formula] = {}
    for one in named:
        used = (*symbols(one.formula), *symbols(one.typed))  # a factor 0 leaves the rest out
        lacking = [name for name in used if name not in dimensions]
        if lacking:
            what = others.get(lacking[0], "which the scene does not declare")
            others[one.name] = f"a formula of '{brief(lacking[0])}', {what}"
        else:
            dimensions[one.name] = _dimension(one, dimensions)
            meanings[one.name] = one.formula
    return Scope(dimensions, others, scope.rule, meanings)


def _dimension(one: Named, dimensions: Mapping[str, Dimension]) -> Dimension:
    """Return the dimension of a formula; it must be that of its unit, if it says one."""
    try:
        found = dimension_of(one.typed, dimensions)
    except UnitError as error:
        raise SceneError(f"{one.label}: {error}") from None
    if one.unit is None:
        return found or NONE
    if found is not None and found != one.unit and one.typed.operator != "number":
        says = f"is in {spelled(found)}, not {spelled(one.unit)}"
        raise SceneError(f"{one.label} = '{brief(one.typed)}' {says}")
    return one.unit


def check_named(named: Iterable[Named], widest: Scope) -> None:
    """Refuse a formula of what may stand nowhere, in the scope of all that is known."""
    for one in named:
        check_symbols(one.typed, one.label, widest)


def named_told(named: Iterable[Named]) -> Iterator[str]:
    """Yield what each named formula stands for, one sentence each."""
    for one in named:
        says = f", {one.meaning}," if one.meaning else ""
        yield f"{one.name}{says} stands for {one.typed.as_written}."


def named_unused(named: Iterable[Named], text: str) -> Iterator[str]:
    """Yield a doubt about each formula whose name a file says once."""
    for one in named:
        if len(re.findall(rf"(?<![A-Za-z0-9_]){one.name}(?![A-Za-z0-9_])", text)) == 1:
            yield f"{one.label} is not used"
