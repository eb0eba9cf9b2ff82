"""The one sentence of a report: which step, how long, for which error, at what cost.

A length of step is stated if at it, and at half and a quarter of it, the hardest states that were
found end within half of the error that is stated: states that were not looked at may be worse. What
no step keeps below is told by the same rule: one length that happens to end well is no promise.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import floor, inf, isfinite, log10

from derive.motion.runge_kutta.system import FLOW
from derive.report.courses import Attempt, StepErrors
from derive.report.found import FunctionFigures

TARGETS = (1e-6, 1e-4, 1e-3, 1e-2)
MARGIN = 2.0
FINER = 2
TYPE_NAMES = {"f64": "double", "f32": "float"}


@dataclass(frozen=True)
class Cheapest:
    """The cheapest step for an error in a precision: its attempt, weighted operations a second."""

    attempt: Attempt
    operations: float


@dataclass(frozen=True)
class Statement:
    """An error, and the choice for it by precision; None where no step keeps to it."""

    target: float
    choices: Mapping[str, Cheapest | None]


def of_step(of: StepErrors, step: str, precision: str) -> list[Attempt]:
    """Return a step's attempts, coarse to fine."""
    return [a for a in of.attempts if (a.step, a.precision) == (step, precision)]


def choice(of: StepErrors, step: str, precision: str, target: float) -> Cheapest | None:
    """Return the longest length of a step that keeps to an error, None if none does."""
    for attempt, kept in kept_to(of_step(of, step, precision)):
        if kept <= target / MARGIN:
            return Cheapest(attempt, of.costs[step] * attempt.count / of.time)
    return None


def kept_to(own: Sequence[Attempt]) -> list[tuple[Attempt, float]]:
    """Return a step's attempts, coarse to fine, with the largest error of it and its finer ones.

    The last ones, of which no half or quarter was tried, are left out; a flow has one length.
    """
    more = 0 if own and own[0].step == FLOW else FINER
    whole = range(len(own) - more)
    return [(own[n], max(a.worst for a in own[n : n + 1 + more])) for n in whole]


def cheapest(of: StepErrors, precision: str, target: float) -> Cheapest | None:
    """Return the step that is cheapest for an error, None if none keeps to it."""
    steps = dict.fromkeys(a.step for a in of.attempts)
    found = [choice(of, step, precision, target) for step in steps]
    return min((c for c in found if c), key=lambda c: c.operations, default=None)


def least(of: StepErrors, precision: str, steps: Iterable[str]) -> float:
    """Return the smallest error that any of some steps keeps to from the hardest states."""
    own = (kept_to(of_step(of, step, precision)) for step in steps)
    return min((kept for each in own for _, kept in each), default=inf)


def said_of(of: StepErrors) -> Statement:
    """Return what is said: the smallest of ``TARGETS`` that some step keeps to."""
    for target in TARGETS:
        found = {p: cheapest(of, p, target) for p in TYPE_NAMES}
        if any(found.values()):
            return Statement(target, found)
    return Statement(TARGETS[-1], dict.fromkeys(TYPE_NAMES))


def motion_sentence(of: StepErrors, times: Mapping[tuple[str, str], float] | None = None) -> str:
    """Return the sentence on motion; with ``times``, ns by step and precision, they are in it."""
    said = said_of(of)
    goal = f"for {said.target:.0e}".replace("e-0", "e-") + f" over {of.time:.6g} s"
    parts = [_in_precision(of, said, p, times or {}) for p in TYPE_NAMES]
    return f"{goal}: {'; '.join([*parts, *left_aside(of)])}"


def left_aside(of: StepErrors) -> list[str]:
    """Return what is said of states that were left aside: how many, which share, and why.

    No sentence if there are none.
    """
    each = sorted(of.aside.items(), key=lambda item: -item[1])
    return [f"left aside: of {of.tried} states tried, " + ", ".join(
        f"{count} ({share(count / of.tried)}) whose motion {why}" for why, count in each
    )] if each else []  # fmt: skip


