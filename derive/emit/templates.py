"""Where templates are found, and what they escape."""

import re
from pathlib import Path

import jinja2

from derive.scene.escape import in_comment, in_docstring

_PACKAGE = Path(__file__).parent.parent
_BREAK = re.compile(r"\*|/(?!\d)")  # a line may end behind these; a number is kept whole


def templates_of(*folders: Path) -> jinja2.Environment:
    """Return the templates of folders and of the package; a name is looked for in this order."""
    places = (*folders, _PACKAGE / "templates", _PACKAGE.parent / "templates")
    found = jinja2.Environment(
        loader=jinja2.FileSystemLoader(places),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=jinja2.select_autoescape(["html.jinja"]),
    )
    found.filters |= {"in_comment": in_comment, "in_docstring": in_docstring, "breaking": _breaking}
    return found


def _breaking(sentence: str) -> str:
    """Return a sentence whose formulas may be broken in two lines."""
    return _BREAK.sub("\\g<0>\u200b", sentence)


TEMPLATES = templates_of()
