"""Names of drawings, as a browser draws them: no two of one drawing lie over each other."""

from pathlib import Path
from typing import Any

import pytest

from tests.emit.opened.opened import loaded

pytestmark = pytest.mark.browser
INDEX = Path(__file__).parents[3] / "generated" / "index.html"
OVER = """() => [...document.querySelectorAll('svg.drawing')].flatMap(drawing => {
  const each = [...drawing.querySelectorAll('text')].map(e => [e.textContent, e.getBBox()]);
  const over = (a, b) => a.x < b.x + b.width - 1 && b.x < a.x + a.width - 1
    && a.y < b.y + b.height - 5 && b.y < a.y + a.height - 5;
  return each.flatMap(([one, a], n) => each.slice(n + 1).filter(([, b]) => over(a, b))
    .map(([other]) => `${drawing.getAttribute('aria-label')} ${one} over ${other}`));
})"""
"""Boxes hold the room above and below letters: five px of their height may be shared."""


def test_no_two_names_of_a_drawing_lie_over_each_other(shown: Any) -> None:
    loaded(INDEX, shown)
    assert shown.evaluate("() => document.querySelectorAll('svg.drawing text').length") > 100
    assert shown.evaluate(OVER) == []


def test_a_name_over_another_is_seen(shown: Any) -> None:
    text = '<text x="{}" y="20">weight</text>'
    texts = "".join(map(text.format, (10, 24, 90)))
    shown.set_content(f'<svg class="drawing" aria-label="Two." width="200">{texts}</svg>')
    assert shown.evaluate(OVER) == ["Two. weight over weight"]