def share(part: float) -> str:
    """Return a part as percent, never as none or all where it is not.

    >>> share(0.58), share(0.0013), share(0.999)
    ('58 %', 'under 1 %', 'over 99 %')
    """
    if 0 < part < 0.01:
        return "under 1 %"
    return "over 99 %" if 0.99 < part < 1 else f"{100 * part:.0f} %"


def _in_precision(
    of: StepErrors, said: Statement, precision: str, times: Mapping[tuple[str, str], float]
) -> str:
    found, name = said.choices[precision], TYPE_NAMES[precision]
    if found is None:
        low = least(of, precision, of.costs)
        if 1 <= low < inf:
            return f"in {name} no step tried ends near the true motion"
        reached = f"keeps below {rounded_down(low, 1)}" if isfinite(low) else "follows every motion"
        return f"in {name} no step tried {reached}"
    step, cost = found.attempt.step, of.costs[found.attempt.step]
    took = times.get((step, precision))
    spent = f"{cost} weighted operations" + ("" if took is None else f", {in_time(took * 1e-9)}")
    if step == FLOW:
        return f"{step} in {name}, at once, {spent}"
    return f"{step} at {in_time(found.attempt.length)} in {name}, {spent} a step"


def functions_sentence(figures: Sequence[FunctionFigures]) -> str:
    """Return the sentence on a scene whose functions move nothing."""
    own = [f for f in figures if f.form == figures[0].form]
    costs = sorted({f.weighted_operations for f in own if f.precision == "f64"})
    count = len({f.function for f in own})
    most = ", ".join(f"{rounded_up(max(f.largest for f in own if f.precision == p))} in {says}"
                     for p, says in TYPE_NAMES.items())  # fmt: skip
    spread = f"{costs[0]}" if len(costs) == 1 else f"{costs[0]} to {costs[-1]}"
    what = "1 function" if count == 1 else f"{count} functions"
    found = "largest error found, in u of the largest product"
    return f"{what} of {spread} weighted operations; {found}: {most}"


def in_time(seconds: float) -> str:
    """Return a time rounded down to two digits, in the unit that suits it.

    >>> in_time(0.0048828125), in_time(1.5e-7), in_time(2.0)
    ('4.8 ms', '150 ns', '2 s')
    """
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9)):
        if seconds >= size or unit == "ns":
            return f"{rounded_down(seconds / size, 2)} {unit}"
    return ""


def rounded_down(x: float, digits: int) -> str:
    """Return a positive number rounded down to some digits.

    >>> rounded_down(3.97e-5, 1), rounded_down(4.88, 2), rounded_down(150.0, 2)
    ('3e-5', '4.8', '150')
    """
    step = 10.0 ** (floor(log10(x)) - digits + 1)
    return _short(floor(x / step * (1 + 1e-12)) * step)


def rounded_up(x: float) -> str:
    """Return a positive number rounded up to two digits.

    >>> rounded_up(2.641), rounded_up(11.0)
    ('2.7', '11')
    """
    if not isfinite(x) or x == 0:
        return f"{x:g}"
    step = 10.0 ** (floor(log10(x)) - 1)
    return _short(-floor(-x / step * (1 - 1e-12)) * step)


def _short(x: float) -> str:
    text = f"{x:.2g}" if x < 100 else f"{x:.0f}" if x < 1e6 else f"{x:.1e}"
    return text.replace("e-0", "e-").replace("e+0", "e")


def curves_worth(of: StepErrors, precision: str, most: int) -> tuple[list[str], list[str]]:
    """Return the steps to draw, at most so many, and others: the cheapest of each error first."""
    steps = list(dict.fromkeys(a.step for a in of.attempts))
    first: dict[str, None] = {}
    for power in range(2, 15):
        found = cheapest(of, precision, 10.0**-power)
        if found is not None:
            first[found.attempt.step] = None
    plain = [s for s in steps if s not in first and not s.endswith("_compensated")]
    order = [*first, *plain, *(s for s in steps if s not in first and s not in plain)]
    return order[:most], order[most:]
