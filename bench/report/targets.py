"""What was to be reached, what was measured, and whether it was."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from bench.build import O3_NATIVE
from bench.motion.case import cases
from bench.motion.step_jacobian import Entry
from bench.motion.textbook import DOP853
from bench.motion.wrong import ROUNDOFF
from bench.own import AUTHOR
from bench.report.case_run import PRECISIONS, Found
from bench.report.counts import BYTES, COMPACT, DERIVED, SPECIAL, STEPPERS, THIRTEEN, Count
from bench.report.curve import by_scene, cost_in_all, instructions, seconds
from bench.report.gyroscopic import ASPHERICITIES, Gyroscopic
from bench.report.gyroscopic import SCENES as FORMS
from bench.report.hard import ROD, ROD_BOUNDS, SCALED, Hard
from bench.report.hard_long import CASE, COUNT, bounds, row_name
from bench.report.hard_spin import NAMES as SPINS
from bench.report.point import Point
from derive.program.largest import largest

SAYS = {"f64": "double", "f32": "float"}
GENERIC, TOP = "asym_ii_generic", "heavy_top_asymmetric"
EXACT, DMV, TAYLOR = "flow_exact", "step_dmv", "step_taylor"
HEYOKA = "heyoka (Taylor)"
USUAL = 0.1  # rad a step
NOT = "not measured"


@dataclass(frozen=True)
class Target:
    """One target: what, the limit, what was measured; ``reached`` is None if it was not measured.

    only : the part of the report that shows it, for `python -m bench.report --only`
    """

    says: str
    limit: str
    measured: str
    reached: bool | None
    only: str


@dataclass(frozen=True)
class Evidence:
    """What a run found, as far as targets rest on it; whatever it lacks is not measured."""

    found: Mapping[str, Found]
    hard: Sequence[Hard]
    tools: Sequence[Entry]
    gyroscopic: Sequence[Gyroscopic]
    counts: Sequence[Count]


Verdict = tuple[str, bool] | str
"""What was measured and whether it reaches the limit; or why that cannot be said."""


def targets(given: Evidence) -> Iterator[Target]:
    """Yield all targets in the order of their subjects: the same ones, whatever was found."""
    yield from _exact(given)
    yield from _dmv(given)
    yield from _long(given)
    yield from _faster(given, TOP, TAYLOR, 1e-11, 1.5)
    yield from _gyroscopic(given)
    yield from _derivatives(given)
    yield from _special(given)


def _target(says: str, limit: str, only: str, verdict: Verdict) -> Target:
    if isinstance(verdict, str):
        return Target(says, limit, verdict, None, only)
    return Target(says, limit, *verdict, only)


def _exact(given: Evidence) -> Iterator[Target]:
    for precision, units, calls in (("f64", 2.0, 6000), ("f32", 4.0, 4500)):
        says = f"flow_exact, {SAYS[precision]}"
        limit = "max(2 kappa u, 16 u)" if precision == "f64" else "4 kappa u"
        yield _target(f"{says}: error on every torque-free case", limit, "cases",
                      _exact_errors(given, precision, units))  # fmt: skip
        yield _target(f"{says}: instructions a call", f"{calls} Ir", "cases",
                      _exact_instructions(given, precision, calls))  # fmt: skip
    for name in SCALED:
        yield _target(f"{EXACT}, {name}", "no NaN, 4 kappa u", "hard", _hard(given, EXACT, name))
    for name in SPINS:
        yield _target(f"{EXACT}, {name}", "no NaN, kappa u", "hard", _hard(given, EXACT, name))


def _exact_points(given: Evidence, precision: str) -> dict[str, list[Point]]:
    """Return the points of the exact flow in every torque-free case, whether run or not."""
    names = [case.name for case in cases().values() if not case.torqued]
    return {name: _of(given, name, EXACT, precision) for name in names}


def _exact_errors(given: Evidence, precision: str, units: float) -> Verdict:
    points = _exact_points(given, precision)
    missing = [name for name, own in points.items() if not own]
    if missing:
        return f"{NOT}: {', '.join(missing)}"
    worst, name = max(
        (_units(given.found[name], p, units), name) for name, own in points.items() for p in own
    )
    return f"at most {worst:.2g} of it ({name})", worst <= 1


def _exact_instructions(given: Evidence, precision: str, calls: int) -> Verdict:
    points = _exact_points(given, precision)
    costs = {n: [p.instructions for p in own if p.instructions] for n, own in points.items()}
    missing = [name for name, own in points.items() if not own or len(costs[name]) < len(own)]
    if missing:
        return f"{NOT}: {', '.join(missing)}"
    most = max(max(own) for own in costs.values())
    return f"{most:.0f} Ir", most <= calls


def _units(found: Found, point: Point, units: float) -> float:
    """Return an error in units of what is allowed; infinite if it is not finite."""
    u = ROUNDOFF[point.precision]
    least = 16 * u if point.precision == "f64" else 0.0
    allowed = max(units * (found.case.kappa or 0.0) * u, least)
    return point.wrong.state / allowed if math.isfinite(point.wrong.state) else math.inf


def _hard(given: Evidence, ours: str, name: str, precisions: Sequence[str] = PRECISIONS) -> Verdict:
    """Return whether ours keeps the bound of a hard case in all of ``precisions``."""
    row = next((h for h in given.hard if (h.ours, h.name) == (ours, name)), None)
    if row is None:
        return NOT
    missing = [SAYS[p] for p in precisions if p not in row.ours_found]
    if missing:
        return f"{NOT}: {', '.join(missing)}"
    figures = [" / ".join(f"{x:.1e}" for x in row.ours_found[p]) for p in precisions]
    said = [f"{SAYS[p]} {own}" for p, own in zip(precisions, figures, strict=True)]
    shown = figures[0] if len(precisions) == 1 else "; ".join(said)
    return shown, all(row.holds(p) for p in precisions)


def _why_no_cost(
    points: Sequence[Point], error: float, cost: Callable[[Point], float | None]
) -> Verdict:
    """Return why ``cost_at`` finds nothing: no figure, or a curve that ends above the error."""
    known = [p.wrong.state for p in points if cost(p) is not None]
    finite = [e for e in known if math.isfinite(e)]
    if not known or min(finite, default=math.inf) <= error:
        return NOT
    return (f"ends at {min(finite):.1e}" if finite else "no finite error"), False


def _of(given: Evidence, case: str, method: str, precision: str = "f64") -> list[Point]:
    if case not in given.found:
        return []
    points = given.found[case].points
    return [p for p in points if (p.method, p.precision) == (method, precision)]


def _dmv(given: Evidence) -> Iterator[Target]:
    for precision, limit in (("f64", 600), ("f32", 360)):
        yield _target(f"step_dmv, {SAYS[precision]}: instructions a step", f"{limit} Ir", GENERIC,
                      _each_step(given, precision, limit))  # fmt: skip
    yield _target("step_dmv: the generic case to 1e-12", "1.0 M Ir", GENERIC, _generic(given))
    yield _target("step_dmv: below DOP853 in C, to 1e-12", "9 times", GENERIC,
                  _below_dop853(given))  # fmt: skip
    yield from _faster(given, GENERIC, DMV, 1e-12, 1.0)
    for precision, bound in zip(PRECISIONS, ROD_BOUNDS, strict=True):
        yield _target(f"step_dmv, {SAYS[precision]}: thin rod, I3/I1 = 7e-9", f"{bound:.0e}",
                      "hard", _hard(given, DMV, ROD, (precision,)))  # fmt: skip


def _each_step(given: Evidence, precision: str, limit: int) -> Verdict:
    """Return the most instructions of a step of about ``USUAL`` rad, over all cases and scenes."""
    each = [
        _near(own) for name in given.found for own in by_scene(_of(given, name, DMV, precision))
    ]
    counts = [(count / p.passes, p) for p, count in filter(None, each)]
    if not counts:
        return NOT
    most, p = max(counts, key=lambda pair: pair[0])
    return f"{most:.0f} Ir at {p.radians:.2g} rad a step, scene {p.scene}", most <= limit


def _near(points: Sequence[Point]) -> tuple[Point, float] | None:
    counts = [(p, p.instructions) for p in points if p.instructions is not None]
    return min(counts, key=lambda c: abs(math.log(c[0].radians / USUAL)), default=None)


def _generic(given: Evidence) -> Verdict:
    points = _of(given, GENERIC, DMV)
    ours = cost_in_all(points, 1e-12, instructions)
    if ours is None:
        return _why_no_cost(points, 1e-12, instructions)
    return f"{ours / 1e6:.2f} M Ir", ours <= 1e6


def _below_dop853(given: Evidence) -> Verdict:
    points = _of(given, GENERIC, DMV)
    ours = cost_in_all(points, 1e-12, instructions)
    dop = cost_in_all(_of(given, GENERIC, DOP853), 1e-12, instructions)
    if ours is None:
        return _why_no_cost(points, 1e-12, instructions)
    if dop is None:
        ends = min((p.wrong.state for p in _of(given, GENERIC, DOP853)), default=math.nan)
        return NOT if math.isnan(ends) else f"DOP853 in C ends at {ends:.1e}"
    return f"{dop / ours:.1f} times", dop / ours >= 9


def _faster(
    given: Evidence, case: str, method: str, error: float, times: float
) -> Iterator[Target]:
    """Yield whether a stepper of ours takes at most ``times`` heyoka's time to an error."""
    names = [method, f"{method}_adaptive"] if method == TAYLOR else [method]
    points = [_of(given, case, m) for m in names]
    costs = [
        (cost_in_all(own, error, seconds), name) for own, name in zip(points, names, strict=True)
    ]
    own, by = min(((c, name) for c, name in costs if c is not None), default=(None, ""))
    peer = cost_in_all(_of(given, case, HEYOKA), error, seconds)
    verdict: Verdict = NOT
    if own is None:
        verdict = _why_no_cost([p for each in points for p in each], error, seconds)
    elif peer is not None:
        times_said = f"{own * 1e6:.0f} against {peer * 1e6:.0f} microseconds"
        said = f"{own / peer:.2f} times ({by}, {times_said})"
        verdict = said, own / peer <= times
    yield _target(f"{method}: {case} to {error:.0e}, same run", f"{times:g} times heyoka's time",
                  case, verdict)  # fmt: skip


