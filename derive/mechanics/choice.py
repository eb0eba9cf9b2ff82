"""Which balances to use: the fewest unknowns beside those wanted, then the plainest equations."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations
from typing import Any

import networkx as nx
import numpy as np
from mpmath import mp
from numpy.typing import NDArray

from derive.mechanics.balance import ValuedBalance
from derive.mechanics.balances import Balances
from derive.mechanics.outboard import outboard, write_out
from derive.mechanics.probe import (
    DIGITS,
    Probe,
    independent,
    independent_at_all,
)
from derive.mechanics.sweep import LEAST
from derive.mechanics.valued import Valued
from derive.scene import Scene, SceneError
from derive.scene.machine import Force

GROUND = "the ground"
FLOORS = (0.1, 0.02, 0.004)  # of a row of size one: what must be left of it beside the others
FEW_BODIES = 3  # whose balances are all looked at, before those of outboard bodies
MOST_EXTRA = 5  # unknowns that are solved along without being asked for, before all are
MOST_SETS = 20_000
MOST_TOLD = 2  # balances that a sentence names

Chosen = tuple[tuple[ValuedBalance, ...], frozenset[int]]


def chosen(balances: Balances, wanted: frozenset[int], hard: Sequence[Probe] = ()) -> Chosen:
    """Return balances for the ``wanted`` unknowns, and all unknowns that these balances hold.

    hard : places at which the balances must be independent too, and clearly so
    Raises SceneError, naming unknowns and balances, if the wanted ones cannot be told.
    """
    if not wanted:
        return (), frozenset()
    if _cannot_be_told(balances, wanted):
        raise SceneError(undetermined(balances, wanted))
    found = None
    if balances.held:
        found = _first(balances, *_of_constraints(balances, balances.telling, wanted), hard)
        if found is None and hard:
            rows = [*balances.telling, *balances.in_any_axes]
            found = _first(balances, *_of_constraints(balances, rows, wanted), hard)
    elif len(balances.frames.machine.bodies) > FEW_BODIES and not balances.single:
        of = outboard(balances)
        rows = _plainest_first(balances, of)
        free = [m.unknown for m in balances.frames.machine.moving if m.free]
        names = enumerate(map(balances.frames.sheet.label, balances.unknowns))
        moving = frozenset(k for k, name in names if name in free)
        found = _first(balances, rows, (wanted, wanted | moving), hard)
        write_out(balances, found[0] if found else (), of)
    if found is None and not balances.held:
        rows = _plainest_first(balances, balances.rows)
        found = _first(balances, rows, _sets(rows, wanted), hard)
    if found is None:
        raise SceneError(undetermined(balances, wanted))
    return found


def _of_constraints(
    balances: Balances, rows: Sequence[ValuedBalance], wanted: frozenset[int]
) -> tuple[Sequence[ValuedBalance], Sequence[frozenset[int]]]:
    """Return rows of a machine with constraints, and sets of unknowns: few, then all."""
    few = frozenset(k for row in balances.enforced for k in row.holds)
    every = frozenset(k for row in rows for k in row.holds)
    return rows, [own for own in (few, every) if wanted <= own]


def _plainest_first(balances: Balances, rows: Iterable[ValuedBalance]) -> list[ValuedBalance]:
    return sorted(
        (row for row in rows if row.holds),
        key=lambda row: (
            len(row.holds),
            len(row.balance.bodies),
            balances.carried_vectors(row.balance),
        ),
    )


def _first(
    balances: Balances,
    rows: Sequence[ValuedBalance],
    sets: Iterable[frozenset[int]],
    hard: Sequence[Probe],
) -> Chosen | None:
    """Return balances that determine the first set of unknowns which some determine."""
    for unknowns in sets:
        within = [row for row in rows if row.holds <= unknowns]
        covered = frozenset(k for row in within for k in row.holds)
        if len(within) < len(unknowns) or covered != unknowns:
            continue
        if hard:
            kept = _clear(balances, within, unknowns, hard)
            if kept:
                return tuple(within[k] for k in kept), unknowns
            continue
        here, at_rest = ([_coefficients(row, point) for row in within] for point in (0, -1))
        kept = independent(here, len(unknowns))
        if len(kept) == len(unknowns):
            both = independent_at_all([here, at_rest], len(unknowns))
            kept = both if len(both) == len(kept) else kept
            return tuple(within[k] for k in kept), unknowns
    return None


def _clear(
    balances: Balances,
    within: Sequence[ValuedBalance],
    unknowns: frozenset[int],
    hard: Sequence[Probe],
) -> list[int]:
    """Return the first rows that are independent at hard places, by as much as can be had."""
    matrices = _matrices(balances, within, unknowns, hard)
    for floor in FLOORS:
        kept: list[int] = []
        bases: list[list[NDArray[Any]]] = [[] for _ in matrices]
        for n in range(len(within)):
            left = [_off(matrix[n], basis) for matrix, basis in zip(matrices, bases, strict=True)]
            if all(np.linalg.norm(own) > floor for own in left):
                for basis, own in zip(bases, left, strict=True):
                    basis.append(own / np.linalg.norm(own))
                kept.append(n)
            if len(kept) == len(unknowns):
                return kept
    return []


def _matrices(
    balances: Balances,
    rows: Sequence[ValuedBalance],
    unknowns: frozenset[int],
    hard: Sequence[Probe],
) -> list[NDArray[Any]]:
    """Return the coefficients of rows at a trial point and at hard places, scaled to size 1."""
    places = [1 + k for k in sorted(unknowns)]
    with mp.workdps(DIGITS):
        each = [[row.values[0] for row in rows]]
        for probe in hard:
            valued = Valued(balances.sides, probe)
            each.append([balances.at(row, valued) for row in rows])
    found = []
    usual: NDArray[Any] | None = None
    for own in each:
        matrix = np.array([[float(values[k]) for k in places] for values in own])
        here = np.linalg.norm(matrix, axis=1, keepdims=True)
        usual = here if usual is None else usual
        if balances.held:  # a condition that vanishes tells nothing
            matrix = np.where(here > LEAST * usual, matrix, 0)
        for axis in (1, 0, 1):
            size = np.linalg.norm(matrix, axis=axis, keepdims=True)
            matrix = matrix / np.where(size > 0, size, 1)
        found.append(matrix)
    return found


def _off(row: NDArray[Any], basis: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Return what is left of a row beside the directions of others."""
    for direction in (*basis, *basis):
        row = row - (row @ direction) * direction
    return row


