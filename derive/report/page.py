"""The report as one HTML page: light, without scripts, every plot inside it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from derive import __version__
from derive.emit import TEMPLATES
from derive.report.case_run import PRECISIONS, Found, attainable
from derive.report.look import look
from derive.report.plots import panels, svg
from derive.report.recommend import ERRORS, Overall, advice, overall, sentence
from derive.report.record import PACKAGES, RULES, TOOLS, Report, best, data

SAYS = {"f64": "double", "f32": "float"}
STATE = ("error at the end",)
SEPARATE = ("omega, relative", "attitude, rad", "energy, relative", "momentum, relative")
CHOICE = 3  # steppers that are named for an error
ALIKE = 1.005  # costs that differ by less are the same


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
        sections=[_section(f) for f in report.found],
        overall=_overall(report),
        conditions=[_condition(f) for f in report.found],
        machine=figures["machine"],
        programs=(*TOOLS, *PACKAGES),
        rules=RULES,
        says=SAYS,
        precisions=PRECISIONS,
        figure=figure,
        figures=_figures,
        number=_number,
    )


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
    for kind, torqued in (("without torque", False), ("with torque", True)):
        own = [f.points for f in report.found if f.case.torqued == torqued]
        for precision in PRECISIONS if own else ():
            for error in ERRORS[precision]:
                choice = overall(kind, own, precision, error)[:CHOICE]
                rows.append({"kind": kind, "precision": SAYS[precision], "error": figure(error),
                             "choice": [_choice(c) for c in choice]})  # fmt: skip
    return rows


def _choice(row: Overall) -> str:
    step = "" if math.isnan(row.radians) else f" with steps of {row.radians:.2g} rad"
    every = row.reached == row.asked
    where = "in every case" if every else f"in {row.reached} of {row.asked} cases"
    times = f"at most {row.worst:.3g} times the cheapest"
    cost = "the cheapest there" if row.worst < ALIKE else times
    return f"{look(row.method).label}{step}: {where}, {cost}"


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
            "method": winner,
        }
    return {"case": found.case, **rows}


def _units(error: float | None, floor: float | None) -> str:
    return "" if error is None or not floor else f"{error / floor:.2g}"


def figure(x: float | None) -> str:
    """Return a number as people write it.

    >>> figure(1e-12), figure(0.25), figure(None), figure(3.2e-9)
    ('1e-12', '0.25', '', '3.2e-09')
    """
    if x is None:
        return ""
    if math.isnan(x):
        return "NaN"
    return f"{x:.2g}"


def _figures(values: Mapping[str, Sequence[float]], precision: str) -> str:
    own = values.get(precision, ())
    shown = [figure(x) for n, x in enumerate(own) if n == 0 or not math.isnan(x)]
    return " / ".join(shown) if shown else "not run"


def _number(x: float | None) -> str:
    """Return a count with its thousands set apart."""
    return "" if x is None else f"{x:,.0f}".replace(",", "\u202f")
