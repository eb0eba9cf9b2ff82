"""What a function returns, by its arguments as C writes them: for a reader of the header.

These are the closed forms that stand at the top of a scene's page; where they are long, none.
"""

import re
from collections.abc import Mapping, Sequence

from derive.emit.equations.naming import Book, with_names
from derive.emit.equations.section import outline, section
from derive.emit.notation import sympy_equation_text
from derive.emit.page.glance import short_forms
from derive.library.library import Library
from derive.program.program import Program

MOST = 8
"""Lines of a comment."""
_PRODUCT = re.compile(r"(?<=[\w)\]]) (?=[\w(])")


Relations = Mapping[str, Sequence[str]]
UNSAID: Relations = {}


def every_relation(library: Library) -> Relations:
    """Return the equations of all functions by name."""
    return {program.name: relations(library, program) for program in library.functions}


def relations(library: Library, program: Program) -> list[str]:
    """Return equations of a function's outputs in its inputs, and of what is named in between.

    A derivative and a step have none: they are no equations of the lecture.
    """
    if program.name not in library.problems or outline(library, program.name).is_long:
        return []
    one = with_names(section(library, program.name), Book())
    places = {
        component: f"{q.name}[{place}]" if q.shape else q.name
        for q in (*program.inputs, *program.outputs) if q.role != "constants"
        for place, component in enumerate(q.components)
    }  # fmt: skip
    own = {s: places[c] for c, s in (*one.given.items(), *one.answers.items()) if c in places}
    names = {**one.names, **own}
    told = (sympy_equation_text(*sides, names) for sides in short_forms(one, MOST))
    return [_PRODUCT.sub("*", text) for text in told]
