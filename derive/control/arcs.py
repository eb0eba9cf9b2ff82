"""A trajectory refined: collocation on arcs, whose lengths are to be found, as inputs switch.

On an arc an input is at one of its limits or a polynomial on each element, so that nothing jumps
inside of an element, and Gauss's points converge as they do for smooth motions.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any

import casadi
import numpy as np

from derive.control.continuous import continuous, solver
from derive.control.direct import Grid
from derive.control.plant import NDFloat, Plant
from derive.control.structure import Arc
from derive.control.task import Task

DEGREE = 6
ROUNDED = 1e-12  # of a limit, that rounding may lead an input beyond it
LOOKED = 21  # points of an element at which its inputs are held against their limits
LEAST, MORE = 3, 13  # elements of an arc: at least, and so many more of one that lasts all the time
GAUSS = np.array(casadi.collocation_points(DEGREE, "legendre"))
SLOPES, ENDS, WEIGHTS = (np.array(m) for m in casadi.collocation_coeff(GAUSS.tolist()))


def lagrange(tau: float) -> NDFloat:
    """Return what each value at Gauss's points weighs in the polynomial's at tau, 0 to 1."""
    others = [np.delete(GAUSS, k) for k in range(DEGREE)]
    return np.array([np.prod((tau - o) / (p - o)) for p, o in zip(GAUSS, others, strict=True)])


EDGES = np.column_stack([lagrange(0.0), lagrange(1.0)])


@dataclass(frozen=True)
class Refined:
    """A trajectory by elements of time, each from one node to the next.

    lasts : (elements,) s       x : (states, elements + 1) at nodes
    u     : (inputs, DEGREE, elements) at Gauss's points
    arcs  : with their lengths found           elements : of each arc
    adjoint : (states, elements) what the cost changes with the state at each node but the first
    """

    lasts: NDFloat
    x: NDFloat
    u: NDFloat
    arcs: tuple[Arc, ...]
    elements: tuple[int, ...]
    adjoint: NDFloat
    cost: float
    turns: int
    why: str

    @property
    def until(self) -> float:
        """Return the time at the end, s."""
        return float(self.lasts.sum())

    def beyond(self, low: NDFloat, high: NDFloat) -> float:
        """Return by how much an input passes its limits between Gauss's points, of their width."""
        at = np.array([lagrange(t) for t in np.linspace(0, 1, LOOKED)])
        u = np.einsum("ijk,tj->ikt", self.u, at).reshape(len(low), -1)
        over = np.maximum(u.max(axis=1) - high, low - u.min(axis=1))
        return float((over / np.where(np.isfinite(high - low), high - low, 1.0)).max())

    def at_end(self, element: int) -> NDFloat:
        """Return the inputs at the end of an element."""
        values: NDFloat = self.u[:, :, element] @ lagrange(1.0)
        return values


@dataclass(frozen=True)
class Span:
    """Variables of one element, from node to node, with first guesses and limits; what must vanish.

    edges  : inputs that move, at both its ends        kept : least and most of these
    moving : the inputs that are polynomials here, by number        held : the others' values
    """

    variables: Any
    first: NDFloat
    least: NDFloat
    most: NDFloat
    gaps: Any
    edges: Any
    kept: tuple[NDFloat, NDFloat]
    cost: Any
    moving: tuple[int, ...]
    held: NDFloat


