"""Columns of samples on the declared ranges, any number of them, the same on every machine.

The bits are Philox's, whose stream NumPy keeps; numbers are made of them by basic operations. A
sample is complete when times are in reach and a plan is made; what completes it is worked out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from random import Random
from typing import Any

import numpy as np

from derive.library.library import Library
from derive.motion.compensated import REMAINDER
from derive.program.precision import Precision
from derive.program.program import Quantity, component_names, placed
from derive.scene import Input, SceneError
from derive.scene.formula import Formula, symbols
from derive.verify.columns import Plan, Supplied, arithmetics, in_columns, planned, supplied
from derive.verify.equations import Equations, stated
from derive.verify.hard_bodies import admissible, solvable
from derive.verify.operators import Column
from derive.verify.sample import Sample, source, uniform

FEWEST = 1 / 64
"""Where fewer bodies than this obey the triangle inequality, any definite tensor will do."""
TRIES = 400
REACH = 0.3
"""Turn in rad, by what turns and by its rate, that a sampled step covers at most."""
FAST = "rad/s"
LONG = 1000.0
"""So many such steps make the longest time that a flow is sampled at."""


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
class Sampled:
    """The functions of a scene in one precision: where they are sampled, and what says what."""

    library: Library
    precision: Precision

    @cached_property
    def quantities(self) -> tuple[Quantity, ...]:
        """Return what is drawn: parameters, what varies, and what motions are given besides."""
        return (*self.library.vocabulary.given(), *fresh_quantities(self.library))

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

    @cached_property
    def bodies(self) -> Any:
        """Return what tells bodies: the triangle inequality too, if enough of the ranges keep it.

        A tensor that breaks it will do where the ranges hold hardly any other.
        """
        tried = held(self, _anywhere(self, Dice("bodies"), 4096))
        fits = admissible(self.library.scene, dict(zip(self.names, tried, strict=True)))
        return solvable if np.mean(fits) < FEWEST else admissible

    @cached_property
    def plans(self) -> tuple[Plan, ...]:
        """Return every function, with the places at which its values can go."""
        return tuple(map(planned, self.library.printed()))

    @cached_property
    def setup(self) -> Plan:
        """Return what makes the constants."""
        return planned(self.library.setup)

    @cached_property
    def turning(self) -> tuple[str, ...]:
        """Return what the axes of the scene's frames turn by: speeds and rates of angles."""
        scene = self.library.scene
        angles = {n for f in scene.frames for turn in f.turned for n in symbols(turn.angle)}
        given = [x for f in scene.frames for x in f.angular_velocity or ()]
        rates = [c.rate for c in scene.coordinates if c.name in angles]
        given += [r for r in rates if isinstance(r, Formula)]
        by = {n for f in given for n in symbols(f)}
        by |= {r.name for r in rates if isinstance(r, Input)}
        fast = (q for q in self.quantities if q.unit == FAST)
        return tuple(c for q in fast for c in q.components if c in by)

    @cached_property
    def rate(self) -> Plan | None:
        """Return a function that tells how fast what turns changes, if there is one."""
        every = (*self.library.rates, *self.library.functions)
        telling = (f for f in every if {*self.rates_of_turning} & {*component_names(f)})
        return next(map(planned, telling), None)

    @cached_property
    def rates_of_turning(self) -> tuple[str, ...]:
        """Return the names of the rates of what turns."""
        each = self.library.scene.groups.rate_of_each()
        return tuple(each[c] for c in self.turning if c in each)

    @cached_property
    def plan(self) -> Plan | None:
        """Return what makes the plan of a step, if there is one."""
        return next((planned(f) for f in self.library.motions if f.makes("plan")), None)

    @cached_property
    def equations(self) -> Mapping[str, Equations]:
        """Return the equations behind every function of the lecture, by its name."""
        return stated(self.library)

    @property
    def smallest(self) -> float:
        """Return the smallest normal number, below which floats are spaced alike."""
        return float(np.finfo(self.precision.dtype).smallest_normal)


def fresh_quantities(library: Library) -> list[Quantity]:
    """Return what only the functions of motion are given, but for a plan, which is made."""
    known = {c for q in library.vocabulary.every() for c in q.components}
    known |= set(component_names(library.setup))
    given = {q.name: q for f in library.motions for q in f.inputs}
    return [q for q in given.values() if not known & set(q.components) and q.role != "plan"]


def _ends(q: Quantity) -> tuple[float, float]:
    """Return the ends of a range; a remainder is drawn as a part of u times its state."""
    low, high = (-1, 1) if q.role == "remainder" else q.ends
    return float(low), float(high)


def drawn(of: Sampled, dice: Dice, count: int) -> Column:
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
        f"scene '{of.library.scene.name}': the ranges of its parameters must hold a body, "
        f"but only {count - missing} were found in {TRIES} tries of {count}"
    )


