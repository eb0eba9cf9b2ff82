"""The true end of a motion, from the lecture's equations of the state's rate alone, in long floats.

The equations of the problem are solved as they stand, block by block, and their solution is
followed by extrapolation of midpoint rules, in lengths that keep what it leaves below ``LEFT``. No
step, arrangement or program of ours has a part in it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, arb_mat, ctx

from derive.library.library import Library
from derive.report.extrapolation import DEEPEST, extrapolated, rule_for
from derive.report.states import rate_equations
from derive.verify.convergence import unit_attitude
from derive.verify.equations import Block, Coefficient, Equations, Sum
from derive.verify.operators import LONG_FLOATS
from derive.verify.valuation import raised, value

BITS = 128
GROWN = 100
"""Times its size at the beginning, and one: what has grown so far does not stop of itself."""
INFINITE, NO_VALUE = "becomes infinite", "meets a place where its equations have no value"
GROWS, LONG = f"grows more than {GROWN} times", "takes too long to be followed"
"""What becomes of motions without an end, and of those that are not followed to it."""
LEFT = 1e-20
"""Relative: what extrapolation may leave in each of its lengths, far below u of a double."""
SHORTEST = 1e-13
"""Of the whole time: a motion that needs shorter lengths runs into a place without a value."""
MOST, WORK = 4000, 100_000
"""Lengths of a motion, a hundred times as many as most need, and what so many blocks allow."""
EARLY, SLOW = 150, 0.25
"""So many lengths that bring less than so much of their share of the time say that it is long."""


class NoEndError(ArithmeticError):
    """A motion that cannot be followed to its end."""


@dataclass(frozen=True)
class End:
    """Where a motion truly ends, and the largest size of each component of the state on its way.

    state : of each component two doubles, of which the second is what the first leaves
    """

    state: Mapping[str, tuple[float, float]]
    sizes: Mapping[str, float]


@dataclass(frozen=True)
class RateOfState:
    """The rate of a state as the lecture's equations give it; what is held is worked out once."""

    equations: Equations
    states: tuple[int, ...]
    rates: tuple[int, ...]
    held: Mapping[int, Any]
    coefficients: tuple[Any, ...]
    blocks: tuple[Block, ...]

    def __call__(self, state: Sequence[Any]) -> list[Any]:
        """Return the rates of a state's components."""
        at = {**self.held, **dict(zip(self.states, state, strict=True))}
        _apply(self.equations, at)
        for block in self.blocks:
            _solve(self.equations, block, self.coefficients, at)
        return [at[place] for place in self.rates]


def rate_of_state(library: Library, given: Mapping[str, Any]) -> RateOfState:
    """Return the rate of a scene's state, all but the state held at what is given."""
    equations, rates = rate_equations(library)
    place = {name: n for n, name in equations.names.items()}
    states = [c for q in library.vocabulary.states for c in q.components]
    sought = {u for block in equations.blocks for u in block.unknowns}
    at = {n: given[c] for c, n in place.items() if c in given and c not in states}
    at = {n: x for n, x in at.items() if n not in sought}  # what is given to other functions
    _apply(equations, at)
    fixed = {n: at[n] for n in equations.fixed}
    coefficients = tuple(_coefficient(c, fixed) for c in equations.coefficients)
    left: list[Block] = []
    for block in equations.blocks:
        if _needs(block) <= at.keys():
            _solve(equations, block, coefficients, at)
        else:
            left.append(block)
    lost = len(place)  # a place of its own for each state that no equation knows
    own = [place.get(c, -lost - k) for k, c in enumerate(states)]
    wanted = [place[name] for name in rates]
    return RateOfState(equations, tuple(own), tuple(wanted), at, coefficients, tuple(left))


def _needs(block: Block) -> set[int]:
    sums = [*(s for row in block.matrix for s in row), *block.right]
    return {atom for s in sums for part in s for atom, _ in part.factors}


def _coefficient(polynomial: Coefficient, fixed: Mapping[int, Any]) -> Any:
    return sum((value((term,), fixed, LONG_FLOATS) for term in polynomial), arb(0)).mid()


def _apply(equations: Equations, at: dict[int, Any]) -> None:
    """Add the functions whose operands have values by now."""
    for place, made_of in equations.functions.items():
        if place not in at and made_of <= at.keys():
            atom = equations.atoms[place]
            if atom.kind == "pi":
                at[place] = LONG_FLOATS["pi"]()
                continue
            inner = value(atom.inner, at, LONG_FLOATS)
            found = 1 / inner if atom.kind == "inverse" else LONG_FLOATS[atom.kind](inner)
            at[place] = found.mid()


def _solve(
    equations: Equations, block: Block, coefficients: Sequence[Any], at: dict[int, Any]
) -> None:
    """Add the unknowns of a block, and the functions that are made of them."""
    right = [_summed(s, coefficients, at) for s in block.right]
    rows = [[_summed(s, coefficients, at) for s in row] for row in block.matrix]
    try:
        if len(right) == 1:
            found = [right[0] / rows[0][0]]
        else:
            found = arb_mat(rows).solve(arb_mat([[b] for b in right])).entries()
    except ZeroDivisionError:
        raise NoEndError(NO_VALUE) from None
    at.update(zip(block.unknowns, (x.mid() for x in found), strict=True))
    _apply(equations, at)


def _summed(parts: Sum, coefficients: Sequence[Any], at: Mapping[int, Any]) -> Any:
    total = arb(0)
    for part in parts:
        product = coefficients[part.coefficient]
        for atom, power in part.factors:
            product = product * (at[atom] if power == 1 else raised(at[atom], power))
        total += product
    return total


def end_of(library: Library, values: Mapping[str, float], time: float, fast: float) -> End:
    """Return where the motion from a state ends after ``time``, followed from ``fast`` on.

    fast : rad/s, about how fast it goes: the first length is a turn of 1 rad
    Raises NoEndError where the motion cannot be followed.
    """
    with ctx.workprec(BITS):
        given = unit_attitude(library, {c: arb(x) for c, x in values.items()})
        rate = rate_of_state(library, given)
        names = [c for q in library.vocabulary.states for c in q.components]
        here = [given[c] for c in names]
        sizes = [abs(float(x)) for x in here]
        first, by = max(sizes), rule_for(rate, here, fast)
        done, length = arb(0), min(time, 1 / fast)
        most = min(MOST, WORK // max(1, len(rate.blocks)))
        for tried in range(most):
            if tried == EARLY and float(done) < SLOW * EARLY / most * time:
                raise NoEndError(GROWS if max(sizes) > GROWN * (1 + first) else LONG)
            after, left = extrapolated(by, here, length)
            if left > LEFT:
                length *= max(0.2, 0.9 * (LEFT / left) ** (1 / (2 * DEEPEST)))
                if not length > SHORTEST * time:
                    break
                continue
            here, done = after, (done + arb(length)).mid()
            sizes = [max(size, abs(float(x))) for size, x in zip(sizes, here, strict=True)]
            rest = float(arb(time) - done)
            if rest <= 0:
                ends = [(float(x), float(x - arb(float(x)))) for x in here]
                state = dict(zip(names, ends, strict=True))
                return End(state, dict(zip(names, sizes, strict=True)))
            grown = 0.9 * (LEFT / max(left, 1e-40)) ** (1 / (2 * DEEPEST))
            length = min(rest, length * min(3.0, max(1.0, grown)))
        else:
            raise NoEndError(GROWS if max(sizes) > GROWN * (1 + first) else LONG)
        raise NoEndError(INFINITE if max(sizes) > GROWN * (1 + first) else NO_VALUE)
