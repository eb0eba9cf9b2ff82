"""What Eva is told of functions that others call: bounds of what they return, for their bodies.

Its intervals forget that two values hang together. Sines of our own, and pairs of floats, live on
that: what rounding took from a sum is a difference that cancels. So bounds that are proved
elsewhere stand for their bodies, and these are tried alone, with what they are given.
"""

import re
from collections.abc import Iterable, Sequence

import numpy as np

from derive.program.own_sine import FITTED
from derive.program.precision import PRECISIONS, Precision
from derive.verify.proved.enclosed import SIZEABLE
from derive.verify.proved.ranges import NEAR, wave
from derive.verify.proved.regular import PairOperation

SIXTEENTHS = 7 * 16
"""Pieces of 1/16 rad on either side of 0, on each of which a sine has its bounds."""
SINES = re.compile(
    r"^(?P<head>static (?P<type>\w+) (?P<symbol>\w+_sine_cosine_f\d\d)\((?P<kind>\w+) angle\)\n)"
    r"\{.*?^\}$",
    re.MULTILINE | re.DOTALL,
)
PAIRS = re.compile(
    r"^(?P<head>static (?P<type>\w+_pair_(?P<kind>f\d\d)) "
    r"(?P<symbol>\w+_(?P<name>add|mul|two_product|div|sqrt|sine|power_of_two)_f\d\d)\([^)]*\)\n)\{.*?^\}$",
    re.MULTILINE | re.DOTALL,
)
VALUES = {
    "add": "(a.high + b.high) + (a.low + b.low)",
    "mul": "a.high * b.high",
    "two_product": "a * b",
    "div": "a.high / b.high",
    "sqrt": "{sqrt}(a.high)",
}
"""What operations on pairs return, but for a few units in the last place of a float."""
CALLED = {"sub": ("add",), "sin": ("sine", "0"), "cos": ("sine", "1")}
"""What does an operation whose own name calls nothing but it, and with what besides."""
RETURNED = "Frama_C_show_each_returned"
"""What Eva tells of where it gets to: nothing is shown of what it never does."""
WAVES = ("sin", "cos")
POLYNOMIAL = ((-64.0, 64.0),) * 2
"""Far more than operands in the polynomial of a sine of pairs are."""
POWERS = [(2.0**n, 2.0 ** (n + 1) * (1 - NEAR)) for n in range(-64, 64)]
"""Powers of two, and up to where a number surely has none above."""
AROUND = 16
"""In u: more than low parts of operands and the rounding of what is above move a high part."""


def with_bounds(text: str) -> str:
    """Return C with its own sines, and operations on pairs, replaced by what is stated of them."""
    return PAIRS.sub(_bounded_pair, SINES.sub(_bounded_sine, plain(text)))


def plain(text: str) -> str:
    """Return C without what keeps compilers from copying functions: Eva forgets what these return.

    >>> plain("DERIVE_APART static int f(void);")
    'static int f(void);'
    """
    return text.replace("DERIVE_APART static", "static")


def _bounded_sine(of: re.Match[str]) -> str:
    precision = next(p for p in PRECISIONS if p.scalar == of["kind"])
    each = [_wave(f"found.{n}", "angle", k, precision) for k, n in enumerate(("sine", "cosine"))]
    body = (f"    {of['type']} found;", *each[0], *each[1], "    return found;")
    return "\n".join([f"{of['head']}{{", *body, "}"])


def _wave(name: str, angle: str, which: int, precision: Precision) -> list[str]:
    """Return C that puts any float within two units in the last place of sines into a name.

    Bounds of pieces are tables: choices within choices, as many, take Eva seconds to read.
    Rounding may take an angle at an edge for one of the piece beside, so pieces overlap.
    """
    kind, u = precision.scalar, precision.unit_roundoff
    edges = np.arange(-SIXTEENTHS, SIXTEENTHS + 2) / 16
    low, high = wave((edges[:-1] - 16 * u, edges[1:] + 16 * u), which)
    ends = [ends_in_c(*each, precision) for each in zip(low - 4 * u, high + 4 * u, strict=True)]
    tables = zip(("least", "most"), zip(*ends, strict=True), strict=True)
    return [
        f"    {name} = {between(-1 - 4 * u, 1 + 4 * u, precision)};",
        f"    if ({angle} >= {edges[0]} && {angle} < {-edges[0]}) {{",
        *(f"        static const {kind} {n}[] = {{{', '.join(ends)}}};" for n, ends in tables),
        f"        const int piece = (int)(({angle} + {-edges[0]}) * 16);",
        f"        /*@ admit least[piece] <= {name} <= most[piece]; */",
        "    }",
    ]


