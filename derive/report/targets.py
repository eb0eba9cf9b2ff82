"""What was to be reached, what was measured, and whether it was."""

import math
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from derive.bench.build import BuildError, run
from derive.bench.motion.ours import Emission, emission
from derive.bench.motion.step_jacobian import Entry
from derive.bench.motion.textbook import DOP853
from derive.bench.motion.wrong import ROUNDOFF
from derive.largest import largest
from derive.report.case_run import PRECISIONS, Found
from derive.report.gyroscopic import Gyroscopic
from derive.report.hard import Hard
from derive.report.point import Point

SAYS = {"f64": "double", "f32": "float"}
GENERIC, TOP, ROD = "asym_ii_generic", "heavy_top_asymmetric", "rod_7e-9"
EXACT, DMV, TAYLOR = "flow_exact", "step_dmv", "step_taylor"
HEYOKA = "heyoka (Taylor)"
USUAL = 0.1  # rad a step


@dataclass(frozen=True)
class Target:
    """One target: what, the limit, what was measured; ``reached`` is None if it was not measured.

    only : the part of the report that shows it, for `derive report --only`
    """

    says: str
    limit: str
    measured: str
    reached: bool | None
    only: str


@dataclass(frozen=True)
class Evidence:
    """What a run found, as far as targets rest on it."""

    found: Mapping[str, Found]
    hard: Sequence[Hard]
    tools: Sequence[Entry]
    gyroscopic: Sequence[Gyroscopic]
    folder: Path


def targets(given: Evidence) -> Iterator[Target]:
    """Yield all targets in the order of their subjects."""
    yield from _exact(given)
    yield from _dmv(given)
    yield from _long(given)
    yield from _taylor(given)
    yield from _gyroscopic(given)
    yield from _derivatives(given)
    yield from _special()


def _exact(given: Evidence) -> Iterator[Target]:
    for precision, units, calls in (("f64", 2.0, 6000), ("f32", 4.0, 4500)):
        own = [
            (f, p)
            for f in given.found.values()
            for p in f.points
            if (p.method, p.precision) == (EXACT, precision)
        ]
        if own:
            worst, name = max((_units(f, p, units), f.case.name) for f, p in own)
            limit = "max(2 kappa u, 16 u)" if precision == "f64" else "4 kappa u"
            yield Target(f"flow_exact, {SAYS[precision]}: error on every torque-free case", limit,
                         f"at most {worst:.2g} of it ({name})", worst <= 1, "cases")  # fmt: skip
            costs = [p.instructions for _, p in own if p.instructions]
            if costs:
                yield Target(f"flow_exact, {SAYS[precision]}: instructions a call", f"{calls} Ir",
                             f"{max(costs):.0f} Ir", max(costs) <= calls, "cases")  # fmt: skip
    yield from _scales(given)


def _units(found: Found, point: Point, units: float) -> float:
    """Return an error in units of what is allowed; infinite if it is not finite."""
    u = ROUNDOFF[point.precision]
    least = 16 * u if point.precision == "f64" else 0.0
    allowed = max(units * (found.case.kappa or 0.0) * u, least)
    return point.wrong.state / allowed if math.isfinite(point.wrong.state) else math.inf


def _scales(given: Evidence) -> Iterator[Target]:
    for row in (h for h in given.hard if h.name.startswith(("inertia", "pure", "zero"))):
        if row.ours == EXACT:
            finite = all(math.isfinite(x) for own in row.ours_found.values() for x in own)
            both = row.ours_found and all(row.holds(p) for p in row.ours_found)
            yield Target(f"flow_exact, {row.name}", "no NaN, 4 kappa u",
                         _figures(row), bool(finite and both), "hard")  # fmt: skip


def _figures(row: Hard) -> str:
    return "; ".join(
        f"{SAYS[p]} " + " / ".join(f"{x:.1e}" for x in own) for p, own in row.ours_found.items()
    )


def instructions(point: Point) -> float | None:
    """Return a point's instructions."""
    return point.instructions


def seconds(point: Point) -> float | None:
    """Return a point's time."""
    return point.seconds