def _anywhere(of: Sampled, dice: Dice, count: int) -> Column:
    across = (of.highs - of.lows)[:, None]
    return on_the_sphere(of, of.lows[:, None] + across * dice.uniform(len(of.names), count))


def on_the_sphere(of: Sampled, rows: Column) -> Column:
    """Return rows with every quaternion of the states of unit length."""
    for q, span in placed(of.quantities):
        if q in of.library.vocabulary.states and q.is_quaternion:
            w, x, y, z = rows[span]
            size = np.sqrt(w * w + x * x + y * y + z * z)
            rows[span] = rows[span] / np.where(size > 0, size, 1.0)
    return rows


def admitted(of: Sampled, rows: Column) -> Any:
    """Return which samples are of bodies that can be, wheels included."""
    fits = of.bodies(of.library.scene, dict(zip(of.names, held(of, rows), strict=True)))
    return np.broadcast_to(fits, (rows.shape[1],))


def held(of: Sampled, rows: Column) -> Column:
    """Return numbers as floats of the precision, in double."""
    return rows.astype(of.precision.dtype).astype(np.float64)


def complete(of: Sampled, rows: Column) -> Supplied:
    """Return samples with remainders of their states, times in reach, the plan, and constants."""
    dtype = of.precision.dtype
    own: dict[str, Column] = dict(zip(of.names, rows.astype(dtype), strict=True))
    own |= {
        c: own[c] * np.abs(own[c.removeprefix(f"{REMAINDER}_")]) * dtype(of.precision.unit_roundoff)
        for q in of.quantities
        for c in q.components
        if q.role == "remainder"
    }
    return completed(of, own)


def completed(of: Sampled, own: dict[str, Column]) -> Supplied:
    """Return samples, by component, with times in reach, the plan, and the constants."""
    dtype, each = of.precision.dtype, arithmetics(of.precision.dtype)
    with np.errstate(all="ignore"):
        made = supplied(of.setup, own, each)
        if of.turning and {"time_step", "time"} & own.keys():
            own = _in_reach(of, own, _fastest_rate(of, made, each))
            made = supplied(of.setup, own, each)
        if of.plan is not None:
            count = len(next(iter(own.values())))
            found = in_columns(of.plan, each.own, made.own)
            columns: Any = (np.broadcast_to(x, (count,)).astype(dtype) for x in found)
            own |= dict(zip(component_names(of.plan.program), columns, strict=True))
            made = supplied(of.setup, own, each)
    return made


def _fastest_rate(of: Sampled, made: Supplied, each: Any) -> Any:
    if of.rate is None:
        return 0.0
    columns = in_columns(of.rate, each.own, made.own)
    named = zip(component_names(of.rate.program), columns, strict=True)
    own = [np.abs(c).astype(np.float64) for name, c in named if name in of.rates_of_turning]
    return np.max(np.nan_to_num(np.broadcast_arrays(*own)), axis=0)


def _in_reach(of: Sampled, own: dict[str, Column], fast: Any) -> dict[str, Column]:
    """Return samples with times in which axes turn by no more than a step can take."""
    speed = np.max([np.abs(own[c].astype(np.float64)) for c in of.turning], axis=0)
    step = REACH / np.maximum(np.maximum(speed, np.sqrt(fast)), 1e-300)
    limits = {"time_step": step, "time": LONG * step}
    return own | {
        c: np.clip(own[c].astype(np.float64), -limit, limit).astype(own[c].dtype)
        for c, limit in limits.items()
        if c in own
    }


def with_motion(
    library: Library, each: Sequence[Sample], precision: Precision
) -> tuple[Sample, ...]:
    """Return the samples with values for all that only the functions of motion are given."""
    if not library.motions or not each:
        return tuple(each)
    of, dice = Sampled(library, precision), source(library.mechanism, precision, "motion").dice
    fresh = [(c, q) for q in fresh_quantities(library) for c in q.components]
    rows = [s.values | {c: _drawn(of, dice, s, c, q) for c, q in fresh} for s in each]
    columns: dict[str, Column] = {
        c: np.array([row[c] for row in rows], precision.dtype) for c in rows[0]
    }
    at = completed(of, columns).own
    names = (*columns, *(component_names(of.plan.program) if of.plan else ()))
    numbers = zip(*(at[c].tolist() for c in names), strict=True)
    return tuple(
        replace(s, values=dict(zip(names, own, strict=True)))
        for s, own in zip(each, numbers, strict=True)
    )


def _drawn(of: Sampled, dice: Random, sample: Sample, component: str, q: Quantity) -> float:
    """Return a number on a range; a remainder is what rounding may leave of its state."""
    if q.role != "remainder":
        return uniform(dice, q)
    state = sample.values[component.removeprefix(f"{REMAINDER}_")]
    return of.precision.unit_roundoff * abs(state) * (2 * dice.random() - 1)
