"""The pattern of a sparse Jacobian as a small drawing: one square a nonzero."""

from html import escape

from markupsafe import Markup

from derive.program.program import Sparsity

_CELL, _LETTER, _GAP = 16, 6.2, 6


def pattern(sparsity: Sparsity, says: str) -> Markup:
    """Return an SVG of the places that are not zero, rows and columns named."""
    left = _LETTER * max(map(len, sparsity.rows)) + _GAP
    top = _LETTER * max(map(len, sparsity.columns)) + _GAP
    width = left + _CELL * len(sparsity.columns) + 2
    height = top + _CELL * len(sparsity.rows) + 2
    head = (
        f'<svg class="pattern" role="img" aria-label="{escape(says)}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" height="{height:.0f}">'
    )
    parts = [*_grid(sparsity, left, top), *_squares(sparsity, left, top)]
    return Markup("\n".join([head, *parts, "</svg>"]))  # noqa: S704 (names escaped above)


def _grid(sparsity: Sparsity, left: float, top: float) -> list[str]:
    width, height = _CELL * len(sparsity.columns), _CELL * len(sparsity.rows)
    parts = [
        f'<rect class="frame" x="{left:.1f}" y="{top:.1f}" width="{width}" height="{height}"/>'
    ]
    for i, name in enumerate(sparsity.rows):
        y = top + _CELL * (i + 0.7)
        parts.append(
            f'<text x="{left - 4:.1f}" y="{y:.1f}" text-anchor="end">{escape(name)}</text>'
        )
    for k, name in enumerate(sparsity.columns):
        x = left + _CELL * (k + 0.7)
        turn = f'transform="rotate(-90 {x:.1f} {top - 4:.1f})"'
        parts.append(f'<text x="{x:.1f}" y="{top - 4:.1f}" {turn}>{escape(name)}</text>')
    return parts


def _squares(sparsity: Sparsity, left: float, top: float) -> list[str]:
    size = _CELL - 3
    return [
        f'<rect x="{left + _CELL * k + 1.5:.1f}" y="{top + _CELL * i + 1.5:.1f}" '
        f'width="{size}" height="{size}"><title>{escape(sparsity.rows[i])} by '
        f"{escape(sparsity.columns[k])}</title></rect>"
        for i, k in sparsity.places()
    ]
