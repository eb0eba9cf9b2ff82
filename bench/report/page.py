"""The report as one HTML page: light, without scripts, every plot inside it."""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from markupsafe import Markup

from bench.build import TOOLS
from bench.report.acts import acts
from bench.report.case_run import PRECISIONS, Found, attainable
from bench.report.drawn import SAYS, Plot, Plots, of_case, opening
from bench.report.look import look, shades
from bench.report.point import Point
from bench.report.proposals import proposal_says
from bench.report.recommend import ERRORS, advice, choice, overall, says, sentence
from bench.report.record import PACKAGES, RULES, Report, best, data, kinds
from bench.report.written import counted, figure
from derive import __version__
from derive.emit.templates import templates_of
from derive.report.slim import SHAPES, STYLES, shared

TEMPLATES = templates_of(Path(__file__).parent / "templates")
WORKERS = 2
CHOICE = 3  # steppers that are named for an error


@dataclass(frozen=True)
class Section:
    """A case as the page shows it."""

    found: Found
    shown: Plots
    folded: Sequence[Plots]
    advice: Sequence[tuple[str, str]]
    not_run: Sequence[tuple[str, str]]


def page(report: Report) -> str:
    """Return the text of ``report.html``."""
    figures = data(report)
    first, sections = opening(motions(report.found)), _sections(report.found)
    groups = [first, *(group for s in sections for group in (s.shown, *s.folded))]
    text = TEMPLATES.get_template("report.html.jinja").render(
        version=__version__,
        report=report,
        opening=first,
        sections=sections,
        acts=acts(report.found),
        overall=_overall(report),
        conditions=[_condition(f) for f in report.found],
        machine=figures["machine"],
        programs=(*TOOLS, *PACKAGES),
        rules=RULES,
        proposals=proposal_says(report.proposals),
        says=SAYS,
        precisions=PRECISIONS,
        shades=shades(),
        styles=Markup(STYLES),  # noqa: S704 (our own words, as all that is marked so here)
        shapes=Markup(SHAPES),  # noqa: S704
        drawn=_drawn,
        figure=figure,
        figures=_figures,
        number=counted,
    )
    return shared(text, [plot.drawn for group in groups for plot in group.plots])


def _drawn(plot: Plot) -> Markup:
    return Markup(plot.drawn.text)  # noqa: S704 (our own SVG)


def motions(found: Sequence[Found]) -> dict[str, dict[str, list[Point]]]:
    """Return the points of each case, by whether a torque acts."""
    every = {
        "without torque": {f.case.name: [*f.points] for f in found if not f.case.torqued},
        "with torque": {f.case.name: [*f.points] for f in found if f.case.torqued},
    }
    return {kind: own for kind, own in every.items() if own}


def _sections(found: Sequence[Found]) -> list[Section]:
    """Return the sections of all cases; drawing takes longest, so two are drawn at a time."""
    if len(found) == 1:
        return [_section(found[0])]
    with ProcessPoolExecutor(WORKERS) as pool:
        return list(pool.map(_section, found))


def _section(found: Found) -> Section:
    shown, *folded = of_case(found)
    words = [
        (f"{figure(error)}, {SAYS[precision]}", sentence(one))
        for precision in PRECISIONS
        for error in ERRORS[precision]
        for one in [advice(found.case.name, found.points, precision, error)]
    ]
    reasons: dict[str, dict[str, None]] = {}
    for n in found.not_run:
        reasons.setdefault(n.reason, {})[n.method] = None
    missing = [(", ".join(m), why) for why, m in reasons.items()]
    return Section(found, shown, [group for group in folded if group.plots], words, missing)


def _overall(report: Report) -> list[dict[str, Any]]:
    """Return, for every kind of motion, precision and error, the steppers to choose from."""
    rows = []
    for kind, own in kinds(report.found).items():
        for precision in PRECISIONS:
            for error in ERRORS[precision]:
                named = choice(overall(kind, own, precision, error))[:CHOICE]
                rows.append({"kind": kind, "precision": SAYS[precision], "error": figure(error),
                             "choice": [says(c) for c in named]})  # fmt: skip
    return rows


def _condition(found: Found) -> dict[str, Any]:
    """Return the conditions of a case, and what our steppers left in units of kappa u."""
    methods = list(dict.fromkeys(p.method for p in found.points if p.ours))
    rows = {}
    for precision in PRECISIONS:
        floor = attainable(found.case, precision)
        errors = {m: best(found, m, precision) for m in methods}
        known = {m: e for m, e in errors.items() if e is not None}
        winner = min(known, key=lambda m: known[m], default="")
        rows[precision] = {
            "attainable": floor,
            "exact": _units(errors.get("flow_exact"), floor),
            "dmv": _units(errors.get("step_dmv"), floor),
            "taylor": _units(errors.get("step_taylor"), floor),
            "best": known.get(winner),
            "method": look(winner).label,
        }
    return {"case": found.case, **rows}


def _units(error: float | None, floor: float | None) -> str:
    return "" if error is None or not floor else figure(error / floor)


def _figures(values: Mapping[str, Sequence[float]], precision: str) -> str:
    own = values.get(precision, ())
    shown = [figure(x) for n, x in enumerate(own) if n == 0 or not math.isnan(x)]
    return " / ".join(shown) if shown else "not run"
