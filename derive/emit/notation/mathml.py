"""A layout as presentation MathML: vectors bold italic, tensors bold upright, no script needed.

Bold letters are characters of their own, since browsers no longer agree on the attribute for them.
"""

from collections.abc import Callable, Sequence
from html import escape
from itertools import pairwise

from derive.emit.notation.glyph import Glyph, glyph, slanted, spelt
from derive.emit.notation.layout import Layout, grouped_sum
from derive.scene.functions import FUNCTIONS

_XML = "http://www.w3.org/1998/Math/MathML"
SIGNS = {"x": "×", ".": "·", "": "="}
_UNDER = {
    "body": "<mi>i</mi>",
    "others": "<mi>j</mi><mo>≠</mo><mi>i</mi>",
    "pairs": "<mi>i</mi><mo>&lt;</mo><mi>j</mi>",
    "carrier": "<mi>i</mi><mo>∈</mo><mtext>carrier</mtext>",
    "wheel": "<mi>i</mi><mo>∈</mo><mtext>wheel</mtext>",
}
# First characters of the mathematical alphabets: Latin capital and small, Greek capital and small.
_ALPHABETS = {
    "scalar": (0x1D434, 0x1D44E, 0x1D6E2, 0x1D6FC),
    "vector": (0x1D468, 0x1D482, 0x1D71C, 0x1D736),
    "tensor": (0x1D400, 0x1D41A, 0x1D6A8, 0x1D6C2),
}
_PLACES = (("A", "Z"), ("a", "z"), ("Α", "Ω"), ("α", "ω"))
_PLANCK = "ℎ"  # the italic small h has its place outside the alphabet
_BOLD_DIGITS = 0x1D7CE
BREAK = "&#8203;"  # a space without width: signs bring their own
DOTS = {1: "˙", 2: "¨"}
"""As accents, browsers draw them into the letter; as an over-script at the letter's own size, clear
of it."""


def math(inside: str) -> str:
    """Return one MathML element within a sentence."""
    return f'<math xmlns="{_XML}">{inside}</math>'


def line(pieces: Sequence[str]) -> str:
    """Return an equation on a line of its own, or on several, broken between its pieces."""
    each = (f'<math xmlns="{_XML}" displaystyle="true">{inside}</math>' for inside in pieces)
    return f'<div class="line">{BREAK.join(each)}</div>'


def styled(text: str, style: str) -> str:
    """Return letters in the mathematical alphabet of a style; other characters stay.

    >>> styled("ω", "vector"), styled("I", "tensor"), styled("1", "tensor")
    ('𝝎', '𝐈', '𝟏')
    """
    return "".join(_character(c, style) for c in text)


def _character(c: str, style: str) -> str:
    if c == "h" and style == "scalar":
        return _PLANCK
    for start, (first, last) in zip(_ALPHABETS[style], _PLACES, strict=True):
        if first <= c <= last:
            return chr(start + ord(c) - ord(first))
    return chr(_BOLD_DIGITS + int(c)) if c.isdigit() and style == "tensor" else c


THIN = '<mspace width="0.17em"/>'
TRANSPOSED = '<mi mathvariant="normal">T</mi>'
TOUCHING = "<mo>&#8290;</mo>"
TIMES = '<mo lspace="0.15em" rspace="0.15em">·</mo>'


def row(layout: Layout) -> str:
    """Return ``layout`` as the inside of a MathML element."""
    if layout.kind not in _FORMS:
        raise LookupError(f"MathML has no form for the layout '{layout.kind}'")
    return _FORMS[layout.kind](layout)


def _call(layout: Layout) -> str:
    if layout.text == "sqrt":
        return f"<msqrt>{row(layout.parts[0])}</msqrt>"
    return _named(f"<mi>{layout.text}</mi>", layout)


def _named(name: str, call: Layout) -> str:
    inside = "<mo>,</mo>".join(map(row, call.parts))
    argument = _argument(call, inside)
    space = THIN if argument == inside else ""
    return f"<mrow>{name}<mo>&#8289;</mo>{space}{argument}</mrow>"


def _power(layout: Layout) -> str:
    """Return a power; that of a sine is written on its name."""
    base, exponent = layout.parts
    if base.kind == "call" and base.text != "sqrt":
        return _named(f"<msup><mi>{base.text}</mi>{row(exponent)}</msup>", base)
    return f"<msup>{row(base)}{row(exponent)}</msup>"


def _total(layout: Layout) -> str:
    return f"<mrow>{total_sign(layout)}{row(grouped_sum(layout.parts[0]))}</mrow>"


def total_sign(layout: Layout) -> str:
    """Return the sign of a sum over bodies, with what it runs over."""
    under = _UNDER.get(layout.text, f"<mtext>{escape(layout.text)}</mtext>")
    return f'<munder><mo movablelimits="false">∑</mo><mrow>{under}</mrow></munder>'


