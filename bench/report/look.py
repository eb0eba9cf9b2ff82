"""How methods look in plots: one colour, marker and short name each, the same on the whole page."""

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
    "step_dmv": Look("step_dmv", "#d1495b", "o", "-"),
    "step_taylor": Look("step_taylor", "#00798c", "s", "-"),
    "step_split6": Look("step_split6", "#5c3c92", "^", "-"),
    "step_split": Look("step_split", "#8d6bc4", "v", "-"),
    "step_split2": Look("step_split2", "#b9a3df", ">", "-"),
    "step_lie": Look("step_lie", "#c77700", "D", "-"),
    "step_rk4": Look("step_rk4", "#2e7d32", "p", "-"),
}
PEERS = {
    "DOP853, C": Look("DOP853 in C", "#4d4d4d", "x", "--"),
    "RK4 + normalise, C": Look("RK4 + normalise in C", "#808080", "+", "--"),
    "heyoka (Taylor)": Look("heyoka", "#1f6fd0", "1", "--"),
    "CasADi cvodes": Look("CasADi cvodes", "#7a8ba0", "2", "--"),
    "SciPy DOP853": Look("SciPy DOP853", "#9a7b4f", "3", "--"),
    "MuJoCo RK4": Look("MuJoCo RK4", "#a05a7a", "4", "--"),
}
UNKNOWN = Look("", "#000000", ".", ":")


def look(method: str) -> Look:
    """Return how a method is drawn; a variant of a stepper has its colour, in another line.

    >>> look("step_rk4_compensated")
    Look(label='step_rk4 compensated', colour='#2e7d32', marker='.', line=':')
    """
    if method in OURS | PEERS:
        return (OURS | PEERS)[method]
    for ending, marker, line in ((COMPENSATED, ".", ":"), (ADAPTIVE, "P", "-.")):
        base = method.removesuffix(ending)
        if base != method and base in OURS:
            said = "own steps" if ending == ADAPTIVE else ending[1:]
            return Look(f"{base} {said}", OURS[base].colour, marker, line)
    return Look(method, UNKNOWN.colour, UNKNOWN.marker, UNKNOWN.line)


def rank(point: Point) -> tuple[int, str]:
    """Return where a method stands among the others: ours first, in the order above."""
    names = list(OURS | PEERS)
    base = point.method.removesuffix(COMPENSATED).removesuffix(ADAPTIVE)
    return (names.index(base) if base in names else len(names), point.method)
