"""Steps that end on the constraints: places by Gauss and Newton, then rates by least squares.

Of all states that fulfil the constraints the one nearby is taken, distances counted in parts of
the declared ranges. A correction is damped by the square of what it is to take off, so far away it
goes a part of the way, and does not leap where slopes vanish; near the constraints it is Newton's.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

from derive.motion.attitude.quaternion import norm_squared
from derive.motion.runge_kutta.system import next_of
from derive.program.pattern import compressed
from derive.program.program import MATRIX, Op, Operand, Program, Quantity, Sparsity, operands_of
from derive.program.recorded import needed
from derive.program.slopes import forward, partials
from derive.program.tape import Number, Tape, free_prefix, number, operation
from derive.scene.functions import PLAIN

PASSES = 2
"""Corrections of places: a step of order 4 is off by h^5, after them by its square twice, h^20."""

SlopesBy = dict[str, Number]


@dataclass(frozen=True)
class Homing:
    """What a step brings its state back onto.

    program : gives what vanishes, of states and of inputs that are held
    places  : which of its results are of places     rates : and which are of rates
    moving  : states that places are changed by, each with the square of its range
    driving : the same of rates                      attitudes : the quaternions among the states
    passes  : corrections of rates, one where conditions are linear in them
    taken   : the constants of the scene, which a function may not read and C prints by name
    """

    program: Program
    places: tuple[int, ...]
    rates: tuple[int, ...]
    moving: Mapping[str, Fraction]
    driving: Mapping[str, Fraction]
    passes: int
    attitudes: tuple[tuple[str, ...], ...]
    taken: frozenset[str]


def held_step(step: Program, states: Sequence[str], held: Homing) -> Program:
    """Return a step whose state is brought onto the constraints, and its derivatives with it.

    states : the components of the state, which the first results of the step are, after it
    """
    tape, n = _tape(step, held), len(states)
    found = dict(zip(states, map(partial(_number, tape), step.results), strict=False))
    damping: Number | None = None
    for _ in range(PASSES if held.places else 0):
        found, own = _placed(tape, held, found)
        damping = damping or own
    for _ in range(held.passes):
        found = _driven(tape, held, found, damping or number(0))
    after = [found[name] for name in states]
    more, outputs, sparsity = [_number(tape, r) for r in step.results[n:]], step.outputs, None
    if step.sparsity:
        more, (quantity, pattern) = _with_slopes(tape, held, step, (after, n))
        outputs, sparsity = (*outputs[:-1], quantity), {MATRIX: pattern}
    results = tuple(x.operand for x in (*after, *more))
    given = {q.name for q in step.inputs}
    return replace(
        step,
        says=f"{step.says.rstrip('.')}, brought back onto the constraints.",
        inputs=(*step.inputs, *(q for q in held.program.inputs if q.name not in given)),
        outputs=outputs,
        ops=needed((*step.ops, *tape.ops), results),
        results=results,
        sparsity=sparsity,
    )


def nearer(name: str, states: Sequence[Quantity], held: Homing) -> Program:
    """Return what brings a state once nearer to the constraints, all of places or all of rates.

    held : with either places or rates
    Its last result is the square of how far the state was off, counted as ``held`` weighs.
    """
    names = [c for q in states for c in q.components]
    bare = Program(name, "The state, once nearer to the constraints.", tuple(states), (), (), ())
    tape = _tape(bare, held)
    found = {c: tape.input(c) for c in names}
    if held.places:
        found, off = _placed(tape, held, found)
    else:
        values = _valued(tape, held, found, held.rates, [*held.driving])
        found, off = _corrected(found, values, held.driving, None)
    after = (next_of(q) for q in states)
    results = tuple(x.operand for x in (*found.values(), off))
    given = {q.name for q in states}
    return replace(
        bare,
        inputs=(*(q for q in held.program.inputs if q.name not in given), *states),
        outputs=(*after, Quantity("off", ("off",), (), "1", "", None, None, "square of how far")),
        ops=needed(tape.ops, results),
        results=results,
    )


def reaches(states: Sequence[Quantity], held: Homing) -> list[set[str]]:
    """Return what each condition of ``held``, of either places or rates, is corrected by."""
    bare = Program("", "", tuple(states), (), (), ())
    tape = _tape(bare, held)
    start = {c: tape.input(c) for q in states for c in q.components}
    lengths = [a for q in held.attitudes for a in q]
    by = [*held.moving, *lengths] if held.places else [*held.driving]
    return [{*row} for row in _valued(tape, held, start, (*held.places, *held.rates), by)[1]]


def _tape(step: Program, held: Homing) -> Tape:
    """Return a tape whose names are none of the step's, nor of what vanishes."""
    programs = (step, held.program)
    taken = {*held.taken, *(op.result for p in programs for op in p.ops if isinstance(op, Op))}
    taken |= {name for p in programs for name in operands_of(p.ops, p.results)}
    taken |= {c for p in programs for q in p.inputs for c in q.components}
    return Tape(free_prefix("k", taken))


def _number(tape: Tape, operand: Operand) -> Number:
    return Number(tape, operand) if isinstance(operand, str) else number(operand)


def _placed(
    tape: Tape, held: Homing, state: Mapping[str, Number]
) -> tuple[dict[str, Number], Number]:
    """Return a state with places corrected once, and the damping: the square of what was off."""
    lengths = [a for q in held.attitudes for a in q]
    values, rows = _valued(tape, held, state, held.places, [*held.moving, *lengths])
    for q in held.attitudes:
        if any(c in row for row in rows for c in q):
            values.append(norm_squared([state[c] for c in q]) - 1)
            rows.append({c: 2 * state[c] for c in q})
    return _corrected(state, (values, rows), held.moving, None)