def cost_at(
    points: Sequence[Point], error: float, cost: Callable[[Point], float | None]
) -> float | None:
    """Return the cost of an error along a curve, between its points; None if it is not reached."""
    pairs = []
    for p in sorted(points, key=lambda p: -p.value):
        own = cost(p)
        if own is not None and p.wrong.state > 0 and math.isfinite(p.wrong.state):
            pairs.append((p.wrong.state, own))
    for (e0, c0), (e1, c1) in pairwise(pairs):
        if e1 <= error < e0:
            part = math.log(e0 / error) / math.log(e0 / e1)
            return math.exp(math.log(c0) + part * math.log(c1 / c0))
    return None


def _of(given: Evidence, case: str, method: str, precision: str = "f64") -> list[Point]:
    if case not in given.found:
        return []
    points = given.found[case].points
    return [p for p in points if (p.method, p.precision) == (method, precision)]


def _dmv(given: Evidence) -> Iterator[Target]:
    for precision, limit in (("f64", 600), ("f32", 360)):
        own = [p for p in _of(given, GENERIC, DMV, precision) if p.instructions]
        near = min(own, key=lambda p: abs(math.log(p.radians / USUAL)), default=None)
        if near and near.instructions:
            each = near.instructions / near.passes
            yield Target(f"step_dmv, {SAYS[precision]}: instructions a step", f"{limit} Ir",
                         f"{each:.0f} Ir at {near.radians:.2g} rad a step", each <= limit,
                         GENERIC)  # fmt: skip
    ours, dop = (cost_at(_of(given, GENERIC, m), 1e-12, instructions) for m in (DMV, DOP853))
    if ours is not None:
        yield Target("step_dmv: the generic case to 1e-12", "1.0 M Ir", f"{ours / 1e6:.2f} M Ir",
                     ours <= 1e6, GENERIC)  # fmt: skip
    if ours is not None:
        yield from _below_dop853(given, ours, dop)
    yield from _faster(given, GENERIC, DMV, 1e-12, 1.0)
    for row in (h for h in given.hard if h.ours == DMV and h.name.startswith("rod")):
        for precision, bound in (("f64", 5e-14), ("f32", 2e-5)):
            worst = largest(row.ours_found.get(precision, (math.nan,)))
            yield Target(f"step_dmv, {SAYS[precision]}: thin rod, I3/I1 = 7e-9", f"{bound:.0e}",
                         f"{worst:.1e}", worst <= bound, "hard")  # fmt: skip


def _below_dop853(given: Evidence, ours: float, dop: float | None) -> Iterator[Target]:
    if dop is None:
        best = min((p.wrong.state for p in _of(given, GENERIC, DOP853)), default=math.nan)
        said = f"DOP853 in C ends at {best:.1e}"
        yield Target("step_dmv: below DOP853 in C, to 1e-12", "9 times", said, None, GENERIC)
    else:
        yield Target("step_dmv: below DOP853 in C, to 1e-12", "9 times", f"{dop / ours:.1f} times",
                     dop / ours >= 9, GENERIC)  # fmt: skip


def _faster(
    given: Evidence, case: str, method: str, error: float, times: float
) -> Iterator[Target]:
    """Yield whether a stepper of ours takes at most ``times`` heyoka's time to an error."""
    names = [method, f"{method}_adaptive"] if method == TAYLOR else [method]
    costs = [cost_at(_of(given, case, m), error, seconds) for m in names]
    own = min((c for c in costs if c is not None), default=None)
    peer = cost_at(_of(given, case, HEYOKA), error, seconds)
    limit = f"{times:g} times heyoka's time"
    says = f"{method}: {case} to {error:.0e}, same run"
    if own is None or peer is None:
        yield Target(says, limit, "not measured", None, case)
    else:
        said = f"{own / peer:.2f} times ({own * 1e6:.0f} against {peer * 1e6:.0f} microseconds)"
        yield Target(says, limit, said, own / peer <= times, case)


def _long(given: Evidence) -> Iterator[Target]:
    for row in (h for h in given.hard if "steps of 0.01 s" in h.name):
        for precision in PRECISIONS:
            if precision in row.ours_found:
                yield Target(f"step_dmv, {SAYS[precision]}: {row.name}",
                             f"{row.bound[precision]:.0e}", f"{row.ours_found[precision][0]:.1e}",
                             row.holds(precision), "hard")  # fmt: skip