def _long(given: Evidence) -> Iterator[Target]:
    for what, bound in bounds(cases()[CASE], COUNT).items():
        row = row_name(COUNT, what)
        for precision in PRECISIONS:
            yield _target(f"step_dmv, {SAYS[precision]}: {row}", f"{bound[precision]:.0e}", "hard",
                          _hard(given, DMV, row, (precision,)))  # fmt: skip


def _gyroscopic(given: Evidence) -> Iterator[Target]:
    for form in FORMS:
        for precision in PRECISIONS:
            own = [g for g in given.gyroscopic if (g.form, g.precision) == (form, precision)]
            yield _target(f"gyroscopic term, form {form}, {SAYS[precision]}, any asphericity",
                          "1 u median, 16 u largest", "gyroscopic", _largest(own))  # fmt: skip


def _largest(own: Sequence[Gyroscopic]) -> Verdict:
    if {g.asphericity for g in own} != set(ASPHERICITIES):
        return NOT
    middle, worst = largest([g.median for g in own]), largest([g.largest for g in own])
    return f"{middle:.2f} u, {worst:.1f} u", middle <= 1 and worst <= 16


def _derivatives(given: Evidence) -> Iterator[Target]:
    ours = next((e for e in given.tools if e.author == AUTHOR), None)
    total = ours.flops.total if ours and ours.flops else None
    yield _target("RK4 step with its 7x7 Jacobian: operations", "840", "tools",
                  _at_most(total, 840, ""))  # fmt: skip
    count = ours.instructions.get(O3_NATIVE.name) if ours else None
    yield _target("RK4 step with its 7x7 Jacobian: -O3 -march=native", "1500 Ir", "tools",
                  _at_most(count, 1500, " Ir"))  # fmt: skip
    yield _target("RK4 step of 13 states with its derivatives: operations",
                  "half of CasADi's 5898", "tools",
                  _at_most(_counted(given, THIRTEEN, DERIVED, "operations"), 5898 / 2, ""),
                  )  # fmt: skip
    size = _counted(given, COMPACT, DERIVED, BYTES)
    yield _target("the same as loops, float: code for a Cortex-M4F", "4000 bytes", "tools",
                  _at_most(size, 4000, " bytes"))  # fmt: skip


def _at_most(found: float | None, limit: float, unit: str) -> Verdict:
    return NOT if found is None else (f"{found:.0f}{unit}", found <= limit)


def _counted(given: Evidence, scene: str, function: str, of: str) -> float | None:
    known = {(c.scene, c.function, c.of): c.count for c in given.counts}
    return known.get((scene, function, of))


def _special(given: Evidence) -> Iterator[Target]:
    """Yield whether what is known of a body makes its steppers smaller."""
    for method in STEPPERS:
        counts = [_counted(given, scene, method, "operations") for scene in SPECIAL]
        says = f"{method}: operations for a principal, axisymmetric, spherical body"
        yield _target(says, "falling", "functions", _falling(counts))


def _falling(counts: Sequence[float | None]) -> Verdict:
    known = [c for c in counts if c is not None]
    if len(known) < len(counts):
        return NOT
    return ", ".join(f"{c:.0f}" for c in known), all(a > b for a, b in pairwise(known))