def _driven(
    tape: Tape, held: Homing, state: Mapping[str, Number], damping: Number
) -> dict[str, Number]:
    """Return a state with rates corrected once."""
    values, rows = _valued(tape, held, state, held.rates, [*held.driving])
    return _corrected(state, (values, rows), held.driving, damping)[0]


def _valued(
    tape: Tape, held: Homing, state: Mapping[str, Number], results: Sequence[int], by: Sequence[str]
) -> tuple[list[Number], list[SlopesBy]]:
    """Return results of what vanishes, and the slopes of each by components of the state."""
    program = held.program
    wanted = [program.results[k] for k in results]
    inputs = (c for q in program.inputs if q.is_value for c in q.components)
    known = {c: state[c] if c in state else tape.input(c) for c in inputs}
    slopes: dict[str, SlopesBy] = {c: {c: number(1)} for c in by}

    def value(operand: Operand) -> Number:
        if isinstance(operand, str):
            return known.get(operand) or Number(tape, operand)  # what is left are constants
        return number(operand)

    for op in needed(program.ops, wanted):
        if not isinstance(op, Op):
            raise TypeError(f"'{program.name}' has a loop, and slopes of a loop are not known")
        own = [value(o) for o in op.operands]
        known[op.result] = PLAIN.get(op.operator, partial(operation, op.operator))(*own)
        if any(o in slopes for o in op.operands):
            each = zip(op.operands, partials(op, own, known[op.result]), strict=True)
            slopes[op.result] = _summed((by_, slopes.get(str(o), {})) for o, by_ in each)
    return [value(r) for r in wanted], [slopes.get(str(r), {}) for r in wanted]


def _summed(parts: Iterable[tuple[Number, SlopesBy]]) -> SlopesBy:
    """Return the sum of rows, each times a number, without what vanishes."""
    total: SlopesBy = {}
    for factor, row in parts:
        for c, x in row.items():
            total[c] = total.get(c, number(0)) + factor * x
    return {c: x for c, x in total.items() if x.exact != 0}


def _corrected(
    state: Mapping[str, Number],
    off: tuple[list[Number], list[SlopesBy]],
    weights: Mapping[str, Fraction],
    damping: Number | None,
) -> tuple[dict[str, Number], Number]:
    """Return the state nearby at which linear conditions vanish, damped, and the damping.

    off : what the conditions are, and their slopes        weights : 1 where there is none
    """
    values, rows = off
    weighed = [{c: x * weights.get(c, 1) for c, x in row.items()} for row in rows]
    square = [[_inner(a, b) for b in weighed] for a in rows]
    if damping is None:
        parts = (g * g / square[i][i] for i, g in enumerate(values))
        damping = sum(parts, number(0))
    for i in range(len(rows)):
        square[i][i] = square[i][i] + square[i][i] * damping
    sizes = _solved(square, values)
    found = dict(state)
    for size, row in zip(sizes, weighed, strict=True):
        found |= {c: found[c] - size * x for c, x in row.items()}
    return found, damping


def _inner(a: SlopesBy, b: SlopesBy) -> Number:
    return sum((x * b[c] for c, x in a.items() if c in b), number(0))


def _solved(square: Sequence[Sequence[Number]], right: Sequence[Number]) -> list[Number]:
    """Return the solution of equations that are symmetric and positive, by L D L^T."""
    n = len(square)
    lower = [[number(0)] * n for _ in range(n)]
    pivots, found = list[Number](), list(right)
    for i in range(n):
        for k in range(i):
            terms = (lower[i][j] * lower[k][j] * pivots[j] for j in range(k))
            lower[i][k] = (square[i][k] - sum(terms, number(0))) / pivots[k]
        terms = (lower[i][j] * lower[i][j] * pivots[j] for j in range(i))
        pivots.append(square[i][i] - sum(terms, number(0)))
        found[i] = found[i] - sum((lower[i][k] * found[k] for k in range(i)), number(0))
    found = [x / p for x, p in zip(found, pivots, strict=True)]
    for i in reversed(range(n)):
        found[i] = found[i] - sum((lower[k][i] * found[k] for k in range(i + 1, n)), number(0))
    return found


def _with_slopes(
    tape: Tape, held: Homing, step: Program, state: tuple[Sequence[Number], int]
) -> tuple[list[Number], tuple[Quantity, Sparsity]]:
    """Return the nonzeros of the whole step's Jacobian, and what is said of them.

    state : after the step, and the number of its components
    """
    after, n = state
    ops, pattern = tuple(tape.ops), (step.sparsity or {})[MATRIX]
    before = [[number(0)] * len(pattern.columns) for _ in range(n)]
    for (row, column), entry in zip(pattern.places(), step.results[n:], strict=True):
        before[row][column] = _number(tape, entry)
    matrix = [[number(0)] * len(pattern.columns) for _ in range(n)]
    states = {c for q in step.outputs for c in q.components}
    read = {c for q in held.program.inputs if q.is_value for c in q.components}
    for k, label in enumerate(pattern.columns):
        changes: SlopesBy = {}
        if label in read and f"{label}_next" not in states:
            changes[label] = number(1)
        changes |= {r: before[i][k] for i, r in enumerate(step.results[:n]) if isinstance(r, str)}
        slopes = forward(tape, ops, changes)
        for i, x in enumerate(after):
            if isinstance(x.operand, str):
                matrix[i][k] = slopes.get(x.operand, number(0))
    made, nonzeros = compressed(matrix, pattern.rows, pattern.columns, lambda x: x.exact == 0)
    parts = tuple(f"d({made.rows[i]})/d({made.columns[k]})" for i, k in made.places())
    return nonzeros, (replace(step.outputs[-1], components=parts, shape=(len(parts),)), made)
