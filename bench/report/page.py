"""The report as one HTML page: light, without scripts, every plot inside it."""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from markupsafe import Markup

from bench.build import TOOLS
from bench.report.case_run import PRECISIONS, Found, attainable
from bench.report.look import look
from bench.report.plots import panels, svg
from bench.report.proposals import proposal_says
from bench.report.recommend import ERRORS, advice, choice, overall, says, sentence
from bench.report.record import PACKAGES, RULES, Report, best, data, kinds
from derive import __version__
from derive.emit.templates import templates_of

TEMPLATES = templates_of(Path(__file__).parent / "templates")
SAYS = {"f64": "double", "f32": "float"}
STATE = ("error at the end",)
SEPARATE = ("omega, relative", "attitude, rad", "energy, relative", "momentum, relative")
WORKERS = 2
CHOICE = 3  # steppers that are named for an error
SMALLEST, LARGEST = 1e-2, 1e4  # numbers outside are written with an exponent


@dataclass(frozen=True)
class Section:
    """A case as the page shows it."""

    found: Found
    plots: Sequence[tuple[str, Markup, Markup]]
    advice: Sequence[tuple[str, str]]
    not_run: Sequence[tuple[str, str]]


def page(report: Report) -> str:
    """Return the text of ``report.html``."""
    figures = data(report)
    return TEMPLATES.get_template("report.html.jinja").render(
        version=__version__,
        report=report,
        sections=_sections(report.found),
        overall=_overall(report),
        conditions=[_condition(f) for f in report.found],
        machine=figures["machine"],
        programs=(*TOOLS, *PACKAGES),
        rules=RULES,
        proposals=proposal_says(report.proposals),
        says=SAYS,
        precisions=PRECISIONS,
        figure=figure,
        figures=_figures,
        number=_number,
    )


def _sections(found: Sequence[Found]) -> list[Section]:
    """Return the sections of all cases; drawing takes longest, so two are drawn at a time."""
    if len(found) == 1:
        return [_section(found[0])]
    with ProcessPoolExecutor(WORKERS) as pool:
        return list(pool.map(_section, found))


def _section(found: Found) -> Section:
    plots = []
    for precision in PRECISIONS:
        own = [p for p in found.points if p.precision == precision]
        floor = attainable(found.case, precision)
        whole, parts = svg(panels(STATE), own, floor), svg(panels(SEPARATE), own, floor)
        plots.append((SAYS[precision], Markup(whole), Markup(parts)))  # noqa: S704 (our own SVG)
    words = [
        (f"{figure(error)}, {SAYS[precision]}", sentence(one))
        for precision in PRECISIONS
        for error in ERRORS[precision]
        for one in [advice(found.case.name, found.points, precision, error)]
    ]
    reasons: dict[str, dict[str, None]] = {}
    for n in found.not_run:
        reasons.setdefault(n.reason, {})[n.method] = None
    return Section(found, plots, words, [(", ".join(m), why) for why, m in reasons.items()])


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


def figure(x: float | None) -> str:
    """Return a number as people write it.

    >>> figure(1e-12), figure(0.25), figure(None), figure(3.2e-9), figure(660.2)
    ('1e-12', '0.25', '', '3.2e-9', '660')
    """
    if x is None:
        return ""
    if math.isnan(x):
        return "NaN"
    if x == 0 or SMALLEST <= abs(x) < LARGEST:
        return f"{x:.2g}" if abs(x) < LARGEST / 100 else f"{x:.0f}"
    digits, exponent = f"{x:.1e}".split("e")
    return f"{digits.removesuffix('.0')}e{int(exponent)}"


def _figures(values: Mapping[str, Sequence[float]], precision: str) -> str:
    own = values.get(precision, ())
    shown = [figure(x) for n, x in enumerate(own) if n == 0 or not math.isnan(x)]
    return " / ".join(shown) if shown else "not run"


def _number(x: float | None) -> str:
    """Return a count with its thousands set apart."""
    return "" if x is None else f"{x:,.0f}".replace(",", "\u202f")
