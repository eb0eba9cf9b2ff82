"""States at which a function has no value, found by running it there: what its comment warns of.

Every input is set to the places where sines, cosines and norms vanish, the others to values of the
ranges; an output that is infinite or no number there, or beyond all measure, is told. Divisors that
change their sign in or around the ranges are followed to their zero.
"""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from itertools import combinations
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.program.arithmetic import extended, paired, working
from derive.program.program import Op, Program, Quantity, Singular, component_names, operands_of
from derive.program.run import run
from derive.scene.formula import Arithmetic

GENERIC = 32  # draws from the ranges, beside which a value is beyond measure
OTHERS = 3  # values of the other inputs at which a place is tried
BEYOND = 1e9
"""Of the largest value at the draws: 1/sin at the float next to pi is 1e16 of it."""
QUARTERS = range(-4, 5)  # of a turn, each way
HALVINGS = 60
NEAR = 1e-9  # of a place, which halving has found again
AROUND = 1.5  # of the ranges, in which divisors are looked at
SingularAt = tuple[tuple[str, ...], float]


def with_singular(programs: Sequence[Program], setup: Program) -> tuple[Program, ...]:
    """Return the programs, each with the places at which it has no value."""
    arithmetic = working(np.float64)
    plan = next((p for p in programs if p.makes("plan")), None)
    constants = _constants(setup)
    return tuple(
        replace(p, singular=_singular(_Trial(p, plan, constants, arithmetic))) for p in programs
    )


@dataclass(frozen=True)
class _Trial:
    """A program, what makes its plan if it has one, its constants, and C's arithmetic in double."""

    program: Program
    plan: Program | None
    constants: Mapping[str, float]
    arithmetic: Arithmetic

    def free(self) -> tuple[Quantity, ...]:
        """Return the inputs that may be set."""
        return tuple(q for q in self.program.inputs if q.is_value)

    def results(self, columns: dict[str, NDArray[Any]]) -> NDArray[Any]:
        """Return the results, a row a component; ``columns`` hold what may be set."""
        given, count = dict(columns), len(next(iter(columns.values())))
        if self.plan is not None and any(q.role == "plan" for q in self.program.inputs):
            made = _run(self.plan, given, self.constants, self.arithmetic)
            given |= dict(zip(component_names(self.plan), made, strict=True))
        found = _run(self.program, given, self.constants, self.arithmetic)
        return np.array([np.broadcast_to(np.asarray(r, float), count) for r in found])


def _run(
    program: Program,
    given: dict[str, NDArray[Any]],
    known: Mapping[str, float],
    arithmetic: Arithmetic,
) -> list[Any]:
    names = [c for q in program.inputs for c in q.components]
    count = len(next(iter(given.values())))
    values = [given.get(n, np.full(count, known.get(n, 0.0))) for n in names]
    with np.errstate(all="ignore"):
        return run(program, arithmetic, values)


def _constants(setup: Program) -> dict[str, float]:
    """Return the constants at the middle of the parameters' ranges."""
    middle = np.array([[float(((q.low or 0) + (q.high or 0)) / 2)] for q in setup.inputs])
    with np.errstate(all="ignore"):
        made = run(setup, extended(np.float64), paired(middle)) if setup.outputs else []
    return {n: float(np.ravel(r[0])[0]) for n, r in zip(component_names(setup), made, strict=True)}


def _singular(trial: _Trial) -> tuple[Singular, ...]:
    if not trial.free():
        return ()
    generic = _drawn(trial, GENERIC, 1.0)
    usual = np.abs(trial.results(generic))
    usual = np.where(np.isfinite(usual), usual, 0.0).max(axis=1) + np.finfo(float).tiny
    places = _places(trial)
    found = [(place, hit) for place, hit in zip(places, _hits(trial, places, usual), strict=True)]
    hits = {place for place, hit in found if hit}
    told = [*_told(trial, found), *_divisors(trial, usual, hits)]
    return tuple(dict.fromkeys(told))


