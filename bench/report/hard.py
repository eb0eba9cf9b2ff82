"""Hard cases: what a naive form loses and what ours keeps, in float and in double.

A figure is omega (relative) / attitude (rad) for motions, omega alone where a form gives no more,
and one number for formulas.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import TypeVar

from bench.build import BuildError
from bench.motion.case import Case
from bench.motion.ours import parameters, scenes_for
from bench.motion.runner import Job, Mover, moved
from bench.motion.textbook import PUBLISHED, RK4, published, textbook
from bench.motion.textbook import parameters as textbook_parameters
from bench.motion.wrong import ROUNDOFF, Wrong, wrong
from bench.report.case_run import PRECISIONS, Workshop
from bench.report.elliptic import elliptic
from bench.report.settings import steps
from derive.program.largest import largest

Figures = Mapping[str, tuple[float, ...]]
T = TypeVar("T")


@dataclass(frozen=True)
class Hard:
    """A hard case: figures by precision of a naive form and of ours.

    bound : what ours must keep to, with ``why``; every figure is compared with it
    """

    name: str
    measure: str
    naive: str
    naive_found: Figures
    ours: str
    ours_found: Figures
    bound: Mapping[str, float]
    why: str

    def holds(self, precision: str) -> bool:
        """Tell whether ours keeps to its bound."""
        return self._keeps(self.ours_found, precision)

    def naive_holds(self, precision: str) -> bool:
        """Tell whether the naive form keeps to it too."""
        return self._keeps(self.naive_found, precision)

    def _keeps(self, found: Figures, precision: str) -> bool:
        return largest(found.get(precision, (math.nan,))) <= self.bound[precision]


@dataclass(frozen=True)
class Asked:
    """A hard motion: the case, the naive and our method.

    bound : double and float, with ``why``; without one it is ``KAPPAS`` kappa u
    """

    case: str
    says: str
    naive: str
    ours: str
    bound: tuple[float, float] | None = None
    why: str = "4 kappa u: what rounded inputs do, and as much again for rounding"


KAPPAS = 4.0
EXACT_INPUTS = "the inputs are exact floats, so kappa u is no excuse"
ELLIPTIC = "textbook elliptic functions"
ROD, ROD_BOUNDS = "rod with I3/I1 = 7e-9", (5e-14, 2e-5)
MOTIONS = (
    Asked("dzhanibekov_2e-20", "flip about the intermediate axis, 2^-20", RK4, "flow_exact"),
    Asked("dzhanibekov_2e-20", "flip about the intermediate axis, 2^-20", ELLIPTIC, "flow_exact"),
    Asked("separatrix_40", "on the separatrix for 40 s", RK4, "flow_exact",
          (1e-13, 5e-5), EXACT_INPUTS),
    Asked("oblate_nearly_sym", "I1 and I2 differ by 2^-26", RK4, "flow_exact"),
    Asked("rod_7e-9", ROD, PUBLISHED, "step_dmv", ROD_BOUNDS, EXACT_INPUTS),
    Asked("rod_7e-9", ROD, ELLIPTIC, "flow_exact", ROD_BOUNDS, EXACT_INPUTS),
    Asked("sphere", "sphere for 1000 s", ELLIPTIC, "flow_exact"),
    Asked("sphere", "sphere for 1000 s", RK4, "flow_exact"),
    Asked("spin_1e4", "1e4 rad/s, 1 rad a step", RK4, "flow_exact"),
    Asked("spin_1e4", "1e4 rad/s, 1 rad a step", RK4, "step_split6", (1e-11, 6e-4),
          "36 u a step: 2500 equal steps round alike, so it adds up; in float 4 kappa u"),
)  # fmt: skip
LEAST_KAPPA = 8.0  # 16 u where the inputs hardly matter: the steps round too


def motions(every: Mapping[str, Case], shop: Workshop) -> Iterator[Hard]:
    """Yield the rows of hard motions of the reference cases."""
    for asked in MOTIONS:
        if asked.case in every:
            case = every[asked.case]
            kappa = max(case.kappa or LEAST_KAPPA, LEAST_KAPPA)
            yield Hard(
                asked.says,
                "omega / attitude",
                asked.naive,
                by_precision(partial(best, case, asked.naive, shop)),
                asked.ours,
                by_precision(partial(best, case, asked.ours, shop)),
                dict(zip(PRECISIONS, asked.bound, strict=True))
                if asked.bound
                else {p: KAPPAS * kappa * ROUNDOFF[p] for p in PRECISIONS},
                asked.why,
            )


SCALES = {"f64": (-360, 300), "f32": (-70, 60)}
SCALED = tuple(
    "inertia times " + " / ".join(f"2^{SCALES[p][place]} {p}" for p in PRECISIONS)
    for place in (0, 1)
)
"""Names of the rows of bodies whose moments are far from 1."""


def scaled(every: Mapping[str, Case], shop: Workshop) -> Iterator[Hard]:
    """Yield the rows of bodies whose moments are far from 1."""
    base = every["tiny_scale_f32"]
    for place, name in enumerate(SCALED):
        powers = {p: SCALES[p][place] for p in PRECISIONS}
        cases = {p: _times(base, Fraction(2) ** (70 + powers[p])) for p in PRECISIONS}
        kappa = base.kappa or LEAST_KAPPA
        for ours in ("flow_exact", "step_dmv"):
            yield Hard(
                name,
                "omega / attitude",
                PUBLISHED,
                by_precision(partial(_best_of, cases, PUBLISHED, shop)),
                ours,
                by_precision(partial(_best_of, cases, ours, shop)),
                {p: 4 * kappa * ROUNDOFF[p] for p in PRECISIONS},
                "4 kappa u, as without the scale: powers of two are exact",
            )


def _times(case: Case, factor: Fraction) -> Case:
    return replace(case, inertia=tuple(x * factor for x in case.inertia))


Program = tuple[Mover, Sequence[float]]


def program(case: Case, method: str, shop: Workshop, precision: str) -> Program:
    """Return the first of ``programs``."""
    return programs(case, method, shop, precision)[0]


def programs(case: Case, method: str, shop: Workshop, precision: str) -> list[Program]:
    """Return the programs that hold a method for a case, and the numbers they take.

    Ours are one a scene that describes the case. Raises BuildError if there is none.
    """
    if method == PUBLISHED:
        built = published(precision, shop.folder / f"published_{precision}")
        return [(built, textbook_parameters(case))]
    if method == RK4:
        built = textbook(case, precision, shop.folder / f"textbook_{case.name}_{precision}")
        return [(built, textbook_parameters(case))]
    found: list[Program] = [
        (mover, parameters(shop.emissions[scene], case))
        for scene in scenes_for(case)[::-1]
        for mover in [shop.movers.get((scene, precision))]
        if isinstance(mover, Mover) and method in mover.methods
    ]
    if not found:
        raise BuildError(f"no scene holds '{method}' for case '{case.name}'")
    return found


def _best_of(
    cases: Mapping[str, Case], method: str, shop: Workshop, precision: str
) -> tuple[float, ...]:
    return best(cases[precision], method, shop, precision)


def best(case: Case, method: str, shop: Workshop, precision: str) -> tuple[float, ...]:
    """Return the errors of omega and attitude with the best of the steps that are tried.

    Of several scenes that describe the case, those of the scene that errs most.
    """
    if method == ELLIPTIC:
        return (elliptic(case, precision),)
    each = [_best(case, method, shop, own) for own in programs(case, method, shop, precision)]
    chosen = max(each, key=lambda w: largest([w.state]))
    return chosen.omega, chosen.attitude


def _best(case: Case, method: str, shop: Workshop, own: Program) -> Wrong:
    mover, given = own
    if method.startswith("flow_"):
        jobs = [Job(method, float(case.time), 1)]
    else:
        counts = [n for n in steps(case, shop.limits) if n >= float(case.time) * case.rate]
        jobs = [Job(method, float(case.time) / n, n) for n in _tried(case, counts)]
    found = moved(mover, case, given, jobs)
    every = [wrong(case, m.states[-1]) for m in found if m] or [Wrong(*[math.nan] * 4)]
    return min(every, key=lambda w: largest([w.state]))


def _tried(case: Case, counts: Sequence[int]) -> Sequence[int]:
    """Return numbers of steps: about 1 rad a step for the fast spin, all of them otherwise."""
    return counts[:1] if case.name == "spin_1e4" else counts


def by_precision(found: Callable[[str], T]) -> dict[str, T]:
    """Return what is found in each precision; nothing where a program or package is missing."""
    figures: dict[str, T] = {}
    for precision in PRECISIONS:
        try:
            figures[precision] = found(precision)
        except (BuildError, ImportError):
            continue
    return figures
