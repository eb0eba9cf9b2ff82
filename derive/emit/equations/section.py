"""A function of the lecture as paragraphs of equations: laws, what they become here, solution."""

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from typing import Literal

from sympy import Add, Expr, Symbol

from derive.emit.equations.dimensions import dimension_made, dimension_said
from derive.emit.equations.fitted import TwoSides, fitted
from derive.emit.equations.solved import resolved
from derive.emit.page.equation import notes, written_equations, written_names
from derive.emit.page.readable import Readable
from derive.emit.page.tidied import neatened
from derive.lecture.chapters import LECTURE
from derive.lecture.step import Step
from derive.library.library import Library
from derive.program.program import Quantity
from derive.scene.said import potential_said
from derive.scene.unit import Dimension

LONG = 24
"""Lines that the answers of a function stand on, beyond which none of these is shown closed:
tidying and solving all of them to find that out takes longer than all else."""
Standing = Literal["law", "balance", "solution", "definition"]


@dataclass(frozen=True)
class Paragraph:
    """Equations that belong together.

    kind   : "law" and "balance", what steps of the lecture become in this scene; "solution", of the
             balances above it; "definition", what the scene itself says
    again  : names of steps that stood in another paragraph before
    before : equations that stood in another section before, and in which
    """

    kind: Standing
    steps: tuple[Step, ...]
    equations: tuple[TwoSides, ...]
    says: str = ""
    again: frozenset[str] = frozenset()
    before: Mapping[TwoSides, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Section:
    """A function of the lecture: what it gives, and its equations in the order of their use.

    answers : the components that the function returns, each by the symbol that stands for it
    given   : components that have a value before, each with its symbol
    called  : names of the symbols of the scene's quantities; labels of all others
    units   : dimensions of symbols, as far as they are known
    names   : of every symbol in it, no two alike      shown : how they are written
    """

    name: str
    says: str
    notes: tuple[str, ...]
    parts: tuple[Paragraph, ...]
    answers: Mapping[str, Symbol]
    given: Mapping[str, Symbol]
    called: Mapping[Symbol, str]
    labels: Mapping[Symbol, str]
    units: Mapping[Symbol, Dimension]
    marks: Mapping[str, str]
    names: Mapping[Symbol, str] = field(default_factory=dict)
    shown: Mapping[Symbol, str] = field(default_factory=dict)

    @property
    def equations(self) -> tuple[TwoSides, ...]:
        """Return all equations in order."""
        return tuple(equation for part in self.parts for equation in part.equations)

    @property
    def balances(self) -> tuple[TwoSides, ...]:
        """Return the equations that are solved, those included that say an unknown outright."""
        held = (e for part in self.parts for e in part.equations
                if part.kind == "balance" or not self.assigns(e))  # fmt: skip
        return tuple(held)

    def assigns(self, equation: TwoSides) -> bool:
        """Tell whether an equation says outright what its left side is; others are balances."""
        left, _ = equation
        return bool(left.is_Symbol) and left not in self.given.values()

    def symbols(self) -> set[Symbol]:
        """Return every symbol that stands in an equation or is an answer."""
        used = {s for sides in self.equations for side in sides for s in side.free_symbols}
        return used | set(self.answers.values())


def recalled(part: Paragraph) -> Iterator[tuple[str, list[Symbol], str]]:
    """Yield of each section in which equations stood before what they say, and what else."""
    for name in dict.fromkeys(part.before.values()):
        own = [left for (left, _), where in part.before.items() if where == name]
        named = [left for left in own if left.is_Symbol]
        count = len(own) - len(named)
        others = f"{count} balances" if count > 1 else "one balance"
        yield name, named, others if count else ""


@dataclass(frozen=True)
class Outline:
    """A function's equations as they are first written, neither tidied nor solved.

    found  : unknowns that are answers
    called : names of all symbols that may stand in them
    stands : answers that are known by another symbol
    """

    parts: tuple[Paragraph, ...]
    answers: Mapping[Symbol, Expr]
    found: frozenset[Symbol]
    called: Mapping[Symbol, str]
    stands: Mapping[Symbol, Expr]

    @property
    def is_long(self) -> bool:
        """Tell whether no answer is expected to come down to a few lines."""
        lines = (left for part in self.parts for left, _ in part.equations)
        return sum(left not in self.answers for left in lines) > LONG


def outline(library: Library, base: str) -> Outline:
    """Return the equations of a function as they are first written; made once."""
    return library.mechanism.told_once("outline", base, lambda: _outline(library, base))


def _outline(library: Library, base: str) -> Outline:
    known = library.mechanism
    own, written = known.posed(base), written_equations(known, base)
    symbols, label = own.words.sheet.symbols, own.words.sheet.label
    called = written_names(own)
    called |= {u: called[s] for u, s in written.found.items()}
    stands: dict[Symbol, Expr] = {s: u for u, s in written.found.items()}
    stands |= {s: e for s, e in written.answers.items() if e.is_Symbol and
               (called.get(e) == called[s] or _is_speed_of(label(s), e, symbols))}  # fmt: skip
    kinds: tuple[Standing, ...] = ("law", "balance", "law")
    every = [_paragraph(kind, *group, stands)
              for kind, group in zip(kinds, written.groups, strict=True)]  # fmt: skip
    every.insert(2, Paragraph("solution", (), ()))
    if [*map(label, written.answers)] == ["energy"]:
        every = [*_energies(library, base)] or every
    return Outline(tuple(every), written.answers, frozenset(written.found), called, stands)


def section(library: Library, base: str) -> Section:
    """Return the equations of a function, its symbols without names yet; made once."""
    return library.mechanism.told_once("section", base, lambda: _section(library, base))


def _section(library: Library, base: str) -> Section:
    first = outline(library, base)
    every = [replace(part, equations=tuple(resolved(library, base).items()))
             if part.kind == "solution" else part for part in first.parts]  # fmt: skip
    kept = {*first.called, *first.answers}
    return of_parts(library, base, tuple(_defined_once(tuple(_fitted(every, first.called)), kept)))


def of_parts(library: Library, base: str, parts: tuple[Paragraph, ...]) -> Section:
    """Return a section of paragraphs of a function."""
    known, first = library.mechanism, outline(library, base)
    own = known.posed(base)
    symbols, label = own.words.sheet.symbols, own.words.sheet.label
    spoken = [*own.vocabulary.every(), *own.words.vocabulary.every()]
    of_scene = {symbols[c] for q in spoken for c in q.components} | first.found
    return Section(
        base,
        known.whole(base).says,
        tuple(notes(known, base)),
        parts,
        {label(s): first.stands.get(s, s) for s in first.answers},
        {c: symbols[c] for q in own.words.vocabulary.given() for c in q.components},
        {s: name for s, name in first.called.items() if s in of_scene},
        {s: name for name, s in symbols.items() if s not in of_scene},
        _units(symbols, spoken, parts),
        known.scene.marks,
    )


def _is_speed_of(answer: str, value: Expr, symbols: Mapping[str, Symbol]) -> bool:
    """Tell whether an answer x_rate is the speed x_dot, which has a name already."""
    return answer.endswith("_rate") and symbols.get(f"{answer.removesuffix('_rate')}_dot") == value


def _paragraph(
    kind: Standing, steps: Iterable[str], lines: Iterable[tuple[Symbol, Expr, Expr]],
    stands: Mapping[Symbol, Expr],
) -> Paragraph:  # fmt: skip
    held = tuple(LECTURE[s] for s in steps)
    equations = tuple((left, right) for _, left, right in lines if stands.get(left) != right)
    return Paragraph("definition" if kind == "law" and not held else kind, held, equations)


def _fitted(parts: Iterable[Paragraph], names: Mapping[Symbol, str]) -> Iterator[Paragraph]:
    """Yield the parts that say something, tidied, no term in them wider than a line."""
    known: dict[Expr, Expr] = {}
    for part in parts:
        if part.equations:
            each = ((neatened(left), neatened(right)) for left, right in part.equations)
            yield replace(part, equations=tuple(fitted(each, names, known)))


def _defined_once(parts: Sequence[Paragraph], kept: Set[Symbol]) -> Iterator[Paragraph]:
    """Yield the parts with one symbol for what is equal; those ``kept`` stay what they are."""
    every = [sides for part in parts for sides in part.equations]
    same: dict[Symbol, Symbol] = {}
    while True:
        first: dict[str, Symbol] = {}
        found = {
            left: first[str(right.xreplace(same))]
            for left, right in every
            if left.is_Symbol and left not in same and left not in kept
            if first.setdefault(str(right.xreplace(same)), left) != left
        }
        if not found:
            break
        same = {left: one.xreplace(found) for left, one in same.items()} | found
    for part in parts:
        own = [(left, right) for left, right in part.equations if left not in same]
        if own:
            each = tuple((left.xreplace(same), right.xreplace(same)) for left, right in own)
            yield replace(part, equations=each)


def _units(
    symbols: Mapping[str, Symbol], quantities: Iterable[Quantity], parts: Iterable[Paragraph]
) -> dict[Symbol, Dimension]:
    """Return the dimensions of symbols: as declared, then of what the equations name."""
    known = {symbols[c]: dimension_said(q.unit) for q in quantities for c in q.components
             if q.unit}  # fmt: skip
    for left, right in (equation for part in parts for equation in part.equations):
        found = dimension_made(right, known)
        if left.is_Symbol and left not in known and found is not None:
            known[left] = found
    return known


def _energies(library: Library, base: str) -> Iterator[Paragraph]:
    """Yield what the energy is the sum of: by the lecture, and of weights and springs."""
    known = library.mechanism
    own = known.posed(base)
    symbols = own.words.sheet.symbols
    kinetic, potential = (written_equations(known, f"{k}_energy") for k in ("kinetic", "potential"))
    whole, moving, resting = (symbols[n] for n in ("energy", "kinetic_energy", "potential_energy"))
    if potential.answers[resting] == 0:
        return
    yield _paragraph("law", *kinetic.groups[0], {})
    yield _paragraph("law", *kinetic.groups[2], {})
    stood = {left for _, left, _ in kinetic.groups[0][1]}
    rest = [line for line in _lines(potential) if line[0] not in stood]
    yield replace(_paragraph("definition", (), rest, {}), says=potential_said(own.scene))
    yield Paragraph("definition", (), ((whole, Add(moving, resting)),))


def _lines(written: Readable) -> Iterator[tuple[Symbol, Expr, Expr]]:
    return (line for _, lines in written.groups for line in lines)
