"""What an equation looks like, before it is text or MathML: names, products, sums, fractions.

A layout knows where parentheses are needed; the two printers only draw.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

_SUM, _PRODUCT, _ATOM = 1, 2, 9
_LEVELS = {"sum": _SUM, "negative": _SUM, "total": _PRODUCT, "infix": _PRODUCT, "product": _PRODUCT}


@dataclass(frozen=True)
class Layout:
    """One sign or one arrangement of parts.

    kind : name | number | negative | sum | product | infix | fraction | power | index | call
           | total | skew | transposed | group | equal
    text : the name, the infix ("x" or "."), the index, the function, or what a total runs over
    style : of a name: "scalar", "vector" or "tensor"
    """

    kind: str
    parts: tuple[Layout, ...] = ()
    text: str = ""
    style: str = "scalar"
    number: Fraction = Fraction(0)


def name(text: str, style: str) -> Layout:
    """Return a symbol's name."""
    return Layout("name", text=text, style=style)


def number(value: Fraction) -> Layout:
    """Return an exact number; a negative one is a sign before a positive one."""
    if value < 0:
        return negative(number(-value))
    if value.denominator == 1:
        return Layout("number", number=value)
    above, below = Fraction(value.numerator), Fraction(value.denominator)
    return Layout("fraction", (number(above), number(below)))


def negative(part: Layout) -> Layout:
    """Return minus ``part``; two signs are none."""
    return part.parts[0] if part.kind == "negative" else Layout("negative", (part,))


def added(parts: list[Layout]) -> Layout:
    """Return a flat sum."""
    flat = [term for part in parts for term in (part.parts if part.kind == "sum" else (part,))]
    return flat[0] if len(flat) == 1 else Layout("sum", tuple(flat))


def multiplied(parts: list[Layout]) -> Layout:
    """Return a flat product, its signs collected in front and factors 1 left out."""
    minus = False
    flat: list[Layout] = []
    for part in parts:
        if part.kind == "negative":
            minus = not minus
        bare = part.parts[0] if part.kind == "negative" else part
        flat += bare.parts if bare.kind == "product" else (bare,)
    flat = _squared([f for f in flat if f != ONE]) or [ONE]
    whole = flat[0] if len(flat) == 1 else Layout("product", tuple(_closed(flat)))
    return negative(whole) if minus else whole


ONE = number(Fraction(1))
IDENTITY = name("1", "tensor")


def _squared(factors: list[Layout]) -> list[Layout]:
    """Return the factors, a scalar that stands beside itself as its square."""
    found: list[Layout] = []
    for factor in factors:
        scalar = factor.style == "scalar" and factor.kind == "name"
        if scalar and found and found[-1] == factor:
            found[-1] = Layout("power", (factor, number(Fraction(2))))
        else:
            found.append(factor)
    return found


def applied(tensor: Layout, to: Layout) -> Layout:
    """Return a tensor before what it acts on; a multiple of the identity is grouped."""
    multiple = tensor.kind == "product" and tensor.parts[-1] == IDENTITY
    return multiplied([in_parentheses(tensor) if multiple else tensor, to])


def _closed(factors: list[Layout]) -> list[Layout]:
    """Return the factors of a product, grouped where reading on would change the meaning."""
    return [_factor(each, factors[:i], factors[i + 1 :]) for i, each in enumerate(factors)]


def _factor(factor: Layout, before: list[Layout], after: list[Layout]) -> Layout:
    if factor.kind in ("sum", "negative"):
        return in_parentheses(factor)
    if factor.kind == "total":
        return in_parentheses(factor) if after else factor
    if factor.kind != "infix":
        return factor
    if after or not all(_scales(each, factor.text) for each in before):
        return in_parentheses(factor)
    return factor


def _scales(factor: Layout, infix: str) -> bool:
    """Return whether a factor may stand before a dot or cross product without parentheses."""
    if is_number(factor):
        return True
    return infix == "." and factor.kind == "name" and factor.style == "scalar"


def is_number(layout: Layout) -> bool:
    """Return whether a layout is a whole number or a fraction of whole numbers."""
    parts = layout.parts if layout.kind == "fraction" else (layout,)
    return all(part.kind == "number" for part in parts)


def infix(sign: str, left: Layout, right: Layout) -> Layout:
    """Return a dot or cross product; anything but a single sign is grouped."""
    return Layout("infix", (operand(left), operand(right)), sign)


def operand(part: Layout) -> Layout:
    """Return ``part`` so that an index, a power or a product sign can stand beside it."""
    return in_parentheses(part) if _LEVELS.get(part.kind, _ATOM) < _ATOM else part


def grouped_sum(part: Layout) -> Layout:
    """Return what a minus or the sign of a sum may stand before: a sum is grouped."""
    return in_parentheses(part) if part.kind == "sum" else part


def in_parentheses(part: Layout) -> Layout:
    """Return ``part`` in parentheses."""
    return Layout("group", (part,))
