"""The pattern of a sparse Jacobian as a small drawing: one square a nonzero."""

from markupsafe import Markup

from derive.emit.templates import TEMPLATES
from derive.program.program import Sparsity

_CELL, _LETTER, _GAP = 16, 6.2, 6


def pattern_drawing(sparsity: Sparsity, says: str) -> Markup:
    """Return an SVG of the places that are not zero, rows and columns named."""
    rows, columns = sparsity.rows, sparsity.columns
    left, top = (_LETTER * max(map(len, names)) + _GAP for names in (rows, columns))
    text = TEMPLATES.get_template("pattern.html.jinja").render(
        says=says,
        left=left,
        top=top,
        size=(_CELL * len(columns), _CELL * len(rows)),
        rows=[(name, top + _CELL * (i + 0.7)) for i, name in enumerate(rows)],
        columns=[(name, left + _CELL * (k + 0.7)) for k, name in enumerate(columns)],
        squares=[
            (left + _CELL * k + 1.5, top + _CELL * i + 1.5, rows[i], columns[k])
            for i, k in sparsity.places()
        ],
        square=_CELL - 3,
    )
    return Markup(text)  # noqa: S704 (names escaped by the template)