def _bounded_pair(of: re.Match[str]) -> str:
    precision = next(p for p in PRECISIONS if p.name == of["kind"])
    u, least = precision.unit_roundoff, SIZEABLE[precision.bits]
    lost = between(-least, least, precision)
    return "\n".join([
        f"{of['head']}{{",
        f"    {precision.scalar} value;",
        *_value(of["name"], precision),
        f"    const {precision.scalar} lost = {lost}{' / b.high' * (of['name'] == 'div')};",
        f"    {of['type']} found;",
        f"    found.high = (value * {between(1 - AROUND * u, 1 + AROUND * u, precision)}) + lost;",
        f"    found.low = (found.high * {between(-2 * u, 2 * u, precision)}) + lost;",
        "    return found;",
        "}",
    ])  # fmt: skip


def _value(name: str, precision: Precision) -> list[str]:
    """Return C of what an operation returns, but for a few units in the last place."""
    if name == "sine":
        each = [_wave("value", "a.high", which, precision) for which in (0, 1)]
        return ["    if (quarters < 0.5) {", *each[0], "    } else {", *each[1], "    }"]
    if name == "power_of_two":
        return [
            f"    value = a.high * {between(0.49, 1.01, precision)};",
            *(f"    if (a.high >= {x} && a.high <= {y}) {{ value = {x}; }}" for x, y in POWERS),
        ]
    return [f"    value = {VALUES[name].format(**precision.functions)};"]


def trial_of_sines(text: str, precision: Precision) -> str:
    """Return C that calls its own sines at any angle that they serve, "" if it has none."""
    most = float(FITTED[precision.bits].largest)
    angle = between(-most, most, precision)
    return _trial(text, [f"{of['symbol']}({angle})" for of in SINES.finditer(text)])


def trials_of_pairs(
    text: str, each: Iterable[PairOperation], precision: Precision
) -> dict[str, str]:
    """Return C that does operations on pairs with all that their operands may be, by what it tries.

    The low part of a pair is half a unit in the last place of the high one at most. What is
    stated of sums and products stands for them in the trial of sines: they are tried besides.
    """
    sines = {of for of in each if of[0] in WAVES}
    others = {*each} - sines | ({("add", POLYNOMIAL), ("mul", POLYNOMIAL)} if sines else set())
    own = PAIRS.sub(lambda of: of[0] if of["name"] == "sine" else _bounded_pair(of), plain(text))
    return {"pairs": _operations(text, sorted(others), precision),
            "sines of pairs": _operations(own, sorted(sines), precision)}  # fmt: skip


def _operations(text: str, each: Iterable[PairOperation], precision: Precision) -> str:
    own = {of["name"]: of for of in PAIRS.finditer(plain(text))}
    calls = []
    for operator, operands in each:
        name, *more = CALLED.get(operator, (operator,))
        given = [f"({own[name]['type']}){{{_pair(ends, precision)}}}" for ends in operands]
        calls.append(f"{own[name]['symbol']}({', '.join([*given, *more])})")
    return _trial(text, calls)


def _pair(ends: tuple[float, float], precision: Precision) -> str:
    most = 2 * precision.unit_roundoff * max(map(abs, ends))
    return f"{between(*ends, precision)}, {between(-most, most, precision)}"


def _trial(text: str, calls: Sequence[str]) -> str:
    body = "".join(f"    {call};\n" for call in [*calls, f"{RETURNED}(0)"])
    return (
        f'#include "__fc_builtin.h"\n{plain(text)}\nvoid main(void)\n{{\n{body}}}\n'
        if calls
        else ""
    )


def between(low: float, high: float, precision: Precision) -> str:
    """Return the C of any float between two numbers, or next to one that is none."""
    return f"Frama_C_{precision.scalar}_interval({', '.join(ends_in_c(low, high, precision))})"


def ends_in_c(low: float, high: float, precision: Precision) -> tuple[str, str]:
    """Return the C of the nearest floats that have two numbers between them, finite ones.

    What becomes infinite is an alarm where it does; from there on nothing is asked.
    """
    kind, ends = precision.dtype, []
    most = float(np.finfo(kind).max)
    for end, way in ((low, -np.inf), (high, np.inf)):
        held = kind(end)
        inward = float(held) > end if way < 0 else float(held) < end
        ends.append(float(np.nextafter(held, kind(way))) if inward else float(held))
    low, high = (min(max(end, -most), most) for end in ends)
    return low.hex(), high.hex()
