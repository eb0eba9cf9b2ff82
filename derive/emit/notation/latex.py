"""A layout, a name, a sentence as LaTeX: vectors bold italic, tensors bold upright, amsmath only.

Names are letters, digits and underscores, so nothing of a scene reaches LaTeX as a command; all
other text goes through ``tex_text``.
"""

import unicodedata
from collections.abc import Callable
from itertools import pairwise

from derive.emit.notation.glyph import GREEK, Glyph, glyph, slanted
from derive.emit.notation.layout import Layout, grouped_sum

SIGNS = {"x": r" \times ", ".": r" \cdot ", "": " = "}
_UNDER = {
    "body": "i",
    "others": r"j \ne i",
    "pairs": "i < j",
    "carrier": r"i \in \mathrm{carrier}",
    "wheel": r"i \in \mathrm{wheel}",
}
_STYLES = {"scalar": "{}", "vector": r"\boldsymbol{{{}}}", "tensor": r"\mathbf{{{}}}"}
_DOTS = {0: "{}", 1: r"\dot{{{}}}", 2: r"\ddot{{{}}}"}
# Greek letters that look like Latin ones have no command of their own.
_CAPITALS = ("Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Upsilon", "Phi", "Psi",
             "Omega")  # fmt: skip
_LATIN = {"omicron": "o", **{n: n[0] for n in GREEK if n[0].isupper() and n not in _CAPITALS}}
_TEXT = {
    **{c: f"\\{c}" for c in "{}$&#_%"},
    "\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}",
    "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}", '"': "''",
    "`": r"\`{}",
}  # fmt: skip
_ACCENTS = {"\u0300": "`", "\u0301": "'", "\u0302": "^", "\u0303": "~", "\u0308": '"',
            "\u0327": "c", "\u030c": "v"}  # fmt: skip


def tex_name(name: str, style: str = "scalar") -> str:
    r"""Return the name of a quantity; several letters stand upright.

    >>> print(tex_name("omega_dot_x"), tex_name("roller_omega_x"), tex_name("speed"))
    \dot{\omega}_{x} \omega_{\mathrm{roller},x} \mathrm{speed}
    """
    return _name(glyph(name), style)


def tex_text(text: str) -> str:
    r"""Return a sentence in which no character is a command.

    >>> print(tex_text("5 % of µ_k \\input{x} à ☃"))
    5 \% of $\mu$\_k \textbackslash{}input\{x\} \`{a} [U+2603]
    """
    return "".join(map(_character, unicodedata.normalize("NFC", text)))


def tex(layout: Layout) -> str:
    """Return ``layout`` in LaTeX's mathematics."""
    if layout.kind not in _FORMS:
        raise LookupError(f"LaTeX has no form for the layout '{layout.kind}'")
    return _FORMS[layout.kind](layout)


def _character(c: str) -> str:
    if c.isascii():
        return _TEXT.get(c, c)
    letter = unicodedata.normalize("NFKD", c)
    names = [name for name, sign in GREEK.items() if sign == letter]
    if names:
        return f"${_letter(names[0])}$"
    if len(letter) == 2 and letter[0].isalpha() and letter[0].isascii() and letter[1] in _ACCENTS:
        return f"\\{_ACCENTS[letter[1]]}{{{letter[0]}}}"
    return f"[U+{ord(c):04X}]"


def _letter(part: str) -> str:
    """Return a Greek letter, a symbol or number as it is, words upright."""
    if part in GREEK:
        return _LATIN.get(part, f"\\{part}")
    upright = r"\ ".join(part.split())
    return part if slanted(part) or part.isdigit() else rf"\mathrm{{{upright}}}"


def _name(parts: Glyph, style: str) -> str:
    base = _STYLES[style].format(_letter(parts.base))
    base = _DOTS[parts.dots].format(base) + ("'" if parts.prime else "")
    indices = ",".join(map(_letter, parts.indices))
    own = f"{base}_{{{indices}}}" if indices else base
    seen = f"{{}}^{{{parts.seen_from}}}{own}" if parts.seen_from else own
    return f"[{seen}]_{{{tex_name(parts.by)}}}" if parts.by else seen


def _sum(layout: Layout) -> str:
    first, *rest = layout.parts
    text = tex(first)
    for term in rest:
        minus = term.kind == "negative"
        bare = grouped_sum(term.parts[0]) if minus else term
        text += f" {'-' if minus else '+'} {tex(bare)}"
    return text


def _product(layout: Layout) -> str:
    text = tex(layout.parts[0])
    for before, factor in pairwise(layout.parts):
        words = {before.kind, factor.kind} & {"call"}
        text += (r" \, " if words else " ") + tex(factor)
    return text


def _call(layout: Layout) -> str:
    inside = ", ".join(map(tex, layout.parts))
    if layout.text == "sqrt":
        return rf"\sqrt{{{inside}}}"
    named = layout.text if layout.text in ("sin", "cos", "tan") else ""
    return (rf"\{named}" if named else rf"\operatorname{{{layout.text}}}") + rf"({inside})"


def _total(layout: Layout) -> str:
    under = _UNDER.get(layout.text, rf"\mathrm{{{layout.text}}}")
    return rf"\sum_{{{under}}} {tex(grouped_sum(layout.parts[0]))}"


def _joined(layout: Layout) -> str:
    return SIGNS[layout.text].join(map(tex, layout.parts))


# One row a kind of layout.
_FORMS: dict[str, Callable[[Layout], str]] = {
    "name": lambda x: _name(glyph(x.text), x.style),
    "number": lambda x: str(x.number),
    "negative": lambda x: f"-{tex(grouped_sum(x.parts[0]))}",
    "sum": _sum,
    "product": _product,
    "infix": _joined,
    "equal": _joined,
    "fraction": lambda x: rf"\frac{{{tex(x.parts[0])}}}{{{tex(x.parts[1])}}}",
    "power": lambda x: f"{{{tex(x.parts[0])}}}^{{{tex(x.parts[1])}}}",
    "transposed": lambda x: rf"{{{tex(x.parts[0])}}}^{{\mathsf{{T}}}}",
    "index": lambda x: f"{{{tex(x.parts[0])}}}_{{{_letter(x.text)}}}",
    "skew": lambda x: rf"[{tex(x.parts[0])}]_{{\times}}",
    "group": lambda x: rf"\left({tex(x.parts[0])}\right)",
    "call": _call,
    "total": _total,
}
