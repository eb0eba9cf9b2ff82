"""An equation in pieces, between which a page may begin a new line.

Browsers break no line inside MathML, so that a long equation would leave its card. Whatever is
wider than a narrow card is cut before a sign of its sum, product or fraction; each piece is MathML
of its own, and the page fills its lines with them.
"""

from collections.abc import Callable
from itertools import pairwise

from derive.emit.notation.glyph import glyph, spelt
from derive.emit.notation.layout import Layout, grouped_sum, in_parentheses, is_number, operand
from derive.emit.notation.mathml import SIGNS, TOUCHING, TRANSPOSED, row, space_between, total_sign
from derive.program.added import added

WIDEST = 14.0
"""Width of a piece in em at most: a card of 300 px less its margins, letters of 18 px."""
HALF = "<mrow><mn>1</mn><mo>/</mo><mn>2</mn></mrow>"
"""What stands above a root that is too wide for its sign."""
_LETTER, _OF_WORD, _SMALL, _SIGN, _FENCES = 0.65, 0.5, 0.4, 1.2, 0.8  # em; small ones: indices


def pieces(layout: Layout) -> list[str]:
    """Return the insides of MathML elements that follow one another on a line or on several.

    >>> from derive.emit.notation.layout import name
    >>> pieces(name("m", "scalar"))
    ['<mi>m</mi>']
    """
    if layout.kind not in _CUT or width(layout) <= WIDEST:
        return [row(layout)]
    return _CUT[layout.kind](layout)


def width(layout: Layout) -> float:
    """Return about how wide a layout is drawn, in em; rather too much than too little."""
    parts = [width(part) for part in layout.parts]
    match layout.kind:
        case "name":
            return _of_name(layout.text)
        case "number":
            return _OF_WORD * len(str(layout.number))
        case "fraction":
            return max(parts) + _SMALL
        case "power":
            return parts[0] + _SMALL * parts[1] / _OF_WORD
        case "sum" | "infix" | "equal" | "negative":
            return added(parts) + _SIGN * max(len(parts) - 1, 1)
        case "product":
            signs = sum(1 for pair in pairwise(layout.parts) if space_between(*pair) != TOUCHING)
            return added(parts) + _SMALL * signs
    return added(parts) + _OF_WORD * len(layout.text) + _FENCES


def _of_name(text: str) -> float:
    parts = glyph(text)
    indices = added(len(spelt(index)) + 0.6 for index in parts.indices)
    small = _SMALL * (indices + len(parts.seen_from)) + (_of_name(parts.by) if parts.by else 0)
    return max(_LETTER, _OF_WORD * len(spelt(parts.base))) + small


def _led(sign: str, layout: Layout) -> list[str]:
    """Return the pieces of a part with a sign before the first."""
    first, *rest = pieces(layout)
    return [f"{sign}{first}", *rest]


def _sign(text: str) -> str:
    return f'<mo form="infix">{text}</mo>'


def _sum(layout: Layout) -> list[str]:
    first, *rest = layout.parts
    found = pieces(first)
    for term in rest:
        minus = term.kind == "negative"
        bare = grouped_sum(term.parts[0]) if minus else term
        found += _led(_sign("−" if minus else "+"), bare)
    return found


def _negative(layout: Layout) -> list[str]:
    return _led('<mo form="prefix">−</mo>', grouped_sum(layout.parts[0]))


def _infix(layout: Layout) -> list[str]:
    left, right = layout.parts
    return [*pieces(left), *_led(_sign(SIGNS[layout.text]), right)]


def _product(layout: Layout) -> list[str]:
    """Return factors, as many in a piece as it holds; a dot says that a piece is one more."""
    found, room = pieces(layout.parts[0]), WIDEST - width(layout.parts[0])
    for before, factor in pairwise(layout.parts):
        first, *rest = pieces(factor)
        room -= width(factor) + _SMALL
        if (room < 0 or rest) and not is_number(before):
            found.append(f"{_sign('·')}{first}")
            room = WIDEST - width(factor)
        else:
            found[-1] += f"{space_between(before, factor)}{first}"
        found += rest
    return found


def _enclosed(inside: list[str], right: str) -> list[str]:
    """Return pieces between fences, which stand apart from each other and so cannot stretch."""
    first, *rest = inside
    each = [f'<mo form="prefix" stretchy="false">(</mo>{first}', *rest]
    return [*each[:-1], each[-1] + right]


def _close(text: str) -> str:
    return f'<mo form="postfix" stretchy="false">{text}</mo>'


def _group(layout: Layout) -> list[str]:
    return _enclosed(pieces(layout.parts[0]), _close(")"))


def _raised(layout: Layout) -> list[str]:
    """Return a power or a transpose; what stands above goes with the closing fence."""
    base = layout.parts[0]
    if base.kind != "group":
        return [row(layout)]
    above = row(layout.parts[1]) if layout.kind == "power" else TRANSPOSED
    return _enclosed(pieces(base.parts[0]), _raised_fence(above))


def _raised_fence(above: str) -> str:
    return f'<msup><mo stretchy="false" rspace="0">)</mo>{above}</msup>'


def _fraction(layout: Layout) -> list[str]:
    """Return a fraction that is too wide on one line: above / below."""
    above, below = (operand(part) for part in layout.parts)
    one = below if is_number(below) or below.kind != "product" else in_parentheses(below)
    return [*pieces(above), *_led(_sign("/"), one)]


def _call(layout: Layout) -> list[str]:
    (inside,) = layout.parts
    if layout.text == "sqrt":
        return _enclosed(pieces(inside), _raised_fence(HALF))
    first, *rest = _enclosed(pieces(inside), _close(")"))
    return [f"<mi>{layout.text}</mi>{first}", *rest]


def _total(layout: Layout) -> list[str]:
    return _led(total_sign(layout), grouped_sum(layout.parts[0]))


_CUT: dict[str, Callable[[Layout], list[str]]] = {
    "sum": _sum,
    "negative": _negative,
    "equal": _infix,
    "infix": _infix,
    "product": _product,
    "group": _group,
    "power": _raised,
    "transposed": _raised,
    "fraction": _fraction,
    "call": _call,
    "total": _total,
}
