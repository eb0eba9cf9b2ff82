"""The ways that links held together by constraints are solved: what follows put in, or beside."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from sympy import Expr, Integer, Symbol

from derive.lecture.turning import unit_vector
from derive.mechanics.absolute_angles import absolute_angles, relative
from derive.mechanics.box import Box, ranges
from derive.mechanics.frames import ZERO
from derive.mechanics.held_links import (
    CLEAR,
    ONE,
    Elimination,
    HeldCondition,
    LinearSum,
    pivot_sizes,
    pivots_of,
    put_into,
    with_forces,
    with_what_is_left,
)
from derive.mechanics.links import BASE, Drift, Link, Links
from derive.mechanics.mass_matrix import MassMatrix
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.onto import Doubles
from derive.mechanics.recursion import recursion
from derive.mechanics.survey import links
from derive.mechanics.sweep import Sweep, matrices, sweep_at, weakest

ABSOLUTE, RELATIVE = "absolute angles", "recursion"
SIZES = (1, 2), (2, 1)
HeldWay = tuple[str, MassMatrix, bool]
"""How, a mass matrix with its right side, and whether its unknowns are absolute angles."""
HeldWays = Iterator[tuple[str, Mapping[Symbol, Expr]]]


def held_together(mechanism: Mechanism, sought: frozenset[Symbol]) -> HeldWays:
    """Yield ways to accelerations of links with constraints, and to the forces that hold them."""
    sheet = mechanism.answers.frames.sheet
    free = frozenset(sheet.symbols[m.unknown] for m in mechanism.scene.moving if m.free)
    machine = links(mechanism.answers.frames, free)
    if machine is None or machine.free != free or machine.drives:
        return
    rows = []
    for c in mechanism.held.kept:
        rest, slopes = sheet.split(c.second)
        force = c.factor or Symbol(f"force of {c.name}", real=True)
        rows.append(HeldCondition({**slopes, ONE: rest}, force))
    if not rows or not sought or not sought <= free | {row.force for row in rows}:
        return
    for way in _ways(machine):
        yield from _solved(mechanism, machine, way, rows, sought)


def _ways(machine: Links) -> Iterator[HeldWay]:
    """Yield mass matrices: how, each with its system."""
    absolute = absolute_angles(machine)
    if absolute is not None:
        yield ABSOLUTE, absolute.system, True
    if absolute is None and all(link.about_axis for link in machine.links):
        each = _each_by_its_own(machine)
        absolute = absolute_angles(each)
        if absolute is not None:
            yield ABSOLUTE, _composed(machine, each, absolute.system), False
    yield RELATIVE, recursion(machine), False


def _each_by_its_own(machine: Links) -> Links:
    """Return the machine with an unknown of its own for each link."""
    own = (Drift(ZERO, {Symbol(f"turning {n}", real=True): unit_vector("xyz"[k.axis])})
           for n, k in enumerate(machine.links))  # fmt: skip
    turning = (replace(k, turning=drift) for k, drift in zip(machine.links, own, strict=True))
    return replace(machine, links=tuple(turning))


def _solved(
    mechanism: Mechanism, machine: Links, way: HeldWay,
    rows: Sequence[HeldCondition], sought: frozenset[Symbol],
) -> HeldWays:  # fmt: skip
    how, system, in_angles = way
    if in_angles:
        rows = [_absolute(machine, row) for row in rows]
    order, forces = _leaves_first(machine), [r.force for r in rows if r.force in sought]
    before = mechanism.answers.frames.sheet.needed([e for r in rows for e in r.form.values()])
    ways = [("what follows put in", with_what_is_left(system, rows, order, pivots, forces))
            for pivots in _choices(mechanism, rows, order, before)]  # fmt: skip
    for says, (made, found) in (*ways, ("forces beside", with_forces(system, rows, order))):
        values = relative(machine, found) if in_angles else found
        yield f"{how}, {says}", {**before, **made.definitions, **values}


def _absolute(machine: Links, row: HeldCondition) -> HeldCondition:
    """Return a condition on the accelerations of absolute angles."""
    form = dict(row.form)
    for link in machine.links:
        if link.parent != BASE and link.unknown in row.form:
            above = _unknown(machine.links[link.parent])
            form[above] = form.get(above, Integer(0)) - row.form[link.unknown]
    return HeldCondition({u: x for u, x in form.items() if x != 0}, row.force)


def _composed(machine: Links, each: Links, system: MassMatrix) -> MassMatrix:
    """Return a mass matrix in absolute angles of links, by what turns each link in its parent."""
    forms: dict[Symbol, LinearSum] = {}
    for link, own in zip(machine.links, each.links, strict=True):
        slopes = {u: d[link.axis] for u, d in link.turning.slopes.items()}
        form = {**slopes, ONE: link.turning.rest[link.axis]}
        if link.parent != BASE:
            for u, x in forms[_unknown(each.links[link.parent])].items():
                form[u] = form.get(u, Integer(0)) + x
        forms[_unknown(own)] = {u: x for u, x in form.items() if x != 0}
    return put_into(system, forms, sorted(machine.free, key=str))


def _unknown(link: Link) -> Symbol:
    assert link.unknown is not None  # noqa: S101
    return link.unknown


def _leaves_first(machine: Links) -> list[Symbol]:
    return [*machine.turning, *sorted(machine.free - {*machine.turning}, key=str)]


def _choices(
    mechanism: Mechanism, rows: Sequence[HeldCondition], order: Sequence[Symbol],
    before: Mapping[Symbol, Expr],
) -> Iterator[tuple[Elimination, ...]]:  # fmt: skip
    """Yield what may follow on all of the ranges, one by one first, and two by two."""
    box = ranges(mechanism.words)
    points = box.brought(box.trials())
    entries = [[row.form.get(u, Integer(0)) for u in order] for row in rows]
    at_points = matrices(sweep_at(box, points, before), entries)
    for sizes in SIZES:
        own = pivots_of(at_points, order, sizes)
        if own is not None and not _vanish(box, before, entries, (order, own)):
            yield own


def _vanish(
    box: Box, before: Mapping[Symbol, Expr], entries: list[list[Expr]],
    chosen: tuple[Sequence[Symbol], tuple[Elimination, ...]],
) -> bool:  # fmt: skip
    """Tell whether a search over the ranges finds a pivot that vanishes."""

    def measure(found: Sweep) -> Doubles:
        return pivot_sizes(matrices(found, entries), *chosen)

    return weakest(box, before, measure, CLEAR / 2, enough=CLEAR / 2).vanishes
