"""What a plot shows, in words for who cannot see it, made of the curves that it draws."""

from collections.abc import Sequence

from bench.report.line import DECADES, Line
from bench.report.look import look
from bench.report.written import figure


def seen(what: str, lines: Sequence[Line], unit: str, floor: float | None) -> str:
    """Return a plot's alternative text: what it is of, what an error costs, where curves end.

    what : case, precision and which error      unit : of costs
    floor : what rounding of the inputs allows, where it is drawn
    """
    drawn = [one for one in lines if one.costs]
    if not drawn:
        return f"{what}: no curve."
    order = sorted(drawn, key=lambda one: min(one.errors))
    ends = [f"{figure(min(one.errors))} ({look(one.method).label})" for one in order]
    reach = f"from {ends[0]} to {ends[-1]}" if len(ends) > 1 else ends[0]
    said = [f"{what} against {unit}.", _asked(drawn, unit), f"Least errors {reach}."]
    if floor:
        said.append(f"A line at {figure(floor)}: what rounding of the inputs allows.")
    return " ".join(word for word in said if word)


def _asked(lines: Sequence[Line], unit: str) -> str:
    """Return what the smallest power of ten costs that at least half of the curves keep to."""
    for error in reversed(DECADES):
        costs = {one.method: c for one in lines if (c := one.cost_of(error))}
        if 2 * len(costs) >= len(lines):
            break
    else:
        return "Most curves keep to no error below 0.1."
    order = sorted(costs, key=lambda method: costs[method])
    first, *others = (look(method).label for method in order)
    ratios = [figure(costs[method] / costs[order[0]]) for method in order[1:]]
    beside = [f"{name} {ratio}" for name, ratio in zip(others, ratios, strict=True)]
    said = f"An error of {figure(error)} costs {first} {figure(costs[order[0]])} {unit}"
    return f"{said}; times that: {', '.join(beside)}." if beside else f"{said}."
