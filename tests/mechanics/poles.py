"""Where functions are wrong or not finite though the equations are regular, in any scene.

Every quantity is put at zero, every angle at quarters of a turn and at other angles, and beside
those by 1e-12 to 1e-3, the rest at draws of the ranges. Programs run in floats and in pairs of
doubles at all of these at once. Whether a machine is regular at a place is asked of all of its
balances, not of those that were chosen, which are what is tried.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray

from derive.library.library import Library
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.probe import DIGITS, Probe, random_probe
from derive.mechanics.valued import Valued
from derive.program.precision import F64
from derive.program.program import Quantity, placed
from derive.verify.draw import Dice, Sampled, admitted, complete, drawn
from derive.verify.equations import equations_of
from derive.verify.operators import Column
from derive.verify.reference import NoValueError, reference
from derive.verify.scale import STATE_RATE, base_of, measured_outputs
from derive.verify.search import errors_at

ALLOWED = 1e6  # u of the largest term: a pole loses ten digits, cancellation in what is regular six
NEAR = (0.0, 1e-12, -1e-9, 1e-6, -1e-3)
QUARTERS = range(-4, 5)
OTHERS = 2  # draws of all other quantities at each place
AT_ONCE = 40  # points at which all angles are special
REGULAR = 1e-4  # of balances scaled to size one: what is less may be a pole of the machine itself


@dataclass(frozen=True)
class Pole:
    """An output that is wrong at a place, and by how much, in u of its largest term."""

    function: str
    output: str
    error: float
    place: dict[str, float]


def poles(made: Library) -> list[Pole]:
    """Return the worst place of each function at which it should be right and is not."""
    of = Sampled(made, F64)
    at = complete(of, points(of))
    found = []
    for plan in of.plans:
        program, errors = plan.program, errors_at(of, plan, at)
        worst = np.max([own.max(axis=0) for own in errors], axis=0)
        order = np.argsort(-worst, kind="stable")
        for n in order[worst[order] > ALLOWED]:
            place = {name: float(at.own[name][n]) for name in of.names}
            if regular(made, base_of(program), place):
                k = int(np.argmax([own[:, n].max() for own in errors]))
                output = measured_outputs(program)[k][0].name
                found.append(Pole(program.name, output, float(worst[n]), place))
                break
    return found


def points(of: Sampled) -> Column:
    """Return raw samples at and beside the places where sines, cosines and divisors vanish."""
    dice = Dice("derive: poles")
    base = drawn(of, dice, OTHERS)
    columns = [base]
    places = [(k, x) for k, q in enumerate(_owners(of)) for x in _special(of, k, q, base)]
    for k, x in places:
        for near in NEAR:
            own = base.copy()
            own[k] = x + near
            columns.append(own)
    at_once = drawn(of, dice, AT_ONCE)
    for k, x in places:
        at_once[k, dice.uniform(AT_ONCE) < 1 / 3] = x[0]
    zero = np.where((of.lows <= 0) & (of.highs >= 0), 0.0, base[:, 0])[:, None]
    rows = np.hstack([*columns, at_once, zero])
    rows = np.clip(rows, of.lows[:, None], of.highs[:, None])
    rows = _on_spheres(of, rows)
    return rows[:, admitted(of, rows)]


def _owners(of: Sampled) -> list[Quantity]:
    return [q for q in of.quantities for _ in q.components]


def _special(of: Sampled, k: int, q: Quantity, base: Column) -> Iterator[Column]:
    """Yield values of a component: zero, quarters of a turn, and what others of its unit are."""
    if q.unit != "rad":
        yield from [np.zeros(OTHERS)] if of.lows[k] <= 0 <= of.highs[k] else []
        return
    for quarter in QUARTERS:
        if of.lows[k] <= quarter * np.pi / 2 <= of.highs[k]:
            yield np.full(OTHERS, quarter * np.pi / 2)
    for n, other in enumerate(_owners(of)):
        if n != k and other.unit == "rad":
            yield from (base[n], -base[n])


def _on_spheres(of: Sampled, rows: Column) -> Column:
    """Return rows with attitudes of norm 1; four zeros are none, and become the identity."""
    for q, span in placed(of.quantities):
        if q.is_quaternion:
            size = np.linalg.norm(rows[span], axis=0)
            rows[span] = rows[span] / np.where(size > 0, size, 1.0)
            rows[span.start] = np.where(size > 0, rows[span.start], 1.0)
    return rows


def regular(made: Library, base: str, place: dict[str, float]) -> bool:
    """Tell whether a function has a value at a place by what its scene says; a step as its rate."""
    base = base if base in made.problems else STATE_RATE
    if base not in made.problems:
        return True
    problem = made.mechanism.whole(base)
    used = {s for e in problem.answers.values() for s in e.free_symbols}
    used |= {s for e in problem.definitions.values() for s in e.free_symbols}
    wanted = [u for u in problem.unknowns if u in used]
    if wanted:
        return told(made.mechanism, wanted, place) > REGULAR
    try:
        reference(equations_of(made.mechanism, made.problems[base]), place, ())
    except NoValueError:
        return False
    return True


def told(mechanism: Mechanism, wanted: list[object], place: dict[str, float]) -> float:
    """Return how clearly all balances of a machine tell some unknowns: a singular value."""
    balances, symbols = mechanism.answers.balances, mechanism.vocabulary.symbols
    probe = Probe(
        random_probe(mechanism.words, 0).values | {symbols[c]: mpf(x) for c, x in place.items()}
    )
    with mp.workdps(DIGITS):
        probe.define(mechanism.words.sheet.definitions)
        valued = Valued(balances.sides, probe)
        table = np.array([[float(x) for x in balances.at(row, valued)[1:]]
                          for row in balances.rows if row.holds])  # fmt: skip
    for axis in (1, 0, 1):
        size = np.linalg.norm(table, axis=axis, keepdims=True)
        table = table / np.where(size > 0, size, 1)
    own = [balances.unknowns.index(u) for u in wanted]
    others = np.delete(table, own, axis=1)
    return float(np.linalg.svd(_beside(table[:, own], others), compute_uv=False)[-1])


def _beside(table: NDArray[Any], others: NDArray[Any]) -> NDArray[Any]:
    """Return what is left of columns beside the directions of others."""
    u, size, _ = np.linalg.svd(others, full_matrices=False)
    u = u[:, size > REGULAR**2]
    return table - u @ (u.T @ table)
