"""Dots over letters are drawn clear of them: browsers draw accents into the letter."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.emit.opened.opened import greys

pytestmark = pytest.mark.browser
GENERATED = Path(__file__).parents[3] / "generated"
OVER = re.compile(r'<mover accent="\w+">(?:(?!<mover).)*?</mover>')
CELL, COLUMNS, INK = 48, 20, 110
"""Sides of a cell in px, cells beside each other, and how dark a pixel of ink is at least."""


def cells(letters: list[str]) -> str:
    """Return a page with each letter in a cell of its own."""
    places = (
        f'<div style="left:{CELL * (i % COLUMNS)}px;top:{CELL * (i // COLUMNS)}px"><math>{one}'
        "</math></div>"
        for i, one in enumerate(letters)
    )
    box = f"position:absolute;width:{CELL}px;height:{CELL}px;line-height:{CELL}px"
    style = f"div{{{box};font-size:18px;text-align:center}}"
    head = f'<head><meta charset="utf-8"/><style>{style}</style></head>'
    return f"<!DOCTYPE html><html>{head}<body>{''.join(places)}</body></html>"


def layers(letters: list[str], shown: Any, folder: Path) -> list[int]:
    """Return in how many layers, one above another and apart, each letter is drawn."""
    high = CELL * (1 + len(letters) // COLUMNS)
    shown.set_viewport_size({"width": CELL * COLUMNS, "height": high})
    shown.set_content(cells(letters))
    shown.screenshot(path=folder / "letters.png")
    dark = greys(folder / "letters.png") < 255 - INK
    found = []
    for i in range(len(letters)):
        top, left = CELL * (i // COLUMNS), CELL * (i % COLUMNS)
        inked = dark[top : top + CELL, left : left + CELL].any(axis=1)
        found.append(int(np.count_nonzero(inked[1:] & ~inked[:-1])))
    return found


def test_every_dot_is_drawn_clear_of_its_letter(shown: Any, tmp_path: Path) -> None:
    text = "".join(page.read_text(encoding="utf-8") for page in GENERATED.rglob("*.html"))
    dotted = sorted(set(OVER.findall(text)))
    bare = [re.sub(r'<mover accent="\w+">(.*)<mo .*?</mo></mover>', r"\1", one) for one in dotted]
    assert len(dotted) > 20
    apart = dict(zip(dotted, layers(dotted, shown, tmp_path), strict=True))
    alone = layers(bare, shown, tmp_path)
    assert [one for one, base in zip(dotted, alone, strict=True) if apart[one] != base + 1] == []
    drawn_in = [one.replace('accent="false"', 'accent="true"') for one in dotted]
    assert any(n < apart[d] for n, d in zip(layers(drawn_in, shown, tmp_path), dotted, strict=True))
