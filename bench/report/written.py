"""Numbers as people write them."""

import math

SMALLEST, LARGEST = 1e-2, 1e4  # numbers outside are written with an exponent


def figure(x: float | None) -> str:
    """Return a number as people write it.

    >>> figure(1e-12), figure(0.25), figure(None), figure(3.2e-9), figure(660.2)
    ('1e-12', '0.25', '', '3.2e-9', '660')
    """
    if x is None:
        return ""
    if math.isnan(x):
        return "NaN"
    if x == 0 or SMALLEST <= abs(x) < LARGEST:
        return f"{x:.2g}" if abs(x) < LARGEST / 100 else f"{x:.0f}"
    digits, exponent = f"{x:.1e}".split("e")
    return f"{digits.removesuffix('.0')}e{int(exponent)}"


def power(x: float, _: int = 0) -> str:
    """Return a power of ten as text: plain characters, which are quick to draw and to search.

    >>> power(1e-12)
    '10⁻¹²'
    """
    digits = "⁰¹²³⁴⁵⁶⁷⁸⁹"
    exponent = round(math.log10(x))
    raised = "".join(digits[int(d)] for d in str(abs(exponent)))
    return f"10{'⁻' if exponent < 0 else ''}{raised}"


def counted(x: float | None) -> str:
    """Return a count with its thousands set apart.

    >>> counted(1871.0)
    '1\u202f871'
    """
    return "" if x is None else f"{x:,.0f}".replace(",", "\u202f")