def _taylor(given: Evidence) -> Iterator[Target]:
    yield from _faster(given, TOP, TAYLOR, 1e-11, 1.5)


def _gyroscopic(given: Evidence) -> Iterator[Target]:
    for form in ("fast", "accurate"):
        for precision in PRECISIONS:
            own = [g for g in given.gyroscopic if (g.form, g.precision) == (form, precision)]
            if own:
                middle, largest = max(g.median for g in own), max(g.largest for g in own)
                yield Target(f"gyroscopic term, form {form}, {SAYS[precision]}, any asphericity",
                             "1 u median, 16 u largest", f"{middle:.2f} u, {largest:.1f} u",
                             middle <= 1 and largest <= 16, "gyroscopic")  # fmt: skip


def _derivatives(given: Evidence) -> Iterator[Target]:
    for entry in given.tools:
        if entry.author == "ours" and entry.flops:
            total = entry.flops.total
            yield Target("RK4 step with its 7x7 Jacobian: operations", "840", f"{total}",
                         total <= 840, "tools")  # fmt: skip
            if "O3-native" in entry.instructions:
                count = entry.instructions["O3-native"]
                yield Target("RK4 step with its 7x7 Jacobian: -O3 -march=native", "1500 Ir",
                             f"{count:.0f} Ir", count <= 1500, "tools")  # fmt: skip
    flops = next((f["cost"]["flops"] for f in emission("thirteen").manifest["functions"]
                  if f["name"] == "step_rk4_jacobian"), None)  # fmt: skip
    if flops is not None:
        yield Target("RK4 step of 13 states with its derivatives: operations",
                     "half of CasADi's 5898", f"{flops}", flops <= 5898 / 2, "tools")  # fmt: skip
    size = code_size(emission("compact"), given.folder)
    yield Target("the same as loops, float: code for a Cortex-M4F", "3000 bytes",
                 "no arm-none-eabi-gcc" if size is None else f"{size} bytes",
                 None if size is None else size <= 3000, "tools")  # fmt: skip


ARM = ("arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16",
       "-mfloat-abi=hard", "-Os", "-std=c99")  # fmt: skip


def code_size(made: Emission, folder: Path) -> int | None:
    """Return the bytes of code of ``step_rk4_jacobian`` in float on a Cortex-M4F."""
    functions = {f["name"]: f for f in made.manifest["functions"]}
    if not shutil.which(ARM[0]) or "step_rk4_jacobian" not in functions:
        return None
    place = folder / "arm"
    place.mkdir(parents=True, exist_ok=True)
    for name, text in made.texts.items():
        (place / name).write_text(text, encoding="utf-8")
    source = place / made.manifest["files"]["f32"]["source"]
    try:
        run((*ARM, "-ffunction-sections", "-c", str(source), "-o", str(place / "step.o")))
        said = run(("arm-none-eabi-size", "-A", str(place / "step.o"))).decode()
    except BuildError:
        return None
    symbol = functions["step_rk4_jacobian"]["symbols"]["f32"]
    rows = [line.split() for line in said.splitlines() if line.startswith((".text", ".rodata"))]
    return sum(int(r[1]) for r in rows if r[0] == ".text" + f".{symbol}" or "rodata" in r[0])


def _special() -> Iterator[Target]:
    """Yield whether what is known of a body makes its steppers smaller."""
    scenes = ("principal", "axisymmetric", "spherical")
    flops = {s: {f["name"]: f["cost"].get("flops") for f in emission(s).manifest["functions"]}
             for s in scenes}  # fmt: skip
    for name in (EXACT, DMV, "step_split6", "step_rk4", TAYLOR):
        counts = [flops[scene].get(name) for scene in scenes]
        known = [c for c in counts if c is not None]
        falls = len(known) == len(scenes) and known[0] > known[1] >= known[2]
        shown = " > ".join("none" if c is None else str(c) for c in counts)
        yield Target(f"{name}: operations for a principal, axisymmetric, spherical body", "falling",
                     shown, falls, "functions")  # fmt: skip
