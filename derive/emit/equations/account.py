"""What is told of a scene's equations, before a printer writes it as text, LaTeX or Python."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from sympy import Symbol

from derive.emit.equations.assumed import lecture_symbols
from derive.emit.equations.fitted import TwoSides
from derive.emit.equations.lettered import decimal_value, lettered, names_shown
from derive.emit.equations.listed import Listed, listed
from derive.emit.equations.naming import Book, with_names
from derive.emit.equations.section import Paragraph, Section, section
from derive.emit.page.equation import notes
from derive.lecture.chapters import LECTURE
from derive.lecture.step import Step
from derive.library.library import Library
from derive.scene import Scene, SceneError

STEP_NUMBERS: Mapping[str, int] = {step.name: n for n, step in enumerate(LECTURE.steps, 1)}
"""The number of each step on the page of the lecture."""


@dataclass(frozen=True)
class Account:
    """A scene's equations with the table of their symbols, and what they rest on.

    said      : what the scene is made of, in sentences
    symbols   : every symbol of the equations, once, but those of the lecture's laws
    of_laws   : those of the laws
    constants : values of parameters that are letters here, by identifier
    slopes    : wanted functions that return derivatives of the sections' answers
    without   : wanted functions that no equation of the lecture states as it stands
    """

    scene: Scene
    said: tuple[str, ...]
    sections: tuple[Section, ...]
    symbols: tuple[Listed, ...]
    of_laws: tuple[Listed, ...]
    constants: Mapping[str, str]
    assumptions: tuple[Step, ...]
    slopes: tuple[str, ...]
    without: tuple[str, ...]


def account(library: Library) -> Account:
    """Return what is told of the equations of a scene."""
    try:
        return _account(library, lettered(library))
    except SceneError:  # as where a parameter is an exponent, and must be a number
        return _account(library, library)


def _account(library: Library, known: Library) -> Account:
    book = Book()
    found = [
        with_names(replace(section(known, base), notes=tuple(notes(library.mechanism, base))), book)
        for base in library.problems
    ]
    sections = tuple(_without_repeats(_shown(known.scene, found)))
    values = {p.name: p.value for p in library.scene.parameters if p.value}
    rows = tuple(listed(known, sections, values))
    steps = {step.name: step for s in sections for part in s.parts for step in part.steps}
    reasons = {a for name in steps for a in LECTURE.assumptions(name)}
    names = [program.name for program in library.functions]
    return Account(
        library.scene,
        library.mechanism.said,
        sections,
        rows,
        tuple(_told_apart(lecture_symbols(steps.values()), rows)),
        {n: decimal_value(values[n]) for row in rows for n in row.names if n in values},
        tuple(step for step in LECTURE.steps if step.name in reasons),
        tuple(name for name in names if name not in library.problems),
        tuple(program.name for program in library.motions),
    )


def _told_apart(laws: Iterable[Listed], own: Iterable[Listed]) -> Iterator[Listed]:
    """Yield the letters of the laws; of one that the scene uses for another quantity, that too."""
    here = {name: row.meaning for row in own for name in row.shown}
    for law in laws:
        (name,) = law.shown
        other = here.get(name, law.meaning) if law.style == "scalar" else law.meaning
        more = "" if other == law.meaning else f"; in the laws alone, for above {name} is: {other}"
        yield replace(law, meaning=f"{law.meaning}{more}")


def _shown(scene: Scene, sections: Iterable[Section]) -> list[Section]:
    """Return sections with how each name is written."""
    each = list(sections)
    swaps = names_shown(scene, {name for s in each for name in s.names.values()})
    return [
        replace(s, shown={symbol: swaps.get(name, name) for symbol, name in s.names.items()})
        for s in each
    ]


def _without_repeats(sections: Iterable[Section]) -> Iterator[Section]:
    """Yield sections in which laws and equations that stood before are known as such."""
    laws: set[str] = set()
    stood: dict[tuple[str, str], str] = {}
    for one in sections:
        symbols = {s: Symbol(name) for s, name in one.names.items()}
        parts: list[Paragraph] = []
        for part in one.parts:
            keys = [_key(sides, symbols) for sides in part.equations]
            before = {sides: stood[key] for sides, key in zip(part.equations, keys, strict=True)
                      if key in stood}  # fmt: skip
            again = frozenset(step.name for step in part.steps if step.name in laws)
            parts.append(replace(part, before=before, again=again))
            laws |= {step.name for step in part.steps}
            stood |= dict.fromkeys((key for key in keys if key not in stood), one.name)
        yield replace(one, parts=tuple(parts))


def _key(sides: TwoSides, names: Mapping[Symbol, Symbol]) -> tuple[str, str]:
    left, right = (str(side.xreplace(names)) for side in sides)
    return left, right