def refined(
    own: Plant, asked: Task, guess: Grid, arcs: Sequence[Arc], finer: int
) -> Refined | None:
    """Return the trajectory on these arcs, from one on a grid; ``finer`` times the elements.

    None where the end asks for more than arcs of these lengths and inputs can give.
    """
    each = [finer * _elements(arc, guess.until) for arc in arcs]
    sizes = np.maximum(np.abs(guess.x).max(axis=1), 1e-3 * asked.sizes[: len(own.x)])
    inputs = np.maximum(np.abs(guess.u).max(axis=1), 1e-9)
    lengths = casadi.MX.sym("d", len(arcs))
    x = [casadi.MX.sym(f"x{k}", len(own.x)) for k in range(sum(each) + 1)]
    parts = [*_parts(own, asked, guess, arcs, each, lengths, x, (sizes, inputs))]
    last = np.concatenate([guess.x[:, -1] / sizes, [0.0]])
    endless = np.full(len(last), np.inf)
    spare = casadi.MX.sym("s")  # where unknowns are as many as equations, IPOPT looks at no cost
    w = casadi.vertcat(lengths, *(p.variables for p in parts), x[-1], spare)
    lasts = np.array([a.lasts for a in arcs]) / guess.until
    begins = np.concatenate([lasts, *(p.first for p in parts), last])
    least = np.concatenate([0 * lasts, *(p.least for p in parts), -endless])
    most = np.concatenate([lasts + np.inf, *(p.most for p in parts), endless])
    whole = casadi.sum1(lengths) * guess.until
    cost = sum(p.cost for p in parts) + asked.cost["time"] * whole
    ends = [asked.ends(x[-1] * sizes)] + ([] if asked.is_free else [whole / asked.until - 1])
    unit = abs(guess.cost) or 1.0
    zero = casadi.vertcat(*(p.gaps for p in parts), *ends)
    if zero.numel() > w.numel() - len(last):
        return None
    goal = cost / unit + spare**2
    box = (begins, least, most)
    jumps = _jumps(asked, arcs, parts, each, inputs) if asked.cost["energy"] else None
    if jumps is None:
        edges = casadi.vertcat(*(p.edges for p in parts))
        kept = [
            np.concatenate([np.zeros(zero.numel()), *(p.kept[k] for p in parts)]) for k in (0, 1)
        ]
        found = solver({"x": w, "f": goal, "g": casadi.vertcat(zero, edges)})(box, kept)
    else:
        found = continuous({"x": w, "f": goal, "g": zero}, box, lengths, jumps)
    at, multipliers, turns, why = found
    read = casadi.Function("read", [w], [lengths, casadi.horzcat(*x), cost])(at)
    lasting = np.array(read[0]).ravel() * guess.until
    u = np.array([*_inputs_of(at, len(arcs), len(own.x), parts, inputs)])
    low, high = (side[len(own.x) :, None] for side in (asked.low, asked.high))
    near = np.clip(u, low, high)
    u = np.where(np.abs(u - near) <= ROUNDED * np.abs(near), near, u)
    adjoint = _adjoint(multipliers, len(own.x), len(parts))
    return Refined(
        np.concatenate([np.full(n, d / n) for d, n in zip(lasting, each, strict=True)]),
        np.array(read[1]) * sizes[:, None],
        u.transpose(1, 2, 0),
        tuple(Arc(arc.stays, float(d)) for arc, d in zip(arcs, lasting, strict=True)),
        tuple(each),
        adjoint * unit / sizes[:, None],
        float(read[2]),
        turns,
        why,
    )


def _jumps(
    asked: Task, arcs: Sequence[Arc], parts: Sequence[Span], each: Sequence[int], inputs: NDFloat
) -> Any:
    """Return by how much inputs jump between arcs; None where one goes from limit to limit.

    Of inputs that come to limits, or leave them, at one time, the first is looked at.
    """
    found, last = list[Any](), -1
    limits = [side[-len(inputs) :] / inputs for side in (asked.low, asked.high)]
    for before, after, count in zip(arcs[:-1], arcs[1:], each[:-1], strict=True):
        last += count
        changed = [
            i for i, (a, b) in enumerate(zip(before.stays, after.stays, strict=True)) if a != b
        ]
        if any(before.stays[i] * after.stays[i] for i in changed):
            return None
        i = changed[0]
        leaves = before.stays[i] == 0
        span = parts[last] if leaves else parts[last + 1]
        value = span.edges[span.moving.index(i) + leaves * len(span.moving)]
        found.append(value - limits[max(before.stays[i] + after.stays[i], 0)][i])
    return casadi.vertcat(*found) if found else casadi.MX(0, 1)