def _drawn(trial: _Trial, count: int, reach: float) -> dict[str, NDArray[Any]]:
    """Return draws from the ranges, widened by ``reach``; quaternions have norm 1."""
    dice, columns = Random(f"derive: {trial.program.name}"), dict[str, NDArray[Any]]()  # noqa: S311
    for q in trial.free():
        low, high = (float(x) if x is not None else d for x, d in ((q.low, -1.0), (q.high, 1.0)))
        middle, half = (low + high) / 2, (high - low) / 2 * reach
        own = [
            [middle + half * (2 * dice.random() - 1) for _ in range(count)] for _ in q.components
        ]
        columns |= dict(zip(q.components, np.array(own), strict=True))
    return _of_norm_one(trial, columns)


def _of_norm_one(trial: _Trial, columns: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Return columns with quaternions of norm 1, but those that are nothing."""
    made = dict(columns)
    for q in trial.free():
        if q.is_quaternion:
            rows = np.array([columns[c] for c in q.components])
            norm = np.sqrt((rows * rows).sum(axis=0))
            rows = rows / np.where(norm > 0, norm, 1.0)
            made |= dict(zip(q.components, rows, strict=True))
    return made


def _places(trial: _Trial) -> list[SingularAt]:
    """Return the places to try: components that are set together, and to what."""
    places: list[SingularAt] = []
    for q in trial.free():
        if q.unit == "rad" and not q.shape:
            places += [(q.components, k * np.pi / 2) for k in QUARTERS]
            continue
        places += [((c,), 0.0) for c in q.components]
        places += [(q.components, 0.0)] if q.shape else []
    single = [q.components for q in trial.free() if not q.shape]
    places += [(a + b, 0.0) for a, b in combinations(single, 2)]
    rest = tuple(c for q in trial.free() if not q.is_quaternion for c in q.components)
    return [*places, (rest, 0.0)] if rest else places


def _hits(trial: _Trial, places: Sequence[SingularAt], usual: NDArray[Any]) -> list[frozenset[str]]:
    """Return at each place the components that have no value there, whatever the others are."""
    columns = {n: np.tile(x, len(places)) for n, x in _drawn(trial, OTHERS, 1.0).items()}
    for k, (components, value) in enumerate(places):
        for c in components:
            columns[c][k * OTHERS : (k + 1) * OTHERS] = value
    results = np.abs(trial.results(_of_norm_one(trial, columns)))
    beyond = ~(results / BEYOND <= usual[:, None])
    every = beyond.reshape(len(beyond), len(places), OTHERS).all(axis=2)
    names = component_names(trial.program)
    return [frozenset(c for c, bad in zip(names, column, strict=True) if bad) for column in every.T]


def _told(trial: _Trial, found: Sequence[tuple[SingularAt, frozenset[str]]]) -> list[Singular]:
    """Return the places in words: turns of an angle together, and none that another holds."""
    told: list[Singular] = []
    least: list[frozenset[str]] = []
    turned = {q.components: q.name for q in trial.free() if q.unit == "rad" and not q.shape}
    for components, name in turned.items():
        own = {round(v * 2 / np.pi): hit for (c, v), hit in found if c == components and hit}
        if own:
            outputs = frozenset().union(*own.values())
            told.append(Singular(_turns(name, set(own)), _outputs(trial, outputs)))
            least += [frozenset(components)] if 0 in own else []
    by_size = sorted(
        (f for f in found if f[0][0] not in turned and f[1]), key=lambda f: len(f[0][0])
    )
    for (components, _), hit in by_size:
        if not any(held <= set(components) for held in least):
            least.append(frozenset(components))
            told.append(Singular(f"{_named(trial, components)} = 0", _outputs(trial, hit)))
    return told


def _outputs(trial: _Trial, bad: frozenset[str]) -> tuple[str, ...]:
    """Return the outputs whose components are bad, by their names if all of them are.

    A matrix is named as a whole: nobody knows its entries by their names.
    """
    told: list[str] = []
    for q in trial.program.outputs:
        own = [c for c in q.components if c in bad]
        whole = len(own) == len(q.components) or q.name in (trial.program.sparsity or {})
        told += [q.name] if own and whole else own
    return tuple(told)


def _named(trial: _Trial, components: tuple[str, ...]) -> str:
    whole = next((q.name for q in trial.free() if q.components == components), "")
    return whole or " = ".join(components)


def _turns(name: str, quarters: set[int]) -> str:
    """Return where an angle is, from the quarters of a turn that were hit."""
    for says, every in (("k pi/2", 1), ("k pi", 2), ("2 k pi", 4)):
        if quarters == {k for k in QUARTERS if k % every == 0}:
            return f"{name} = {says}"
    if quarters == {k for k in QUARTERS if k % 2}:
        return f"{name} = pi/2 + k pi"
    if quarters == {0}:
        return f"{name} = 0"
    return f"{name} = {', '.join(f'{k} pi/2' for k in sorted(quarters))}"


def _divisors(trial: _Trial, usual: NDArray[Any], hits: AbstractSet[SingularAt]) -> list[Singular]:
    """Return zeros of divisors that change sign around the ranges, one of each divisor.

    hits : places that are told already
    A program that chooses divides on ways that are not taken, and is not looked at.
    """
    if trial.program.has_arrays or "select" in trial.program.count:
        return []
    names = _divided_by(trial.program)
    columns = _drawn(trial, GENERIC, AROUND)
    told = []
    for divisor, inputs in names.items():
        own = {c for c in inputs if c in columns}
        values = _values(trial, divisor, columns)
        ups, downs = np.flatnonzero(values > 0), np.flatnonzero(values < 0)
        if own and len(ups) and len(downs):
            at = _zero(trial, divisor, (columns, ups[0], downs[0]))
            told += [] if _near(at, hits) else _at(trial, at, own, usual)
    return told


def _near(at: dict[str, NDArray[Any]], hits: AbstractSet[SingularAt]) -> bool:
    """Tell whether a state is at a place, but for rounding."""
    return any(all(abs(at[c][0] - value) < NEAR for c in names) for names, value in hits)


def _divided_by(program: Program) -> dict[str, set[str]]:
    """Return the divisors of a program by name, each with the inputs that it is made of."""
    below: dict[str, set[str]] = {c: {c} for q in program.inputs for c in q.components}
    found: dict[str, set[str]] = {}
    for op in program.ops:
        if isinstance(op, Op):
            parts = [below.get(o, set()) for o in operands_of([op])]
            below[op.result] = set().union(*parts) if parts else set()
            last = op.operands[-1] if op.operator == "div" else None
            if isinstance(last, str):
                found[last] = below.get(last, set())
    return found


def _values(trial: _Trial, operand: str, columns: dict[str, NDArray[Any]]) -> NDArray[Any]:
    """Return the values of an operand on the way."""
    ops = trial.program.ops
    last = next((k for k, op in enumerate(ops) if isinstance(op, Op) and op.result == operand), -1)
    part = replace(trial.program, ops=ops[: last + 1], results=(operand,))
    return replace(trial, program=part).results(columns)[0]  # type: ignore[no-any-return]


def _zero(
    trial: _Trial, divisor: str, ends: tuple[dict[str, NDArray[Any]], Any, Any]
) -> dict[str, NDArray[Any]]:
    """Return a state between two draws at which a divisor vanishes."""
    columns, up, down = ends
    low, high = ({c: x[[k]] for c, x in columns.items()} for k in (up, down))
    for _ in range(HALVINGS):
        middle = {c: (low[c] + high[c]) / 2 for c in columns}
        if _values(trial, divisor, middle)[0] > 0:
            low = middle
        else:
            high = middle
    return high


def _at(
    trial: _Trial, state: dict[str, NDArray[Any]], own: set[str], usual: NDArray[Any]
) -> list[Singular]:
    """Return what is told of a state, if an output has no value there."""
    beyond = ~(np.abs(trial.results(state)[:, 0]) / BEYOND <= usual)
    names = component_names(trial.program)
    outputs = _outputs(trial, frozenset(c for c, bad in zip(names, beyond, strict=True) if bad))
    if not outputs:
        return []
    at = ", ".join(f"{c} = {x[0]:.4g}" for c, x in state.items() if c in own)
    return [Singular(f"where a divisor vanishes, as at {at}", outputs)]
