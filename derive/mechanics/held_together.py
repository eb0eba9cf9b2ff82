"""The ways that links held together by constraints are solved: what follows put in, or beside."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from sympy import Expr, Integer, Symbol

from derive.mechanics.absolute_angles import absolute_angles, relative
from derive.mechanics.box import Box, ranges
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
from derive.mechanics.links import BASE, Link, Links, links
from derive.mechanics.mass_matrix import MassMatrix
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.onto import Doubles
from derive.mechanics.recursion import recursion
from derive.mechanics.sweep import Sweep, matrices, sweep_at, weakest

ABSOLUTE, RELATIVE = "absolute angles", "recursion"
SIZES = (1, 2), (2, 1)
HeldWays = Iterator[tuple[str, Mapping[Symbol, Expr]]]


def held_together(mechanism: Mechanism, sought: frozenset[Symbol]) -> HeldWays:
    """Yield ways to accelerations of links with constraints, and to the forces that hold them."""
    sheet = mechanism.answers.frames.sheet
    free = frozenset(sheet.symbols[m.unknown] for m in mechanism.scene.moving if m.free)
    machine = links(mechanism.answers.frames, free)
    if machine is None or not machine.links or machine.motion != free or machine.drives:
        return
    rows = []
    for c in mechanism.held.kept:
        rest, slopes = sheet.split(c.second)
        force = c.factor or Symbol(f"force of {c.name}", real=True)
        rows.append(HeldCondition({**slopes, ONE: rest}, force))
    if not rows or not sought or not sought <= free | {row.force for row in rows}:
        return
    machine = _all_turning(machine)
    absolute = absolute_angles(machine)
    ways = (ABSOLUTE, absolute.system if absolute else None), (RELATIVE, recursion(machine))
    for how, system in ways:
        if system is not None:
            yield from _solved(mechanism, machine, (how, system), rows, sought)


def _all_turning(machine: Links) -> Links:
    """Return the machine with an unknown of its own for each link that is known to turn."""
    own = [Symbol(f"turning as known {n}", real=True) for n in range(len(machine.links))]
    pairs = [(k, u) for k, u in zip(machine.links, own, strict=True) if k.unknown is None]
    each = {u: (k.known, dict[Symbol, Expr]()) for k, u in pairs}
    turning = tuple(replace(k, unknown=u, known=Integer(0)) if k.unknown is None else k
                    for k, u in zip(machine.links, own, strict=True))  # fmt: skip
    return replace(machine, links=turning, composed={**machine.composed, **each})


def _solved(
    mechanism: Mechanism, machine: Links, way: tuple[str, MassMatrix],
    rows: Sequence[HeldCondition], sought: frozenset[Symbol],
) -> HeldWays:  # fmt: skip
    how, system = way
    in_angles = how == ABSOLUTE and not machine.composed
    if in_angles:
        rows = [_absolute(machine, row) for row in rows]
    if machine.composed:
        system = _composed(machine, *way)
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


def _composed(machine: Links, how: str, system: MassMatrix) -> MassMatrix:
    """Return a mass matrix in what links turn by, which may be several angles at once."""
    own = {_unknown(k): Symbol(f"{_unknown(k)} itself", real=True) for k in machine.links}
    forms: dict[Symbol, LinearSum] = {}
    for link in machine.links:
        plain = (Integer(0), {_unknown(link): Integer(1)})
        rest, slopes = machine.composed.get(_unknown(link), plain)
        form = {**slopes, ONE: rest}
        if how == ABSOLUTE and link.parent != BASE:
            for u, x in forms[own[_unknown(machine.links[link.parent])]].items():
                form[u] = form.get(u, Integer(0)) + x
        forms[own[_unknown(link)]] = {u: x for u, x in form.items() if x != 0}
    entries = {(own.get(a, a), own.get(b, b)): x for (a, b), x in system.entries.items()}
    right = {own.get(u, u): x for u, x in system.right.items()}
    in_links = MassMatrix(system.definitions, entries, right)
    return put_into(in_links, forms, sorted(machine.motion, key=str))


def _unknown(link: Link) -> Symbol:
    assert link.unknown is not None  # noqa: S101
    return link.unknown


def _leaves_first(machine: Links) -> list[Symbol]:
    leaves = [u for u in map(_unknown, reversed(machine.links)) if u in machine.motion]
    return [*leaves, *sorted(machine.motion - {*leaves}, key=str)]


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

    return weakest(box, before, measure, CLEAR / 2).vanishes