def _parts(
    own: Plant, asked: Task, guess: Grid, arcs: Sequence[Arc], each: Sequence[int],
    lengths: Any, x: Sequence[Any], sizes: tuple[NDFloat, NDFloat],
) -> Iterator[Span]:  # fmt: skip
    states, (size, inputs) = len(own.x), sizes
    low, high = asked.low[states:], asked.high[states:]
    k, begins = 0, 0.0
    for place, (arc, count) in enumerate(zip(arcs, each, strict=True)):
        moving = tuple(i for i, stay in enumerate(arc.stays) if stay == 0)
        own_low, own_high = (side[[*moving]] / inputs[[*moving]] for side in (low, high))
        held = np.array([(low, high)[max(s, 0)][i] if s else 0.0 for i, s in enumerate(arc.stays)])
        element = _element(own, asked, sizes, moving, held)
        for _ in range(count):
            z = casadi.MX.sym(f"z{k}", states, DEGREE)
            v = casadi.MX.sym(f"v{k}", len(moving), DEGREE)
            inner, end, spent = element(x[k], z, v, lengths[place] * (guess.until / count))
            times = begins + arc.lasts / count * GAUSS
            endless = np.full(states * (DEGREE + 1), np.inf)
            least, most = -endless, endless.copy()
            if k == 0:
                least[:states] = most[:states] = asked.start / size
            columns = np.column_stack([_states_at(guess, [begins]), _states_at(guess, times)])
            u = _inputs_at(guess, times)[[*moving]] / inputs[[*moving], None]
            yield Span(
                casadi.vertcat(x[k], casadi.vec(z), casadi.vec(v)),
                np.concatenate([(columns / size[:, None]).T.ravel(), u.T.ravel()]),
                np.concatenate([least, np.tile(own_low, DEGREE)]),
                np.concatenate([most, np.tile(own_high, DEGREE)]),
                casadi.vertcat(casadi.vec(inner), end - x[k + 1]),
                casadi.vec(casadi.mtimes(v, casadi.DM(EDGES))),
                (np.tile(own_low, 2), np.tile(own_high, 2)),
                spent,
                moving,
                held,
            )
            begins, k = begins + arc.lasts / count, k + 1


def _elements(arc: Arc, until: float) -> int:
    return LEAST + ceil(MORE * min(arc.lasts / until, 1.0))


def _element(
    own: Plant, asked: Task, sizes: tuple[NDFloat, NDFloat], free: Sequence[int], held: NDFloat
) -> Any:
    """Return what vanishes at Gauss's points, the state at the end, and the energy spent."""
    size, inputs = sizes
    states = len(size)
    x, z = casadi.SX.sym("x", states), casadi.SX.sym("z", states, DEGREE)
    v, lasts = casadi.SX.sym("v", len(free), DEGREE), casadi.SX.sym("h")
    whole = casadi.horzcat(x, z)
    inner, spent = list[Any](), 0
    for j in range(DEGREE):
        u = [casadi.SX(value) for value in held]
        for place, i in enumerate(free):
            u[i] = v[place, j] * inputs[i]
        column = casadi.vertcat(*u)
        slope = casadi.mtimes(whole, casadi.DM(SLOPES[:, j]))
        inner.append(slope - lasts * own.rate(z[:, j] * size, column) / size)
        spent += asked.cost["energy"] * lasts * WEIGHTS.ravel()[j] * casadi.sumsqr(column)
    end = casadi.mtimes(whole, casadi.DM(ENDS.ravel()))
    return casadi.Function("element", [x, z, v, lasts], [casadi.horzcat(*inner), end, spent])


def _states_at(guess: Grid, times: Sequence[float] | NDFloat) -> NDFloat:
    grid = np.linspace(0, guess.until, guess.x.shape[1])
    return np.array([np.interp(times, grid, row) for row in guess.x])


def _inputs_at(guess: Grid, times: NDFloat) -> NDFloat:
    middle = (np.arange(guess.u.shape[1]) + 0.5) * guess.until / guess.u.shape[1]
    return np.array([np.interp(times, middle, row) for row in guess.u])


def _inputs_of(
    w: NDFloat, count: int, states: int, parts: Sequence[Span], inputs: NDFloat
) -> Iterator[NDFloat]:
    """Yield the inputs (inputs, DEGREE) of each element."""
    place = count
    for part in parts:
        place += states * (DEGREE + 1)
        many, moving = len(part.moving), [*part.moving]
        u = np.repeat(part.held[:, None], DEGREE, axis=1)
        u[moving] = w[place : place + many * DEGREE].reshape(DEGREE, many).T * inputs[moving, None]
        place += many * DEGREE
        yield u


def _adjoint(multipliers: NDFloat, states: int, count: int) -> NDFloat:
    """Return the multipliers of the nodes, what an element's end moves the cost by."""
    size = states * (DEGREE + 1)
    return np.column_stack([multipliers[k * size :][states * DEGREE : size] for k in range(count)])
