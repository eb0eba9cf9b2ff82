"""Columns of samples on the declared ranges, any number of them, the same on every machine.

The bits are Philox's, whose stream NumPy keeps; numbers are made of them by basic operations. A
sample is complete when times are in reach and a plan is made; what completes it is worked out.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from typing import Any

import numpy as np

from derive.library.library import Library
from derive.motion.compensated import REMAINDER
from derive.program.precision import Precision
from derive.program.program import Quantity, component_names
from derive.scene import SceneError
from derive.scene.formula import evaluate
from derive.scene.machine import Entries
from derive.verify.columns import Column, Known, Plan, arithmetics, in_columns, known, planned
from derive.verify.hard_bodies import inverted, without_wheels
from derive.verify.motion_error import OMEGA_DOT, bounds_of_times, fresh_quantities, telling
from derive.verify.sample import varying

Columns = Mapping[str, Column]
"""A column of doubles a component; ``held`` makes them floats of the precision."""

SLACK = 1e-12
"""Of the triangle inequality, relative to the trace: a disc obeys it with equality."""
FEWEST = 1 / 64
"""Where fewer bodies than this obey the triangle inequality, any definite tensor will do."""
TRIES = 400


@dataclass
class Dice:
    """Uniform numbers from a text: the stream of Philox's 64 bits, the upper 53 of each."""

    seed: str

    @cached_property
    def _bits(self) -> Any:
        return np.random.Philox(key=int.from_bytes(sha256(self.seed.encode()).digest()[:16], "big"))

    def uniform(self, *shape: int) -> Column:
        """Return numbers in [0, 1)."""
        raw = self._bits.random_raw(int(np.prod(shape)))
        return np.asarray((raw >> np.uint64(11)).astype(np.float64).reshape(shape) * 2.0**-53)