def clearly_told(balances: Balances, unknowns: frozenset[int], place: Probe) -> bool:
    """Tell whether all balances that hold only these unknowns tell them apart at a place."""
    within = [row for row in balances.rows if row.holds and row.holds <= unknowns]
    matrix = _matrices(balances, within, unknowns, [place])[1]
    size = np.linalg.svd(matrix, compute_uv=False)
    return len(size) == len(unknowns) and bool(size[-1] > FLOORS[-1] * size[0])


def require_no_ring(balances: Balances, wanted: frozenset[int]) -> None:
    """Refuse a closed loop of bodies."""
    label = balances.frames.sheet.label
    names = {label(balances.unknowns[k]) for k in wanted}
    loop = closed_loop(balances.frames.machine, names)
    if loop and _cannot_be_told(balances, wanted):
        raise SceneError(loop)


def _cannot_be_told(balances: Balances, wanted: frozenset[int]) -> bool:
    """Tell whether even all balances together leave some wanted unknown open.

    Those that span all others tell, so the thousands of several bodies need not be valued.
    """
    count = len(balances.unknowns)
    rows = balances.telling if balances.held else balances.spanning
    matrix = [_coefficients(row) for row in rows if row.holds]
    others = [{k: v for k, v in row.items() if k not in wanted} for row in matrix]
    return len(independent(matrix, count)) - len(independent(others, count)) < len(wanted)


def _sets(rows: Sequence[ValuedBalance], wanted: frozenset[int]) -> Iterator[frozenset[int]]:
    """Yield sets of unknowns that hold the wanted ones, small ones first."""
    others = sorted(frozenset(k for row in rows for k in row.holds) - wanted)
    tried = 0
    for extra in range(min(MOST_EXTRA, len(others)) + 1):
        for more in combinations(others, extra):
            tried += 1
            if tried > MOST_SETS:
                break
            yield wanted | frozenset(more)
    yield wanted | frozenset(others)


def _coefficients(row: ValuedBalance, point: int = 0) -> dict[int, Any]:
    return {k: row.values[point][1 + k] for k in sorted(row.holds)}


def undetermined(balances: Balances, wanted: frozenset[int]) -> str:
    """Return a sentence on unknowns that the balances cannot tell apart."""
    label = balances.frames.sheet.label
    names = [label(u) for u in balances.unknowns]
    holding = [row for row in balances.rows if row.holds]
    loop = closed_loop(balances.frames.machine, {names[k] for k in wanted})
    if loop:
        return loop
    for k in sorted(wanted):
        joint = _joint(balances, k)
        if joint:
            also = " and ".join(f"'{names[n]}'" for n in (k, *joint))
            told = [str(row.balance) for row in holding if k in row.holds][:MOST_TOLD]
            return (
                f"unknowns {also} cannot be told apart: every balance that holds '{names[k]}' "
                f"holds the others too, in one combination ({'; '.join(told)})"
            )
    found = ", ".join(f"'{names[k]}'" for k in sorted(wanted))
    return f"the balances do not determine {found}"


def closed_loop(machine: Scene, unknowns: set[str]) -> str:
    """Return a sentence on bodies that loads with unknowns join in a ring, "" if there is none.

    unknowns : those that cannot be found; one of them is an acceleration or a load's of the ring
    """
    of_loads = {u.name: u.load for u in machine.unknowns}
    graph = nx.Graph()
    for load in machine.loads:
        if isinstance(load, Force) and load.name in of_loads.values():
            graph.add_edge(load.on, load.against or GROUND, load=load.name)
    for ring in nx.cycle_basis(graph, GROUND if GROUND in graph else None):
        pairs = zip(ring, (*ring[1:], ring[0]), strict=True)
        loads = [graph.edges[pair]["load"] for pair in pairs]
        if all(of_loads.get(name, loads[0]) in loads for name in unknowns):
            return (
                f"bodies form a closed loop ({', '.join(ring)}), joined by the loads "
                f"{', '.join(loads)}: a machine must be a tree, whose coordinates are free of each "
                "other; open the loop and close it by a constraint, or prescribe what follows"
            )
    return ""


def _joint(balances: Balances, k: int) -> list[int]:
    """Return the unknowns without which ``k`` would be determined."""
    with mp.workdps(DIGITS):
        matrix = [_coefficients(row) for row in balances.rows if row.holds]
        count = len(balances.unknowns)
        for size in (1, 2, 3):
            for left in combinations([n for n in range(count) if n != k], size):
                fewer = [{n: v for n, v in row.items() if n not in left} for row in matrix]
                rest = [{n: v for n, v in row.items() if n != k} for row in fewer]
                if len(independent(fewer, count)) > len(independent(rest, count)):
                    return list(left)
    return []
