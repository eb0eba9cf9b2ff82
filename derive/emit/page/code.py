"""The C of a function for its page: every line that stores a result links to its equation."""

import re
from collections.abc import Mapping
from html import escape

from markupsafe import Markup

from derive.emit.c.signature import CNames, prototype
from derive.emit.c.text import function_body
from derive.program.precision import F64
from derive.program.program import Program

_STORE = re.compile(r"\*?\w+(\[\d+\])? = .*;")


def listing(program: Program, scene: str, links: Mapping[str, str]) -> Markup:
    """Return the double precision C of a hot function as HTML.

    links : from an output's component to the place of its equation on the page
    """
    lines = function_body(program, scene, F64)
    components = [c for q in program.outputs for c in q.components] if links else []
    first_store = len(lines) - len(components)
    shown = [escape(prototype(program, CNames(scene), F64)), "{"]
    shown += [f"    {escape(line)}" for line in lines[:first_store]]
    for line, component in zip(lines[first_store:], components, strict=True):
        shown.append(f"    {_store(line, component, links)}")
    return Markup("\n".join([*shown, "}"]))  # noqa: S704 (escaped above)


def _store(line: str, component: str, links: Mapping[str, str]) -> str:
    if not _STORE.fullmatch(line):
        raise ValueError(f"a stored result looks like 'name[0] = value;', not '{line}'")
    determined = component.split(")/")[0].removeprefix("d(")
    if determined not in links:
        return escape(line)
    note = f"/* {component} */"
    return f'{escape(line)} <a href="#{links[determined]}">{escape(note)}</a>'
