"""A scene's report as one HTML page: the sentence, plots, tables, hard cases; no script in it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite

from markupsafe import Markup

from derive.emit.on_target import UNKNOWN, Cost, OnTarget
from derive.emit.templates import TEMPLATES
from derive.motion.runge_kutta.system import FLOW
from derive.report.courses import StepErrors
from derive.report.found import FunctionFigures
from derive.report.plots import COLOURS, PAINT, SHADES, Curve, Plot, svg
from derive.report.sentence import (
    TYPE_NAMES,
    choice,
    curves_worth,
    in_time,
    least,
    left_aside,
    of_step,
    said_of,
)
from derive.report.slim import SHAPES, STYLES, Slim, shared
from derive.report.whole import SceneReport
from derive.scene import argument
from derive.scene.declaration import Given

MOST = len(COLOURS)
PLACES = (
    *("step_taylor", "step_lie", "step_rk4", "step_split", "step_dmv", "step_split2"),
    *("step_split6", "flow_exact"),
)
"""The steps by their colours, the same in all plots; a variant has its step's, in another line."""
USELESS = 3.0
"""An error at the end above which a step follows nothing: it is not drawn."""
LEAST = 1e-17


@dataclass(frozen=True)
class StepRow:
    """A step in the table: weighted operations; by precision what the sentence's error takes."""

    name: str
    wanted: bool
    operations: int
    lengths: dict[str, str]
    spent: dict[str, str]
    least: dict[str, str]
    times: dict[str, str]
    instructions: dict[str, str]


@dataclass(frozen=True)
class FunctionRow:
    """A function in one form: weighted operations; by precision errors, times, instructions."""

    name: str
    form: str
    operations: int
    errors: dict[str, str]
    times: dict[str, str]
    instructions: dict[str, str]


def report_page(found: SceneReport, pages: Mapping[str, str], on_target: OnTarget = UNKNOWN) -> str:
    """Return the text of ``<scene>_report.html``.

    pages     : what it leads to, as seen from it, with the words to say
    on_target : what functions cost on cores
    """
    motion = found.motion
    moving = [] if motion is None else list(motion_plots(found, motion))
    standing = list(function_plots(found))
    page = TEMPLATES.get_template("scene_report.html.jinja").render(
        report=found,
        pages=pages,
        on_target=by_function(on_target),
        scene=found.library.scene,
        argument=argument(found.library.scene),
        motion=motion,
        aside=[] if motion is None else left_aside(motion),
        target="" if motion is None else figure(said_of(motion).target),
        says=TYPE_NAMES,
        plots=moving,
        steps=[] if motion is None else [_step_row(found, motion, s) for s in found.wished.steps],
        floors={} if motion is None else {p: figure(max(e)) for p, e in motion.floors.items()},
        functions=_function_rows(found),
        function_plots=standing,
        hard=[h for h in found.hard if h.why],
        easy=[h for h in found.hard if not h.why],
        refused=_refused(found),
        outside=outside(found.motion, found.library.scene.time_step),
        figure=figure,
        drawing=lambda plot: Markup(plot.text),  # noqa: S704 (our own SVG, its words escaped)
        styles=Markup(STYLES),  # noqa: S704 (our own words)
        shapes=Markup(SHAPES),  # noqa: S704
        shades={PAINT[day]: (day, night) for day, night in SHADES.items()},
    )
    others = [one for _, whole, more in moving for one in (whole, *more)]
    return shared(page, [*others, *standing])


def by_function(on_target: OnTarget) -> list[Cost]:
    """Return what functions cost on cores, those of one function beside each other."""
    order = list(dict.fromkeys(c.function for c in on_target.each))
    return sorted(on_target.each, key=lambda c: order.index(c.function))


def motion_plots(found: SceneReport, motion: StepErrors) -> Iterator[tuple[str, Slim, list[Slim]]]:
    """Yield for each precision a heading, its plot, and plots of the steps left out of it."""
    times = {(t.function, t.precision): t.median for t in found.times}
    for precision, says in TYPE_NAMES.items():
        first, rest = curves_worth(motion, precision, MOST)
        groups = [first, *(rest[n : n + MOST] for n in range(0, len(rest), MOST))]
        whole, *others = (_plot(motion, precision, own, None) for own in groups)
        if times:
            others.append(_plot(motion, precision, first, times))
        yield says, whole, others


def _plot(
    motion: StepErrors,
    precision: str,
    steps: Sequence[str],
    times: dict[tuple[str, str], float] | None,
) -> Slim:
    curves = []
    for step in steps:
        cost = motion.costs[step] if times is None else times[step, precision] * 1e-3
        own = [a for a in of_step(motion, step, precision) if a.worst < USELESS]
        if own:
            x = [cost * a.count / motion.time for a in own]
            name = step.removeprefix("step_").replace("_compensated", " comp.")
            y = [max(a.worst, LEAST) for a in own]
            curves.append(Curve(name, x, y, *_look(step), star=step == FLOW))
    unit = "weighted operations" if times is None else "microseconds"
    floor = max(motion.floors[precision])
    words = f"Error at the end, {TYPE_NAMES[precision]}, against {unit} for one second of motion."
    ends = [(c.name, figure(max(c.y)), figure(min(c.y))) for c in curves]
    least = "; ".join(f"{name} from {high} down to {low}" for name, high, low in ends)
    return svg(Plot(
        curves, f"{unit} for one second of motion", "error at the end, hardest state",
        f"{words} {least}.", ("rounding of data", floor) if isfinite(floor) and floor > 0 else None,
    ))  # fmt: skip


