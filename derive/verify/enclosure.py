"""Parts of the ranges of a function in which nothing can divide by zero: balls say so.

A part has ranges of parameters and inputs, and what set-up makes of the parameters. It is halved
where that narrows the most what divides and may vanish, until nothing does. Set-up's own divisions
are among them. What it surely refuses is left out.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from flint import arb

from derive.program.program import Program, component_names
from derive.program.run import run
from derive.program.status import Test, tried
from derive.scene.formula import Arithmetic
from derive.verify.operators import IN_BALLS

PARTS = 128
"""Into so many parts the ranges are cut, at most."""
Ranged = Mapping[str, tuple[Fraction, Fraction]]
Truth = bool | None
"""None where a part has numbers of which it holds and others of which it does not."""


@dataclass(frozen=True)
class Sector:
    """Ranged of a function's inputs by component; of constants, between which they lie."""

    inputs: Ranged
    constants: Mapping[str, arb]


def _less(a: Any, b: Any) -> Truth:
    return True if a < b else False if a >= b else None


def _at_most(a: Any, b: Any) -> Truth:
    return True if a <= b else False if a > b else None


def _both(a: Truth, b: Truth) -> Truth:
    return False if False in (a, b) else None if None in (a, b) else True


def _either(a: Truth, b: Truth) -> Truth:
    return True if True in (a, b) else None if None in (a, b) else False


def _select(condition: Truth, yes: Any, no: Any) -> Any:
    return yes.union(no) if condition is None else (no, yes)[condition]


def _watching(doubts: list[float]) -> Arithmetic:
    """Return balls that are ranges, which note how wide is what may vanish and divides.

    So is what may be negative and has its root taken. What comes of either is of no use.
    """

    def divided(a: Any, b: Any) -> Any:
        if not b.contains(0):
            return a / b
        doubts.append(float(b.rad()))
        return a

    def root(a: Any) -> Any:
        if a >= 0:
            return a.sqrt()
        doubts.append(float(a.rad()))
        return a

    truths = {"less": _less, "at_most": _at_most, "both": _both, "either": _either}
    return {**IN_BALLS, **truths, "select": _select, "div": divided, "sqrt": root}


def sectors(setup: Program, function: Program, cases: Sequence[Ranged]) -> list[Sector] | None:
    """Return parts that together hold all of ``cases``, in which nothing divides by zero.

    cases : ranges of parameters and of the function's other inputs, by component
    None where more than ``PARTS`` would be needed.
    """
    ahead, found = [*cases], list[Sector]()
    while ahead:
        if len(ahead) + len(found) > max(PARTS, 2 * len(cases)):
            return None
        box = ahead.pop()
        part, doubt = _looked_at(setup, function, box)
        if part is None:
            continue
        if not doubt:
            found.append(part)
            continue
        ahead += min(
            ([*_halves(box, name)] for name in box),
            key=lambda halves: max(_looked_at(setup, function, half)[1] for half in halves),
        )
    return found


def _looked_at(setup: Program, function: Program, box: Ranged) -> tuple[Sector | None, float]:
    """Return a part, None if set-up refuses it, and how wide what may vanish there is."""
    doubts: list[float] = []
    by = _watching(doubts)
    known = {n: by["number"](low).union(by["number"](high)) for n, (low, high) in box.items()}
    tests = [test for _, kept in tried(setup) for test in kept]
    asked = replace(setup, results=(*setup.results, *(value for _, value, _ in tests)))
    given = [known[c] for q in setup.inputs for c in q.components]
    values = run(asked, by, given)
    made = len(setup.results)
    if any(_is_refused(*pair) for pair in zip(tests, values[made:], strict=True)):
        return None, 0.0
    constants = dict(zip(component_names(setup), values[:made], strict=True))
    every = known | constants
    run(function, by, [every[c] for q in function.inputs for c in q.components])
    parameters = {c for q in setup.inputs for c in q.components}
    inputs = {n: ends for n, ends in box.items() if n not in parameters}
    return Sector(inputs, constants), max(doubts, default=0.0)


def _is_refused(test: Test, value: Any) -> bool:
    """Tell whether no number of a ball keeps what set-up asks for."""
    kept, _, ends = test
    if kept == "positive":
        return bool(value <= 0)
    if kept == "not negative":
        return bool(value < 0)
    number: Callable[[Fraction], arb] = IN_BALLS["number"]
    return kept == "within" and bool(value < number(ends[0]) or value > number(ends[1]))


def _halves(box: Ranged, name: str) -> Iterator[Ranged]:
    low, high = box[name]
    middle = (low + high) / 2
    yield {**box, name: (low, middle)}
    yield {**box, name: (middle, high)}
