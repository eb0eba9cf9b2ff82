"""The steady motions of a scene: what is to be found in each, and what vanishes in it.

``[steady]`` is one, a function of that name; ``[steady.slow]`` is one of several, ``steady_slow``.
"""

from collections.abc import Mapping

from derive.scene.declaration import SceneError
from derive.scene.entries import STEADY
from derive.scene.entry import Reading, entries_of
from derive.scene.formula import Formula
from derive.scene.machine import Result, Steady, Unknown
from derive.scene.names import label
from derive.scene.results import answer_units, of_any_unit, written_out
from derive.scene.scalars import Scalars
from derive.scene.scope import Scope
from derive.scene.table import Table, several, table
from derive.scene.unit import BESIDE_SI, dimension, spelled


def steady_names(given: Table) -> tuple[str, ...]:
    """Return the functions of the steady motions that a file declares."""
    return tuple(_tables(given))


def steady_parts(function: str, count: int) -> tuple[str, ...]:
    """Return the components of a function that vanishes: one for each unknown."""
    return tuple(f"{function}_{n + 1}" for n in range(count)) if count > 1 else (function,)


def _tables(given: Table) -> dict[str, Table]:
    """Return the table of each steady motion, by its function."""
    if not given.entries or not all(isinstance(own, dict) for own in given.entries.values()):
        return {"steady": given} if given.entries else {}
    return {
        f"steady_{label(name, 'a steady motion')}": table(own, f"steady.{name}")
        for name, own in given.entries.items()
    }


def read_steady(
    given: Table,
    scalars: Scalars,
    unknowns: tuple[Unknown, ...],
    results: tuple[Result, ...],
    asked: Mapping[str, tuple[str, ...]],
) -> Mapping[str, Steady]:
    """Return the steady motions of a scene file, by their functions."""
    tables = _tables(given)
    if "steady" not in tables and any("steady" in answers for answers in asked.values()):
        told = f" (known: {', '.join(tables)})" if tables else ""
        raise SceneError(f"wanted has 'steady', which needs [steady] with its unknown{told}")
    answers = answer_units(scalars, unknowns) | {
        r.name: dimension(r.unit) for r in results if r.unit not in BESIDE_SI
    }
    known = scalars.known
    both = Scope(dict(known.dimensions) | answers, {}, "", known.meanings)
    return {name: _steady(own, scalars, both, results) for name, own in tables.items()}


def _steady(given: Table, scalars: Scalars, both: Scope, results: tuple[Result, ...]) -> Steady:
    entries_of(given, STEADY, Reading())
    if given.entries["unknown"] == []:
        raise SceneError(
            f"{given.of('unknown')} is an empty list; it must name what is to be found"
        )
    fixed = {"pi", *(p.name for p in scalars.parameters if p.value is not None)}
    scalar = [n for n in scalars.known.dimensions if n not in {*fixed, *scalars.known.meanings}]
    names = several(given.entries["unknown"], given.of("unknown"), scalar)
    says, what = given.entries.get("vanishes", []), given.of("vanishes")
    if "vanishes" not in given.entries:
        return Steady(names, (), "")
    each = says if isinstance(says, list) else [says]
    if len(each) != len(names):
        rule = f"{len(names)} formulas that vanish" if len(names) > 1 else "1 formula that vanishes"
        raise SceneError(f"{what} must be {rule}, one for each unknown, not {len(each)}")
    found = [_vanishing(one, what, both, results) for one in each]
    units = dict.fromkeys(unit for _, unit in found)
    return Steady(names, tuple(f for f, _ in found), "" if len(units) > 1 else next(iter(units)))


def _vanishing(
    value: object, label_: str, both: Scope, results: tuple[Result, ...]
) -> tuple[Formula, str]:
    """Return a formula that is to vanish, of answers and what is known, and its unit."""
    read, unit = of_any_unit(value, label_, both)
    return written_out(read, results), spelled(unit)