def _look(step: str) -> tuple[int, str]:
    """Return place and line of a step: dotted if it carries remainders, dashed if of an order."""
    base = "step_taylor" if step.startswith("step_taylor") else step.removesuffix("_compensated")
    return PLACES.index(base), "-" if base == step else ":" if "comp" in step else "--"


def function_plots(found: SceneReport) -> Iterator[Slim]:
    """Yield plots of the functions' errors against weighted operations, so many functions each."""
    names = list(dict.fromkeys(f.function for f in found.figures))
    for start in range(0, len(names), MOST):
        curves = []
        for place, name in enumerate(names[start : start + MOST]):
            own = [f for f in found.figures if (f.function, f.precision) == (name, "f64")]
            kept = [f for f in own if isfinite(f.largest) and f.largest > 0]
            x = [max(f.weighted_operations, 1) for f in kept]
            curves.append(Curve(name, x, [f.largest for f in kept], place))
        words = "; ".join(f"{c.name}: {', '.join(figure(y) for y in c.y)} u" for c in curves)
        yield svg(Plot(
            curves, "weighted operations of a call", "largest error, u of the largest product",
            f"Largest error in double against weighted operations, in both forms. {words}.",
        ))  # fmt: skip


def _step_row(found: SceneReport, motion: StepErrors, step: str) -> StepRow:
    target = said_of(motion).target
    chosen = {p: choice(motion, step, p, target) for p in TYPE_NAMES}
    best = {p: least(motion, p, [step]) for p in TYPE_NAMES}
    return StepRow(
        step, step in found.wished.own, motion.costs[step],
        {p: "–" if c is None else "at once" if step == FLOW else in_time(c.attempt.length)
         for p, c in chosen.items()},
        {p: "–" if c is None else figure(c.operations) for p, c in chosen.items()},
        {p: figure(x) for p, x in best.items()},
        _times(found, step, found.library.scene.form),
        _instructions(found, step, found.library.scene.form),
    )  # fmt: skip


def _function_rows(found: SceneReport) -> list[FunctionRow]:
    by: dict[tuple[str, str], list[FunctionFigures]] = {}
    for f in found.figures:
        by.setdefault((f.function, f.form), []).append(f)
    return [
        FunctionRow(
            name, form, own[0].weighted_operations,
            {f.precision: f"{figure(f.median)} / {figure(f.largest)}" for f in own},
            _times(found, name, form),
            _instructions(found, name, form),
        )
        for (name, form), own in sorted(by.items(), key=lambda item: _place(found, item[0][0]))
    ]  # fmt: skip


def _place(found: SceneReport, function: str) -> int:
    return [f.function for f in found.figures].index(function)


def _times(found: SceneReport, function: str, form: str) -> dict[str, str]:
    own = [t for t in found.times if (t.function, t.form) == (function, form)]
    return {t.precision: f"{figure(t.median)} ({figure(t.low)} … {figure(t.high)})" for t in own}


def _instructions(found: SceneReport, function: str, form: str) -> dict[str, str]:
    own = [c for c in found.instructions if (c.function, c.form) == (function, form)]
    return {c.precision: figure(c.count) for c in own}


def outside(motion: StepErrors | None, time_step: Given) -> list[str]:
    """Return the lengths that the sentence names outside the range of ``time_step``."""
    low, high = float(time_step.low or 0), float(time_step.high or 0)
    chosen = said_of(motion).choices.values() if motion else ()
    lengths = [c.attempt.length for c in chosen if c and c.attempt.step != FLOW]
    return [*dict.fromkeys(in_time(x) for x in lengths if not low <= x <= high)]


def _refused(found: SceneReport) -> dict[str, list[str]]:
    """Return the steps that cannot be wanted, by the reason."""
    by: dict[str, list[str]] = {}
    for name, why in found.wished.refused.items():
        said = why.partition(" (did you mean")[0].replace(f"'{name}'", "it")
        said = said.removeprefix("wanted has it, which is ")
        by.setdefault(said, []).append(name)
    return by


def figure(x: float) -> str:
    """Return a number in two digits, as people write it.

    >>> figure(3.21e-9), figure(0.25), figure(99.7), figure(12345.0), figure(float("inf"))
    ('3.2e-9', '0.25', '100', '12\u202f345', 'no number')
    """
    if not isfinite(x):
        return "no number"
    x = float(f"{x:.2g}") if abs(x) < 1e2 else x
    if x == 0 or 1e-2 <= abs(x) < 1e2:
        return f"{x:.2g}"
    if 1e2 <= abs(x) < 1e5:
        return f"{x:,.0f}".replace(",", "\u202f")
    digits, exponent = f"{x:.1e}".split("e")
    return f"{digits.removesuffix('.0')}e{int(exponent)}"
