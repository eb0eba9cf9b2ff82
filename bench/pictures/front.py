"""The picture of the README: a scene, its equations, its C, and its motion's error against cost.

Nothing in it is drawn by hand: the scene is the catalogue's, the equations are those that the
program solves and proves, the C is the file in ``generated/``, the curves are of its report.
"""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

from sympy import Expr, Symbol, collect

from bench.pictures.palette import Palette
from bench.pictures.plot import Axis, Line, improving
from bench.report.look import look
from derive.emit.notation.glyph import glyph, spelt
from derive.emit.templates import templates_of
from derive.library.library import Library

SCENE, FUNCTION = "free_body_principal", "acceleration"
CASE = "asym_ii_generic"
THEIRS = {
    "DOP853, C": ("a", "7 3"),
    "heyoka (Taylor)": ("b", "2 2"),
    "CasADi cvodes": ("c", "7 3"),
    "SciPy DOP853": ("d", "2 2"),
}
"""Integrators of others: a letter at the curve, and its dashes."""
WORST = 0.3  # an error above is no motion any more
WIDE = 46  # characters of a line of the scene
COST = Axis(3, 10, 772, 1066)
ERROR = Axis(-14, 0, 262, 44)
Letter = tuple[str, str]
"""What is written, and the index below it."""
TEMPLATES = templates_of(Path(__file__).parent)


@dataclass(frozen=True)
class Curve:
    """A method's points in pixels, and how they are drawn: others' dashed, with a letter."""

    label: str
    colour: str
    letter: str
    dashes: str
    at: Sequence[tuple[float, float]]


def front(programs: Library, generated: Path, palette: Palette) -> str:
    """Return the picture as the text of an SVG file; ``programs`` are those of ``SCENE``."""
    report = json.loads((generated / "report.json").read_text(encoding="utf-8"))
    case = next(case for case in report["cases"] if case["name"] == CASE)
    return TEMPLATES.get_template("front.svg.jinja").render(
        palette=palette,
        scene=SCENE,
        lines=[_cut(line) for line in _lines(programs.scene.text)],
        equations=_equations(programs),
        flops=programs[FUNCTION].flops(),
        code=_code(generated / SCENE / f"{SCENE}_f64.c"),
        curves=_curves(case["points"], palette),
        seconds=case["time"],
        cost=COST,
        error=ERROR,
    )


def _lines(text: str) -> list[str]:
    """Return the lines of a scene from its parameters on, without empty ones."""
    _, _, told = text.partition("[parameters]")
    return ["[parameters]", *(line for line in told.splitlines() if line)]


def _cut(line: str) -> str:
    return line if len(line) <= WIDE else f"{line[: WIDE - 1]}…"


def _equations(programs: Library) -> list[list[Letter]]:
    """Return the equations that the function solves, each for the moment in it."""
    posed = programs.mechanism.posed(FUNCTION)
    problem, label = posed.whole(FUNCTION), posed.words.sheet.label
    found = []
    for row in problem.rows:
        whole = row
        while whole.free_symbols & problem.definitions.keys():
            whole = whole.subs(problem.definitions)
        named = {label(s): s for s in sorted(whole.free_symbols, key=label)}
        moment = next(s for name, s in named.items() if name.startswith("moment"))
        turning = [s for name, s in named.items() if re.fullmatch("omega_.", name)]
        other = collect(whole.expand() + moment, prod(turning))
        letters = {s: _letter(label(s)) for s in whole.free_symbols}
        found.append([letters[moment], (" = ", ""), *_sum(other, letters)])
    return found


def _letter(name: str) -> Letter:
    """Return a name as a letter, with its dot, and an index."""
    own = glyph(name)
    letter = "M" if own.base == "moment" else spelt(own.base)
    return letter + "\u0307" * own.dots, "".join(own.indices)


def _sum(value: Expr, letters: Mapping[Symbol, Letter]) -> list[Letter]:
    """Return a sum of products, brackets around the sums in it, what is positive first."""
    out: list[Letter] = []
    for term in sorted(value.as_ordered_terms(), key=lambda t: (_negative(t), str(t))):
        out += [(" − " if _negative(term) else " + ", "")] if out else []
        factors = (-term if _negative(term) else term).as_ordered_factors()
        for factor in sorted(factors, key=lambda f: (not f.is_Add, str(f))):
            inner = _sum(factor, letters) if factor.is_Add else [letters[factor]]
            out += [("(", ""), *inner, (") ", "")] if factor.is_Add else inner
    return out


def _negative(term: Expr) -> bool:
    return not term.is_Add and bool(term.as_coeff_Mul()[0] < 0)


def _code(file: Path) -> list[str]:
    """Return the function as it stands in the file, its arguments and its brackets left out."""
    text = file.read_text(encoding="utf-8")
    _, _, after = text.partition(f"void {SCENE}_{FUNCTION}_f64(")
    body = after[after.index("\n{\n") + 3 : after.index("\n}\n")]
    lines = [line.strip() for line in body.splitlines()]
    read = [line for line in lines if line.startswith("const") and "_in = " in line]
    first = "…, each input read" if read else ""
    return [f"{SCENE}_{FUNCTION}_f64(…)", first, *(line for line in lines if line not in read)]


def _curves(points: Sequence[Mapping[str, Any]], palette: Palette) -> list[Curve]:
    """Return the curves of a case in double, in pixels."""
    found = []
    for method in (*palette.curves, *THEIRS):
        own = [p for p in points if p["method"] == method and p["precision"] == "f64"]
        line = _line(own)
        at = [(COST.at(cost), ERROR.at(error)) for cost, error in line]
        if method in palette.curves:
            found.append(Curve(f"{method} (derive)", palette.curves[method], "", "", at))
        else:
            letter, dashes = THEIRS[method]
            found.append(Curve(look(method).label, palette.soft, letter, dashes, at))
    return found


def _line(points: Sequence[Mapping[str, Any]]) -> Line:
    """Return instructions and error of the points that are a motion."""
    return improving(
        (p["instructions"], max(p["omega"], p["attitude"]))
        for p in points
        if None not in (p["instructions"], p["omega"], p["attitude"])
        and 0 < max(p["omega"], p["attitude"]) < WORST
    )
