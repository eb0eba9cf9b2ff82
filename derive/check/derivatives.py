"""CasADi's first and second derivatives beside differences of the programs, in 500 bits.

Along a direction nobody chose, at a sample and where formulas have cases of their own: at rest,
about each axis, at no turn and at half a turn. Where the differences from both sides disagree
there is no derivative, and nothing is said of CasADi's.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from math import inf
from random import Random
from typing import Any

import casadi
from flint import arb, ctx
from sympy import finite_diff_weights

from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library
from derive.program.largest import largest
from derive.program.program import Program, Quantity
from derive.program.run import results_by_name
from derive.verify.convergence import BITS
from derive.verify.measure import results
from derive.verify.operators import LONG_FLOATS
from derive.verify.sample import Sample

SHIFT = arb(2) ** -20  # exact; what formulas take for zero is less
NUMBERS = range(1, 7)
NEAR = tuple(2.0**-k for k in (10, 20, 30, 40, 60))
"""How far from an axis, and from zero: formulas lose digits next to where they have other cases."""
MOMENT, SAMPLES = "kg m^2", 3
SMOOTH, JUMP = 1e-9, 1e-3
"""How far derivatives of both sides may differ, and results: differences err by 2^-80 of the
fifth derivative; results move by 2^-20 of their slope, or they jump."""
GAP = 1e-5
"""Relative: a wrong slope is off by some of itself, a rounded one by 1e-16 times what cancels."""
REVERSE = True
ORDERS = ("first", "second (forward)", "second (reverse)")


@dataclass(frozen=True)
class Directed:
    """Where a function is differentiated, and along which direction."""

    name: str
    values: Mapping[str, float]
    direction: Mapping[str, float]


def derivatives(library: Library, module: Any, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether CasADi differentiates every function rightly, once and twice, or says NaN."""
    ordinary = [s for s in each if s.kind == "ordinary"][:SAMPLES]
    for program in library.printed() if ordinary else ():
        built = getattr(module, program.name)()
        wrong, missing = compared(library, program, built, ordinary)
        says = "; ".join(wrong[:1] or ["first and second ones", *missing[:3]])
        scene, outcome = library.scene.name, JUDGED[not wrong]
        yield Verdict(scene, program.name, "f64", "CasADi's derivatives", outcome, says)


def compared(
    library: Library, program: Program, function: Any, each: Sequence[Sample]
) -> tuple[list[str], list[str]]:
    """Return where CasADi's derivatives are wrong numbers, and where they are none but exist.

    each : the first of them with every place that may be special, the others as they are
    """
    takes = [q for q in program.inputs if q.role != "constants"]
    if len(takes) < len(program.inputs):
        takes = [*library.setup.inputs, *takes]
    names = [c for q in takes for c in q.components]
    differentiated = _differentiated(function)
    wrong, missing = [], []
    beside = NEAR if "select" in program.count else ()
    for place in places(takes, each, (0.0, *beside)):
        first, second = differences(library, program, place)
        given = ([w[c] for c in names] for w in (place.values, place.direction))
        own = (list(x.nonzeros()) for x in differentiated(*given))
        for says, found, true in zip(ORDERS, own, (first, second, second), strict=True):
            gap = _gap(found, true)
            if gap == inf:
                missing.append(f"no {says} one, {place.name}")
            elif gap > GAP:
                wrong.append(f"the {says} one, {place.name}, is wrong by {gap:.1g}")
    return wrong, missing


def places(
    takes: Sequence[Quantity], each: Sequence[Sample], beside: Sequence[float]
) -> Iterator[Directed]:
    """Yield samples, and the first with each input where a formula may have a case of its own.

    beside : how far from axes and zeros to go, relative to the sample
    """
    dice = Random(each[0].number)  # noqa: S311  no secret
    names = [c for q in takes for c in q.components]
    several = [{c: float(sample.values[c]) for c in names} for sample in each]
    plain = several[0]
    direction = {c: dice.uniform(-1, 1) * max(abs(plain[c]), 0.1) for c in names}
    for sample, values in zip(each, several, strict=True):
        yield Directed(f"at sample {sample.number}", values, direction)
    moments = [q.name for q in takes if q.unit == MOMENT and q.low is not None and q.low > 0]
    for one, other in combinations(moments, 2):
        yield Directed(f"{other} as {one}", plain | {other: plain[one]}, direction)
    if len(moments) > 1:
        yield Directed(
            "equal moments", plain | dict.fromkeys(moments, plain[moments[0]]), direction
        )
    for q in takes:
        for says, special in _special(q, [plain[c] for c in q.components], beside):
            own = dict(zip(q.components, special, strict=True))
            yield Directed(f"{q.name} {says}", plain | own, direction)


