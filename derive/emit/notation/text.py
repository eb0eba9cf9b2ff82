"""A layout as plain ASCII text, for comments and terminals."""

from derive.emit.notation.layout import Layout, grouped_sum, in_parentheses, is_number, operand

_TOTALS = {"body": "sum"}  # every other sum says what it runs over


def plain(layout: Layout) -> str:
    """Return ``layout`` in one line of ASCII."""
    parts = layout.parts
    match layout.kind:
        case "name" | "number":
            return layout.text or str(layout.number)
        case "sum":
            return _sum(parts)
        case "negative":
            return f"-{plain(grouped_sum(parts[0]))}"
        case "product":
            return _product(parts)
        case "infix":
            return f"{plain(_atom(parts[0]))} {layout.text} {plain(_atom(parts[1]))}"
        case "fraction":
            return f"{plain(operand(parts[0]))}/{plain(_atom(operand(parts[1])))}"
        case "power":
            return f"{plain(_atom(parts[0]))}^{plain(parts[1])}"
        case "equal":
            return f"{plain(parts[0])} = {plain(parts[1])}"
        case "group":
            return plain(parts[0]) if parts[0].kind == "total" else f"({plain(parts[0])})"
    return _marked(layout)


def _marked(layout: Layout) -> str:
    """Return what is written as a name with something in brackets or behind it."""
    inside = ", ".join(map(plain, layout.parts))
    match layout.kind:
        case "call":
            return f"{layout.text}({inside})"
        case "total":
            return f"{_TOTALS.get(layout.text, f'sum_{layout.text}')}({inside})"
        case "skew":
            return f"[{inside}]x"
        case "transposed":
            return f"{inside}^T"
        case "index":
            return f"{inside}_{layout.text}"
    raise LookupError(f"plain text has no form for the layout '{layout.kind}'")


def _atom(part: Layout) -> Layout:
    """In one line a fraction needs parentheses beside other signs."""
    return in_parentheses(part) if part.kind == "fraction" else part


def _sum(terms: tuple[Layout, ...]) -> str:
    text = plain(terms[0])
    for term in terms[1:]:
        sign = " - " if term.kind == "negative" else " + "
        text += sign + plain(term).removeprefix("-")
    return text


def _product(factors: tuple[Layout, ...]) -> str:
    first, *rest = factors
    if not is_number(first):
        first = _atom(first)
    return " ".join(plain(factor) for factor in (first, *map(_atom, rest)))