def _product(layout: Layout) -> str:
    """Return factors side by side, apart where they would read as one."""
    text = row(layout.parts[0])
    for before, factor in pairwise(layout.parts):
        text += space_between(before, factor) + row(factor)
    return f"<mrow>{text}</mrow>"


def space_between(before: Layout, after: Layout) -> str:
    """Return what stands between two factors: a dot beside a word, a thin space beside sin."""
    if _base(after).kind == "call" and _base(after).text != "sqrt":
        return TOUCHING + THIN
    return TIMES if _is_word(before) or _is_word(after) or _is_bare(_base(before)) else TOUCHING


def _base(factor: Layout) -> Layout:
    return factor.parts[0] if factor.kind in ("power", "transposed") else factor


def _is_bare(layout: Layout) -> bool:
    """Return whether a layout is a sine or its like of a single sign, without parentheses."""
    circular = layout.kind == "call" and layout.text in FUNCTIONS.keys() - {"sqrt"}
    return circular and layout.parts[0].kind in ("name", "number")


def _is_word(factor: Layout) -> bool:
    """Return whether a factor is a name of several letters, in which nothing is multiplied."""
    base = _base(factor)
    own = glyph(base.text).base if base.kind == "name" else ""
    return len(spelt(own)) > 1 and not slanted(own)


def _joined(layout: Layout) -> str:
    sign = f"<mo>{SIGNS[layout.text]}</mo>"
    return f"<mrow>{sign.join(map(row, layout.parts))}</mrow>"


def _argument(layout: Layout, inside: str) -> str:
    return inside if _is_bare(layout) else _fenced("(", inside, ")")


def _fenced(left: str, inside: str, right: str) -> str:
    return f'<mrow><mo stretchy="false">{left}</mo>{inside}<mo stretchy="false">{right}</mo></mrow>'


def _sum(layout: Layout) -> str:
    first, *rest = layout.parts
    text = row(first)
    for term in rest:
        minus = term.kind == "negative"
        bare = grouped_sum(term.parts[0]) if minus else term
        text += f"<mo>{'−' if minus else '+'}</mo>{row(bare)}"
    return f"<mrow>{text}</mrow>"


def _name(parts: Glyph, style: str) -> str:
    base = _accented(parts, _letter(parts.base, style))
    if parts.seen_from:
        below = _indices(parts) if parts.indices else "<mrow></mrow>"
        after = f"{below}<mrow></mrow><mprescripts/><mrow></mrow><mi>{parts.seen_from}</mi>"
        return f"<mmultiscripts>{base}{after}</mmultiscripts>"
    return f"<msub>{base}{_indices(parts)}</msub>" if parts.indices or parts.by else base


def _accented(parts: Glyph, base: str) -> str:
    if parts.prime:
        base = f"<msup>{base}<mo>′</mo></msup>"
    if parts.dots:
        dots = f'<mo accent="false" stretchy="false" scriptlevel="-1">{DOTS[parts.dots]}</mo>'
        base = f'<mover accent="false">{base}{dots}</mover>'
    return base


def _letter(base: str, style: str) -> str:
    letter = spelt(base)
    if style != "scalar" or (slanted(base) and len(letter) > 1):
        letter = styled(letter, style)
    if letter.isdigit():
        return f"<mn>{letter}</mn>"
    return f"<mi>{escape(letter)}</mi>"


def _indices(parts: Glyph) -> str:
    items = [_letter(index, "scalar") for index in parts.indices]
    if parts.by:
        items.append(f"<mo>∕</mo>{_name(glyph(parts.by), 'scalar')}")
    gap = '<mspace width="0.25em"/>'
    return items[0] if len(items) == 1 else f"<mrow>{gap.join(items)}</mrow>"


# One row a kind of layout.
_FORMS: dict[str, Callable[[Layout], str]] = {
    "name": lambda x: _name(glyph(x.text), x.style),
    "number": lambda x: f"<mn>{x.number}</mn>",
    "negative": lambda x: f"<mrow><mo>−</mo>{row(grouped_sum(x.parts[0]))}</mrow>",
    "sum": _sum,
    "product": _product,
    "infix": _joined,
    "equal": _joined,
    "fraction": lambda x: f"<mfrac>{row(x.parts[0])}{row(x.parts[1])}</mfrac>",
    "power": _power,
    "transposed": lambda x: f"<msup>{row(x.parts[0])}{TRANSPOSED}</msup>",
    "index": lambda x: f"<msub>{row(x.parts[0])}{_letter(x.text, 'scalar')}</msub>",
    "skew": lambda x: f"<msub>{_fenced('[', row(x.parts[0]), ']')}<mo>×</mo></msub>",
    "group": lambda x: _fenced("(", row(x.parts[0]), ")"),
    "call": _call,
    "total": _total,
}
