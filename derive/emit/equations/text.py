"""An account of equations for a terminal, by SymPy's pretty printer, in Unicode or ASCII.

SymPy reads meaning into names (``crowbar`` is ``crow`` with a bar) and sorts by them. So it is
given characters that mean nothing, in the order of the scene, as wide as the name that replaces
them.
"""

import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from textwrap import wrap

from sympy import Add, Eq, Expr, Symbol, pretty
from sympy.printing.pretty.pretty_symbology import pretty_symbol

from derive.emit.equations.account import STEP_NUMBERS, Account
from derive.emit.equations.assumed import alone
from derive.emit.equations.fitted import TwoSides
from derive.emit.equations.listed import Listed
from derive.emit.equations.section import Section, recalled
from derive.emit.notation import equation_text
from derive.emit.notation.glyph import GREEK, Glyph, glyph
from derive.scene.escape import visible

WIDTH, INDENT = 88, "    "
_PRIVATE = 0xE000  # characters that nobody uses
_TITLES = {"law": "In this scene:", "balance": "In this scene:", "solution": "Solved:",
           "definition": "By definition:"}  # fmt: skip


def unicode_text(told: Account) -> str:
    """Return all of it in Unicode."""
    return _page(told, "unicode")


def ascii_text(told: Account) -> str:
    """Return all of it in ASCII, for terminals that have no more; other characters are spelled."""
    return _page(told, "ascii").encode("ascii", "backslashreplace").decode("ascii")


def _page(told: Account, letters: str) -> str:
    lines = [visible(told.scene.title), "=" * len(told.scene.title), ""]
    lines += [line for sentence in told.said for line in _wrapped(sentence, "")]
    lines += [line for section in told.sections for line in _section(section, letters)]
    if told.slopes:
        lines += [*_wrapped(f"With derivatives of these: {', '.join(told.slopes)}.", ""), ""]
    if told.without:
        says = "Steps in time and formulas for attitudes, which state no equation of their own: "
        lines += [*_wrapped(f"{says}{', '.join(told.without)}.", ""), ""]
    lines += [*_symbols(told, letters), *_assumptions(told)]
    return "\n".join(line.rstrip() for line in lines).rstrip() + "\n"


def _section(section: Section, letters: str) -> Iterator[str]:
    yield from ("", section.name, "-" * len(section.name))
    for sentence in (section.says, *section.notes):
        yield from _wrapped(sentence, "")
    for part in section.parts:
        yield ""
        for step in part.steps:
            place = f"Lecture, step {STEP_NUMBERS[step.name]}, {step.name}"
            if step.name in part.again:
                yield f"{place}, as above."
                continue
            yield from _wrapped(f"{place}. {alone(step)}", "")
            yield from _wrapped(equation_text(step), INDENT)
        yield from _wrapped(part.says, "")
        yield _TITLES[part.kind]
        for name, symbols, others in recalled(part):
            each = [_name(section.shown[s], letters) for s in symbols]
            says = ", ".join([*each, *filter(None, [others])])
            yield from _wrapped(f"As in {name}: {says}.", INDENT)
        for equation in part.equations:
            if equation not in part.before:
                yield ""
                yield from _drawn(section, equation, letters)
    yield ""


def _drawn(section: Section, equation: TwoSides, letters: str) -> Iterator[str]:
    """Yield the lines of an equation, its right side broken before a sign where a line is full."""
    names = {s: _name(name, letters) for s, name in section.shown.items()}
    stands = {s: _stand_in(place, name) for place, (s, name) in enumerate(names.items())}
    left, _right = (side.xreplace(stands) for side in equation)
    terms = [term.xreplace(stands) for term in equation[1].as_ordered_terms()]
    rows: list[list[Expr]] = [[]]
    room = WIDTH - _wide(_pretty(left, letters)) - len(INDENT) - 3
    for term in terms:
        if rows[-1] and _wide(_pretty(_sum([*rows[-1], term]), letters)) > room:
            rows.append([])
        rows[-1].append(term)
    first, *rest = rows
    shown = [Eq(left, _sum(first), evaluate=False), *(_sum([Symbol(" "), *row]) for row in rest)]
    for one in shown:
        drawn = _pretty(one, letters)
        for s, name in names.items():
            drawn = drawn.replace(stands[s].name, name)
        yield from (INDENT + line for line in drawn.splitlines())


def _sum(terms: Iterable[Expr]) -> Expr:
    return Add(*terms, evaluate=False)


def _pretty(expression: Expr, letters: str) -> str:
    return str(pretty(expression, use_unicode=letters == "unicode", wrap_line=False, order="none"))


def _wide(drawn: str) -> int:
    return max(map(len, drawn.splitlines()))


def _stand_in(place: int, name: str) -> Symbol:
    """Return a symbol as wide as a name, which nothing can be read into."""
    wide = len([c for c in name if not unicodedata.combining(c)])
    return Symbol(chr(_PRIVATE + place) * wide)


def _name(name: str, letters: str) -> str:
    """Return how a name is written: with Greek letters, dots and indices where there are such."""
    parts = glyph(name)
    if letters == "ascii" or parts.by or parts.prime or parts.seen_from:
        return name
    return _plain(parts) if _is_word(parts) else str(pretty_symbol(_for_sympy(parts)))


def _is_word(parts: Glyph) -> bool:
    """Tell whether SymPy might read a name of several letters as a letter with a sign."""
    return any(len(p) > 2 and p not in GREEK for p in (parts.base, *parts.indices))


def _for_sympy(parts: Glyph) -> str:
    return "_".join(
        [parts.base + "d" * (parts.dots - 1) + "dot" * bool(parts.dots), *parts.indices]
    )


def _plain(parts: Glyph) -> str:
    """Return a name with a word in it; dots stand on letters only."""
    base, *indices = (GREEK.get(p, p) for p in (parts.base, *parts.indices))
    signs = ("", "\u0307", "\u0308") if len(base) == 1 else ("", "_dot", "_ddot")
    return "_".join([base + signs[parts.dots], *indices])


def _symbols(told: Account, letters: str) -> Iterator[str]:
    yield from _list("Symbols", told.symbols, letters)
    yield from _list("Symbols of the lecture's laws", told.of_laws, letters)


def _list(title: str, rows: Sequence[Listed], letters: str) -> Iterator[str]:
    if rows:
        yield from (title, "-" * len(title))
    for row in rows:
        symbols = ", ".join(_name(name, letters) for name in row.shown)
        yield from _wrapped(f"{symbols} [{row.unit}] {row.meaning}", "")
    yield ""


def _assumptions(told: Account) -> Iterator[str]:
    if told.assumptions:
        yield from ("Assumptions", "-----------")
    for step in told.assumptions:
        yield from _wrapped(f"{STEP_NUMBERS[step.name]}, {step.name}: {alone(step)}", "")


def _wrapped(sentence: str, indent: str) -> list[str]:
    later = indent + "  "
    return wrap(visible(sentence), WIDTH, initial_indent=indent, subsequent_indent=later)
