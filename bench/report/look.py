"""How methods look in plots: one colour, marker and short name each, the same on the whole page.

A colour has a shade for light paper and one for dark, both readable as text on it. Plots are drawn
with the first; ``slim`` puts a variable in its place, whose value the page's scheme decides.
"""

from dataclasses import dataclass

from bench.report.point import Point

COMPENSATED, ADAPTIVE = "_compensated", "_adaptive"


@dataclass(frozen=True)
class Look:
    """What a method's curve is drawn with."""

    label: str
    colour: str
    marker: str
    line: str


OURS = {
    "flow_exact": Look("flow_exact", "#111111", "*", "-"),
    "step_dmv": Look("step_dmv", "#c02942", "o", "-"),
    "step_taylor": Look("step_taylor", "#00707e", "s", "-"),
    "step_split6": Look("step_split6", "#4b2e83", "^", "-"),
    "step_split": Look("step_split", "#8250c4", "v", "-"),
    "step_split2": Look("step_split2", "#9a4fb0", ">", "-"),
    "step_lie": Look("step_lie", "#a35800", "D", "-"),
    "step_rk4": Look("step_rk4", "#2a7a2e", "p", "-"),
}
PEERS = {
    "DOP853, C": Look("DOP853 in C", "#4d4d4d", "x", "--"),
    "RK4 + normalise, C": Look("RK4 in C", "#6b6b6b", "+", "--"),
    "heyoka (Taylor)": Look("heyoka", "#1f63bd", "1", "--"),
    "CasADi cvodes": Look("CasADi cvodes", "#56677c", "2", "--"),
    "SciPy DOP853": Look("SciPy DOP853", "#7d5f2e", "3", "--"),
    "MuJoCo RK4": Look("MuJoCo RK4", "#944578", "4", "--"),
}
UNKNOWN = Look("", "#5d1f1f", ".", ":")
INK, SOFT, GRID, GOLD = "#1a1c20", "#5b626d", "#dfe2e7", "#806000"
NIGHT = {
    "#111111": "#fafafa", "#c02942": "#ff8295", "#00707e": "#4cc6d4", "#4b2e83": "#a78eff",
    "#8250c4": "#dcc4ff", "#9a4fb0": "#e39af6", "#a35800": "#f2a654", "#2a7a2e": "#78cf7d",
    "#4d4d4d": "#cfcfcf", "#6b6b6b": "#a8a8a8", "#1f63bd": "#86b6ff", "#56677c": "#aebfd6",
    "#7d5f2e": "#d6b680", "#944578": "#ea9fc9", "#5d1f1f": "#f0b0b0", GOLD: "#e3b341",
}  # fmt: skip
"""The shade of each colour on dark paper."""
PAINT = {day: f"--c{n}" for n, day in enumerate(NIGHT)} | {
    INK: "--ink", SOFT: "--soft", GRID: "--line"
}  # fmt: skip
"""The variable that stands for a colour on the page; the last three are the page's own."""


def shades() -> dict[str, tuple[str, str]]:
    """Return the shades of every variable of the plots, for light paper and for dark."""
    return {PAINT[day]: (day, night) for day, night in NIGHT.items()}


def look(method: str) -> Look:
    """Return how a method is drawn; a variant of a stepper has its colour, in another line.

    >>> look("step_rk4_compensated")
    Look(label='step_rk4 compensated', colour='#2a7a2e', marker='.', line=':')
    """
    if method in OURS | PEERS:
        return (OURS | PEERS)[method]
    for ending, marker, line in ((COMPENSATED, ".", ":"), (ADAPTIVE, "P", "-.")):
        base = method.removesuffix(ending)
        if base != method and base in OURS:
            said = "own steps" if ending == ADAPTIVE else ending[1:]
            return Look(f"{base} {said}", OURS[base].colour, marker, line)
    return Look(method, UNKNOWN.colour, UNKNOWN.marker, UNKNOWN.line)


def plain(method: str) -> str:
    """Return the stepper that a method is, or is a variant of."""
    return method.removesuffix(COMPENSATED).removesuffix(ADAPTIVE)


def rank(point: Point) -> tuple[int, str]:
    """Return where a method stands among the others: ours first, in the order above."""
    names = list(OURS | PEERS)
    base = plain(point.method)
    return (names.index(base) if base in names else len(names), point.method)
