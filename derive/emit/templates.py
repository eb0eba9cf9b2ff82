"""Where templates are found, and what they escape."""

from pathlib import Path

import jinja2

from derive.scene.escape import in_comment, in_docstring

_PACKAGE = Path(__file__).parent.parent


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
    found.filters |= {"in_comment": in_comment, "in_docstring": in_docstring}
    return found


TEMPLATES = templates_of()
