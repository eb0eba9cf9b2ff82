"""What to do for an error: which function to want, with which step, and where that holds."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

from bench.motion.wrong import ROUNDOFF
from bench.report.case_run import PRECISIONS, Found
from bench.report.point import Point
from bench.report.recommend import ALIKE, ERRORS, Overall, choice, cut, overall
from bench.report.record import kinds
from bench.report.written import figure

SPACE, JOINED = "\u00a0", "\u2060"  # where no line ends
ORDER = 20  # of the Taylor step, whose proposals are scaled


@dataclass(frozen=True)
class Act:
    """A row of the advice: for an error, the cheapest stepper as a rule, and one for more cases.

    names : the stepper, then the one for more cases if there is one      how : their steps
    missed : cases in which the first does not keep to the error          of : all cases
    then   : where the second holds and what it costs, in words
    """

    kind: str
    precision: str
    error: str
    names: tuple[str, ...]
    how: tuple[str, ...]
    missed: tuple[str, ...]
    of: int
    then: str


def acts(found: Sequence[Found]) -> list[Act]:
    """Return what to do, by kind of motion, precision and error; rows that say the same are one."""
    rows = [
        _act(choice(overall(kind, cases, precision, error)), kind, precision, cases, error)
        for kind, cases in kinds(found).items()
        for precision in PRECISIONS
        for error in ERRORS[precision]
    ]
    alike = groupby(rows, key=lambda row: replace(row, error=""))
    return [_joined(list(own)) for _, own in alike]


def _joined(rows: Sequence[Act]) -> Act:
    first, last = rows[0].error, rows[-1].error
    return replace(rows[0], error=first if first == last else f"{first} to {last}")


def _act(
    rows: Sequence[Overall],
    kind: str,
    precision: str,
    cases: Mapping[str, Sequence[Point]],
    error: float,
) -> Act:
    if not rows:
        return Act(kind, precision, figure(error), (), (), tuple(cases), len(cases), "")
    cheap, most = rows[:2]
    more = most.reached > cheap.reached
    named = (cheap, most) if more else (cheap,)
    then = f"{_where(most)}{_price(most)}" if more else ""
    return Act(kind, precision, figure(error), tuple(row.method for row in named),
               tuple(_how(row) for row in named), cheap.missed, cheap.asked, then)  # fmt: skip


def _how(row: Overall) -> str:
    """Return how long a step is, in words that can be put into a program."""
    if not math.isnan(row.radians):
        return f"steps of {cut(row.radians)}{SPACE}/{SPACE}|{JOINED}ω{JOINED}|"
    if not math.isnan(row.tolerance):
        part = (row.tolerance / ROUNDOFF[row.precision]) ** (1 / ORDER)
        return f"each step {cut(part)} times what the step before proposes"
    return "one call, for any time"


def _where(row: Overall) -> str:
    return f"{row.reached} of {row.asked} cases" if row.missed else "every case"


def _price(row: Overall) -> str:
    return "" if row.usual < ALIKE else f", at {row.usual:.3g} times the least cost"
