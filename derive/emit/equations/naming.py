"""Names of the symbols in a scene's equations: one name means one thing in all of its sections."""

import re
from dataclasses import dataclass, field, replace

from sympy import Symbol

from derive.emit.equations.called import letter_called, letters_used
from derive.emit.equations.section import Section

_TAKEN = "ANSWERS BALANCES CONSTANTS Eq Integer Rational Symbol VALUES answers cos pi sin sqrt tan"
RESERVED = frozenset(_TAKEN.split())
"""What the printed module of Python calls something else."""
OWN = {"potential_energy": ("V", "U")}
"""Letters of quantities that have none on pages."""


@dataclass
class Book:
    """The names that are given, by what they are given to, and identifiers that are taken."""

    given: dict[str, str] = field(default_factory=dict)
    taken: set[str] = field(default_factory=lambda: set(RESERVED))

    def name(self, what: str, wished: str) -> str:
        """Return the name of something, the wished one with a number behind it if it is taken."""
        if what not in self.given:
            name, count = wished, 2
            while python_name(name) in self.taken:
                name, count = f"{wished}_{count}", count + 1
            self.given[what] = name
            self.taken.add(python_name(name))
        return self.given[what]


def with_names(one: Section, book: Book) -> Section:
    """Return a section with a name for every symbol in it.

    What stands between is told by what it is equal to, so that equals have one name everywhere;
    two answers of one section that are equal have two.
    """
    found: dict[Symbol, str] = {}
    used, bases = one.symbols(), letters_used(one.called.values())
    wished = {s: _read(name, bases) for s, name in one.called.items()}
    for symbol, name in wished.items():
        own = book.name(name, name)  # also where it does not stand, lest another takes it
        if symbol in used:
            found[symbol] = book.name(f"{name} {symbol}", own) if own in found.values() else own
    for left, right in one.equations:
        if left.is_Symbol and left not in found:
            what = f"= {right.xreplace({s: Symbol(name) for s, name in found.items()})}"
            wish = letter_called(label_between(one, left), one.marks, bases)
            own = book.name(what, wish)
            found[left] = book.name(f"{what} {left}", wish) if own in found.values() else own
    return replace(one, names=found)


def label_between(one: Section, symbol: Symbol) -> str:
    """Return the label of a symbol that stands between."""
    return one.labels.get(symbol, symbol.name.rstrip("'"))


def python_name(name: str) -> str:
    """Return a name without signs and spaces."""
    return re.sub(r"\W+", "_", name).strip("_")


def _read(name: str, bases: frozenset[str]) -> str:
    """Return a page's name as it stands in equations."""
    letters = (letter for letter in OWN.get(name, ()) if letter not in bases)
    return next(letters, name.replace("_dot_dot", "_ddot"))  # the rate of a rate
