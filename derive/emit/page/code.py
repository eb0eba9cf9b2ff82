"""The C of a function for its page: every line that stores a result links to its equation."""

import re
from collections.abc import Mapping
from html import escape

from markupsafe import Markup

from derive.emit.c.signature import CNames, prototype
from derive.emit.c.text import function_body, result_slots
from derive.program.precision import F64
from derive.program.program import Program, component_names

_STORE = re.compile(r"(\*?\w+(?:\[\d+\])?) = .*;")


def listing(program: Program, scene: str, links: Mapping[str, str]) -> Markup:
    """Return the double precision C of a hot function as HTML.

    links : from an output's component to the place of its equation on the page
    """
    stored = dict(zip(result_slots(program), component_names(program), strict=True))
    lines = (_line(line, stored, links) for line in function_body(program, scene, F64))
    shown = [escape(prototype(program, CNames(scene), F64)), "{", *(f"    {x}" for x in lines)]
    return Markup("\n".join([*shown, "}"]))  # noqa: S704 (escaped above)


def _line(line: str, stored: Mapping[str, str], links: Mapping[str, str]) -> str:
    store = _STORE.fullmatch(line)
    component = stored.get(store[1], "") if store else ""
    determined = component.split(")/")[0].removeprefix("d(")
    if determined not in links:
        return escape(line)
    note = f"/* {component} */"
    return f'{escape(line)} <a href="#{links[determined]}">{escape(note)}</a>'