@dataclass(frozen=True)
class Ranges:
    """What is drawn for a scene, in one precision: quantities, and which bodies are admitted."""

    library: Library
    precision: Precision
    quantities: tuple[Quantity, ...]
    lenient: bool  # a tensor that breaks the triangle inequality will do

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Return the components of all quantities in order."""
        return tuple(c for q in self.quantities for c in q.components)

    @cached_property
    def lows(self) -> Column:
        """Return the low ends, component by component."""
        return np.array([_ends(q)[0] for q in self.quantities for _ in q.components])

    @cached_property
    def highs(self) -> Column:
        """Return the high ends, component by component."""
        return np.array([_ends(q)[1] for q in self.quantities for _ in q.components])


def _ends(q: Quantity) -> tuple[float, float]:
    """Return the ends of a range; a remainder is drawn as a part of u times its state."""
    low, high = (-1, 1) if q.role == "remainder" else q.ends
    return float(low), float(high)


def ranges(library: Library, precision: Precision) -> Ranges:
    """Return what is drawn for all functions of a scene."""
    words = library.known.words
    every = (*words.parameters, *varying(library.known), *fresh_quantities(library))
    strict = Ranges(library, precision, tuple(every), lenient=False)
    tried = _anywhere(strict, Dice("bodies"), 4096)
    return Ranges(library, precision, strict.quantities, np.mean(admitted(strict, tried)) < FEWEST)


def drawn(of: Ranges, dice: Dice, count: int) -> Column:
    """Return raw samples, a row a component, of admissible bodies.

    Raises SceneError where the ranges of the parameters hold no body.
    """
    found: list[Column] = []
    missing = count
    for _ in range(TRIES):
        rows = _anywhere(of, dice, max(missing, 256))
        found.append(rows[:, admitted(of, rows)][:, :missing])
        missing -= found[-1].shape[1]
        if not missing:
            return np.concatenate(found, axis=1)
    raise SceneError(
        f"scene '{of.library.known.scene.name}': the ranges of its parameters must hold a body, "
        f"but only {count - missing} were found in {TRIES} tries of {count}"
    )


def _anywhere(of: Ranges, dice: Dice, count: int) -> Column:
    across = (of.highs - of.lows)[:, None]
    return on_the_sphere(of, of.lows[:, None] + across * dice.uniform(len(of.names), count))


def on_the_sphere(of: Ranges, rows: Column) -> Column:
    """Return rows with every attitude of the states of unit length."""
    place = 0
    for q in of.quantities:
        span = slice(place, place + len(q.components))
        place += len(q.components)
        if q in of.library.known.words.states and q.name == "attitude":
            w, x, y, z = rows[span]
            size = np.sqrt(w * w + x * x + y * y + z * z)
            rows[span] = rows[span] / np.where(size > 0, size, 1.0)
    return rows


def admitted(of: Ranges, rows: Column) -> Any:
    """Return which samples are of bodies that can be, wheels included."""
    numbers: dict[str, Any] = dict(zip(of.names, held(of, rows), strict=True))
    numbers |= {n: float(x) for n, x in of.library.known.words.numbers.items()}
    fits = np.ones(rows.shape[1], bool)
    for one in inverted(of.library.known):
        with np.errstate(all="ignore"):
            whole, rest = _matrix(one.whole, numbers), _matrix(without_wheels(one), numbers)
            half = (whole[0][0] + whole[1][1] + whole[2][2]) / 2
            second = [[(half if i == k else 0.0) - whole[i][k] for k in range(3)] for i in range(3)]
            size = np.abs(whole[0][0]) + np.abs(whole[1][1]) + np.abs(whole[2][2])
            fits = fits & _semidefinite(rest, size)
            fits = fits if of.lenient else fits & _semidefinite(second, size)
    return np.broadcast_to(fits, (rows.shape[1],))


def _matrix(entries: Entries, numbers: Mapping[str, Any]) -> list[list[Any]]:
    xx, yy, zz, xy, xz, yz = (_value(f, numbers) for f in entries)
    return [[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]


def _value(formula: Any, numbers: Mapping[str, Any]) -> Any:
    table = arithmetics(np.float64).own
    return np.asarray(evaluate(formula, numbers, table | {"number": float, "power": _power}))


def _power(x: Any, n: int) -> Any:
    product = x * 0 + 1.0
    for _ in range(abs(n)):
        product = product * x
    return product if n >= 0 else 1 / product


def _semidefinite(m: Any, size: Any) -> Any:
    (a, d, e), (_, b, f), (_, _, c) = m
    a, b, c = (x + SLACK * size for x in (a, b, c))
    minors = (a * b - d * d, a * c - e * e, b * c - f * f)
    whole = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)
    fits = (a >= 0) & (b >= 0) & (c >= 0) & (whole >= 0)
    return fits & (minors[0] >= 0) & (minors[1] >= 0) & (minors[2] >= 0)


def held(of: Ranges, rows: Column) -> Column:
    """Return numbers as floats of the precision, in double."""
    return rows.astype(of.precision.dtype).astype(np.float64)


@dataclass(frozen=True)
class Completing:
    """The programs that complete a sample: set-up, the rate of omega, and the plan of a step."""

    setup: Plan
    rate: Plan | None
    plan: Plan | None


def completing(library: Library) -> Completing:
    """Return what completes the samples of a scene."""
    plans = [f for f in library.motions if f.makes("plan")]
    rate, plan = (planned(p[0]) if p else None for p in (telling(library), plans))
    return Completing(planned(library.setup), rate, plan)


def complete(of: Ranges, by: Completing, rows: Column) -> Known:
    """Return samples with times in reach, the plan, and the constants."""
    dtype = of.precision.dtype
    own: dict[str, Column] = dict(zip(of.names, rows.astype(dtype), strict=True))
    own |= {
        c: own[c] * np.abs(own[c.removeprefix(f"{REMAINDER}_")]) * dtype(of.precision.unit_roundoff)
        for q in of.quantities
        for c in q.components
        if q.role == "remainder"
    }
    table = arithmetics(of.precision.dtype)
    with np.errstate(all="ignore"):
        made = known(by.setup, own, table)
        if "omega_x" in own and {"time_step", "time"} & own.keys():
            own = _in_reach(of, own, _omega_rate(by.rate, made, table))
            made = known(by.setup, own, table)
        if by.plan is not None:
            found = in_columns(by.plan, table.own, made.own)
            count = rows.shape[1]
            columns: Any = (np.broadcast_to(x, (count,)).astype(of.precision.dtype) for x in found)
            own |= dict(zip(component_names(by.plan.program), columns, strict=True))
            made = known(by.setup, own, table)
    return made


def _omega_rate(rate: Plan | None, made: Known, table: Any) -> Any:
    if rate is None:
        return 0.0
    columns = in_columns(rate, table.own, made.own)
    named = zip(component_names(rate.program), columns, strict=True)
    own = [np.abs(c).astype(np.float64) for name, c in named if name in OMEGA_DOT]
    return np.max(np.nan_to_num(np.broadcast_arrays(*own)), axis=0)


def _in_reach(of: Ranges, own: dict[str, Column], fast: Any) -> dict[str, Column]:
    wide = {n: own[n].astype(np.float64) for n in own if n.startswith("omega_") or "time" in n}
    omega = np.max([np.abs(wide[f"omega_{axis}"]) for axis in "xyz"], axis=0)
    step, time = bounds_of_times(omega, fast)
    limits = {"time_step": step, "time": time}
    return own | {
        c: np.clip(wide[c], -limit, limit).astype(of.precision.dtype)
        for c, limit in limits.items()
        if c in own
    }