def _special(
    q: Quantity, plain: Sequence[float], beside: Sequence[float]
) -> Iterator[tuple[str, list[float]]]:
    if q.name == "parameters" or (q.low is not None and q.low > 0):
        return
    if q.shape == (4,):
        yield "no turn", [1.0, 0.0, 0.0, 0.0]
        yield "half a turn about x", [0.0, 1.0, 0.0, 0.0]
        yield "half a turn about z", [0.0, 0.0, 0.0, -1.0]
    if q.shape == (3, 3):
        yield "no turn", [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        yield "half a turn about x", [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0]
    if q.shape == (3,):
        for k, axis in enumerate("xyz"):
            for near in beside:
                near_axis = [x if i == k else near * x for i, x in enumerate(plain)]
                yield f"along {axis}{_apart(near)}", near_axis
    if q.shape in ((3,), (), (1,)):
        for near in beside:
            yield f"zero{_apart(near)}", [near * x for x in plain]


def _apart(near: float) -> str:
    return f", {near:.0e} of a sample beside" if near else ""


def differences(library: Library, program: Program, place: Directed) -> tuple[list[Any], list[Any]]:
    """Return first and second derivatives of each result, None where there is none."""
    with ctx.workprec(BITS):
        at = {k: _results(library, program, place, k) for n in NUMBERS for k in (n, -n)}
        once, again = (
            [
                [
                    _slope(order, [at[s * n][i] for n in NUMBERS], s)
                    for i in range(len(program.results))
                ]
                for s in (1, -1)
            ]
            for order in (1, 2)
        )
        jumps = [abs(float((a - b).mid())) for a, b in zip(at[1], at[-1], strict=True)]
        first = [x if jump < JUMP else None for x, jump in zip(_agreed(*once), jumps, strict=True)]
        second = [None if x is None else y for x, y in zip(first, _agreed(*again), strict=True)]
        return first, second


def _slope(order: int, values: Sequence[Any], side: int) -> Any:
    """Return a derivative from values at SHIFT, 2 SHIFT, ... to one side, by a polynomial."""
    terms = (int(w.p) * x / int(w.q) for w, x in zip(_weights(order), values, strict=True))
    return sum(terms, arb(0)) / (side * SHIFT) ** order


@cache
def _weights(order: int) -> list[Any]:
    """Return by which values at 1, 2, ... count in a polynomial's derivative at 0."""
    found: list[Any] = finite_diff_weights(order, [*NUMBERS], 0)[order][-1]
    return found


def _agreed(up: Sequence[Any], down: Sequence[Any]) -> list[float | None]:
    size = largest([1.0, *(abs(float(x)) for x in (*up, *down) if x.is_finite())])
    pairs = zip(up, down, strict=True)
    return [
        float(((x + y) / 2).mid()) if abs(float((x - y).mid())) < SMOOTH * size else None
        for x, y in pairs
    ]


def _results(library: Library, program: Program, place: Directed, k: int) -> list[Any]:
    known = {c: arb(x) + k * SHIFT * arb(place.direction[c]) for c, x in place.values.items()}
    names = [c for q in library.setup.inputs for c in q.components]
    if all(name in known for name in names):
        return list(results(library, program, known).values())
    return list(results_by_name(program, LONG_FLOATS, known).values())


def _differentiated(function: Any) -> Callable[[Any, Any], list[Any]]:
    """Return first derivatives forward, second ones forward, and second ones in reverse first."""
    sizes = [function.nnz_in(k) for k in range(function.n_in())]
    cuts = [sum(sizes[:k]) for k in range(len(sizes) + 1)]
    x, v, t = (casadi.MX.sym(name, n) for name, n in (("x", cuts[-1]), ("v", cuts[-1]), ("t", 1)))
    results = function.call(casadi.vertsplit(x + t * v, cuts))
    along = casadi.vertcat(*(casadi.sparsity_cast(y, y.sparsity()).nz[:] for y in results))
    weights = casadi.MX.sym("weights", along.numel())
    first = casadi.jtimes(along, t, 1)
    second = casadi.jtimes(first, t, 1)
    back = casadi.jtimes(casadi.jtimes(along, t, weights, REVERSE), t, 1)  # weights . second
    every = casadi.jacobian(back, weights).T
    made = casadi.Function("derivatives", [x, v, t, weights], [first, second, every])
    return lambda a, b: [casadi.densify(y) for y in made(a, b, 0, 0)]


def _gap(own: Sequence[float], true: Sequence[float | None]) -> float:
    """Return the largest difference where there is a derivative, over the largest of them or 1."""
    size = largest([1.0, *(abs(y) for y in true if y is not None)])
    pairs = zip(own, true, strict=True)
    return largest([0.0, *(abs(x - y) for x, y in pairs if y is not None)]) / size
