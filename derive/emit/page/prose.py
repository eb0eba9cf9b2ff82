"""Sentences for pages: the names of symbols in them written as symbols."""

import re
from html import escape

from markupsafe import Markup

from derive.emit.notation import name_mathml
from derive.emit.notation.glyph import GREEK

_WORD = re.compile(r"[A-Za-z]+(?:_[A-Za-z0-9]+)*")
_CROSS = re.compile(r"(?<=[\w\])]) x (?=[\w(])(?!y\b|z\b|and\b|axis\b)")


def prose(text: str) -> Markup:
    """Return a sentence as HTML: omega becomes its letter, R^T gets its exponent, x between
    vectors its cross.

    >>> prose("R^T R = 1 & so on")
    Markup('R<sup>T</sup> R = 1 &amp; so on')
    """
    shown = escape(text, quote=False).replace("]x", "]×").replace(" - ", " − ")
    shown = _CROSS.sub(" × ", shown)
    shown = re.sub(r"\^([T2])\b", r"<sup>\1</sup>", shown)
    return Markup(_WORD.sub(_symbol, shown))  # noqa: S704 (escaped above)


def _symbol(word: re.Match[str]) -> str:
    name = word.group()
    first = name.split("_")[0]
    if first in GREEK or ("_" in name and len(first) <= 2):
        return name_mathml(name, "scalar")
    return name
