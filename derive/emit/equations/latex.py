"""An account of equations as a LaTeX document: one file, amsmath, long equations over lines."""

from collections.abc import Iterable, Iterator, Sequence
from math import fsum

from sympy import Add, Expr
from sympy import latex as sympy_latex

from derive import __version__
from derive.emit.equations.account import STEP_NUMBERS, Account
from derive.emit.equations.assumed import alone
from derive.emit.equations.fitted import TwoSides
from derive.emit.equations.listed import Listed
from derive.emit.equations.section import Paragraph, Section, recalled
from derive.emit.notation import equation_layouts
from derive.emit.notation.latex import tex, tex_name, tex_text
from derive.emit.notation.lines import width
from derive.emit.notation.symbolic import symbolic_layout
from derive.lecture.step import Step
from derive.scene import argument

LEFT, LINE = 9.0, 38.0
"""Width in em of left sides at most, and of lines: 17 cm in letters of 10 pt are 48."""
_HEAD = r"""
\documentclass[a4paper,10pt]{article}
\usepackage{amsmath}
\usepackage{longtable}
\usepackage[margin=2cm]{geometry}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
\allowdisplaybreaks
\sloppy
"""


def latex_document(told: Account) -> str:
    """Return the whole document."""
    title = tex_text(told.scene.title)
    lines = [
        f"% By derive {__version__}: `derive equations {argument(told.scene)} --latex`",
        *_HEAD.strip().splitlines(),
        rf"\title{{{title}}}",
        r"\author{}",
        r"\date{}",
        r"\begin{document}",
        r"\maketitle",
        *(tex_text(sentence) + r"\par" for sentence in told.said),
        *(line for section in told.sections for line in _section(section)),
        *_more(told),
        *_symbols(told),
        *_assumptions(told),
        r"\end{document}",
    ]
    return "\n".join(lines) + "\n"


def _section(section: Section) -> Iterator[str]:
    yield rf"\section*{{{_code(section.name)}}}"
    yield tex_text(section.says) + r"\par"
    for note in section.notes:
        yield rf"\emph{{{tex_text(note)}}}\par"
    for part in section.parts:
        yield from _part(section, part)


_TITLES = {"law": "In this scene:", "balance": "In this scene:", "solution": "Solved:",
           "definition": "By definition:"}  # fmt: skip


def _part(section: Section, part: Paragraph) -> Iterator[str]:
    for step in part.steps:
        place = f"Lecture, step {STEP_NUMBERS[step.name]}, {_code(step.name)}"
        if step.name in part.again:
            yield rf"{place}, as above.\par"
            continue
        yield f"{tex_text(alone(step))} ({place}.)"
        yield from _display(
            rf"&{tex(left)} = {tex(right)}" for left, right in equation_layouts(step)
        )
    yield from [tex_text(part.says)] if part.says else []
    yield _TITLES[part.kind]
    for name, symbols, others in recalled(part):
        each = [f"${tex_name(section.shown[s])}$" for s in symbols]
        says = ", ".join([*each, *filter(None, [others])])
        yield rf"As in {_code(name)}: {says}."
    new = [equation for equation in part.equations if equation not in part.before]
    flush = any(width(symbolic_layout(left, section.shown)) > LEFT for left, _ in new)
    yield from _display(_broken(section, e, flush) for e in new) if new else [r"\par"]


def _display(lines: Iterable[str]) -> list[str]:
    return [r"\begin{align*}", " \\\\\n".join(lines), r"\end{align*}"]


def _broken(section: Section, equation: TwoSides, flush: bool) -> str:  # noqa: FBT001
    """Return an equation, its sides broken before a sign where the line is full.

    flush : it begins at the left margin, since in its display a left side is wide; one that is
            too wide for a line beside its right side has lines of its own
    """
    left, right = equation
    first, *rest = _rows(section, right)
    if not flush:
        return " \\\\\n".join([f"{_written(section, left)} &= {first}", *map(_led, rest)])
    start, *more = _rows(section, left)
    wide = fsum(width(symbolic_layout(side, section.shown)) for side in equation)
    if not rest and wide + 1 <= LINE:
        return f"&{start} = {first}"
    return " \\\\\n".join([f"&{start}", *map(_led, more), rf"&\quad = {first}", *map(_led, rest)])


def _led(text: str) -> str:
    return f"&\\quad {text if text.startswith('-') else f'+ {text}'}"


def _rows(section: Section, side: Expr) -> list[str]:
    """Return the lines that a side fills."""
    rows: list[list[Expr]] = [[]]
    room = LINE
    for term in side.as_ordered_terms():
        wide = width(symbolic_layout(term, section.shown))
        if rows[-1] and room < wide:
            rows.append([])
            room = LINE
        room -= wide + 1
        rows[-1].append(term)
    return [_written(section, Add(*row, evaluate=False)) for row in rows]


def _written(section: Section, expression: Expr) -> str:
    names = {s: tex_name(name) for s, name in section.shown.items()}
    return str(sympy_latex(expression, symbol_names=names, mul_symbol=r" \, "))


def _more(told: Account) -> Iterator[str]:
    if told.slopes:
        names = ", ".join(map(_code, told.slopes))
        yield rf"\section*{{Derivatives}}Functions that return derivatives of these: {names}."
    if told.without:
        names = ", ".join(map(_code, told.without))
        yield r"\section*{Motion and attitudes}Functions that move the state in time, or are "
        yield rf"formulas for attitudes, and state no equation of their own: {names}."


def _symbols(told: Account) -> Iterator[str]:
    yield from _list("Symbols", told.symbols)
    yield from _list("Symbols of the lecture's laws", told.of_laws)


def _list(title: str, rows: Sequence[Listed]) -> Iterator[str]:
    if not rows:
        return
    yield rf"\section*{{{title}}}"
    yield r"\begin{longtable}{@{}p{5cm}p{2.2cm}p{8.8cm}@{}}"
    yield r"symbol & unit & meaning \\ \hline \endhead"
    for row in rows:
        symbols = ", ".join(f"${tex_name(name, row.style)}$" for name in row.shown)
        yield rf"{symbols} & {_unit(row.unit)} & {tex_text(row.meaning)} \\"
    yield r"\end{longtable}"


def _unit(unit: str) -> str:
    r"""Return a unit upright, its powers raised: kg m^2/s."""
    apart = r" \, ".join(unit.split())
    return rf"$\mathrm{{{apart}}}$"


def _assumptions(told: Account) -> Iterator[str]:
    if told.assumptions:
        yield r"\section*{Assumptions}"
        yield r"\begin{description}"
        yield from map(_assumption, told.assumptions)
        yield r"\end{description}"


def _assumption(step: Step) -> str:
    return rf"\item[{STEP_NUMBERS[step.name]}, {_code(step.name)}] {tex_text(alone(step))}"


def _code(name: str) -> str:
    broken = tex_text(name).replace(r"\_", r"\_\allowbreak{}")
    return rf"\texttt{{{broken}}}"
