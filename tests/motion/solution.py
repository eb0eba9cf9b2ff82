"""Taylor steps to judge, and the terms of their solutions by iterated integrals in flint."""

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from random import Random
from typing import Any

import flint

from derive.motion.taylor import taylor_step
from derive.motion.taylor.series import TaylorStep, in_loops
from derive.program.program import Program, Quantity
from derive.program.run import run, run_lines
from tests.made import library_of
from tests.motion.rates import BODY, body, everything, hanging, no_moment

U = 2.0**-53
FLOATS = {
    "number": float,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "sqrt": math.sqrt,
    "abs": abs,
    "less": operator.lt,
    "select": lambda condition, yes, no: yes if condition else no,
}
BALLS = FLOATS | {
    "number": lambda q: flint.arb(flint.fmpq(q.numerator, q.denominator)),
    "sqrt": flint.arb.sqrt,
    "sin": flint.arb.sin,
    "cos": flint.arb.cos,
}
I123 = (Fraction(1), Fraction(2), Fraction(3))
NONE = (Fraction(0),) * 3
FREE = body(I123, no_moment, NONE)
TOP = body(I123, hanging, NONE)
STATE = [Fraction(n, 16) for n in (12, 7, -5, 6, 9, -7, 20)]


@cache
def catalogued(name: str) -> tuple[TaylorStep, Program, list[Fraction]]:
    """Return a scene's step, its rate, and values for constants, states and inputs."""
    made = library_of(name)
    rate, words = made["state_rate"], made.vocabulary
    step = taylor_step(rate, words.states, words.inputs, 20)
    dice = Random(name)
    count = sum(len(q.components) for q in step.inputs) - 1
    return step, rate, [Fraction(dice.randint(8, 24), 16) for _ in range(count)]


def ball(q: Fraction) -> flint.arb:
    return flint.arb(flint.fmpq(q.numerator, q.denominator))


def picard(
    rate: Program, inputs: Sequence[Quantity], states: Sequence[str], values: Sequence[Fraction]
) -> dict[str, list[flint.arb]]:
    """Return the terms of the solution by iterated integrals, in power series of flint."""
    order = flint.ctx.cap - 1
    series = BALLS | {
        "number": lambda q: flint.arb_series([ball(q)]),
        **{name: getattr(flint.arb_series, name) for name in ("sqrt", "sin", "cos")},
    }
    names = [c for q in inputs for c in q.components]
    start = {n: flint.arb_series([ball(v)]) for n, v in zip(names, values, strict=False)}
    now = dict(start)
    given = [c for q in rate.inputs for c in q.components]
    for _ in range(order):
        rates = run(rate, series, [now[c] for c in given])
        now |= {x: start[x] + f.integral() for x, f in zip(states, rates, strict=True)}
    return {x: [now[x][k] for k in range(order + 1)] for x in states}


def run_series(
    step: TaylorStep, table: Mapping[str, Callable[..., Any]], values: Sequence[Any], bits: int
) -> list[Any]:
    """Return what a step gives in an arithmetic, its length proposed for a precision."""
    return run(in_loops(step), {**table, "unit_roundoff": lambda: 2.0**-bits}, values)


def series_terms(
    step: TaylorStep, table: Mapping[str, Callable[..., Any]], values: Sequence[Any]
) -> dict[str, list[Any]]:
    """Return the terms of the states that move; place k is order k."""
    names = [c for q in step.inputs for c in q.components]
    known = dict(zip(names, values, strict=True))
    run_lines([line for line in in_loops(step).ops if line not in step.close], table, known)
    orders = range(1, step.order + 1)
    return {x: [known[x], *(known[f"{x}_terms[{k}]"] for k in orders)] for x in step.rates}


def state_names(step: TaylorStep) -> list[str]:
    return [c.removesuffix("_next") for q in step.outputs[:-1] for c in q.components]


def faults(step: TaylorStep, rate: Program, values: Sequence[Fraction]) -> list[str]:
    """Return the terms of a step of length 1 that are not the solution's."""
    with flint.ctx.workprec(400):
        flint.ctx.cap = step.order + 1
        true = picard(rate, step.inputs, state_names(step), values)
        found = series_terms(step, BALLS, [*map(ball, values), flint.arb(1)])
        return [
            f"{x}, order {k}"
            for x, terms in found.items()
            if x in step.rates
            for k in range(step.order + 1)
            if not abs(terms[k] - true[x][k]) < flint.arb(2) ** -200 * (1 + abs(true[x][k]))
        ]


def handmade(name: str) -> tuple[TaylorStep, Program, list[Fraction]]:
    """Return the step, the rate and a state of a rate that is written by hand."""
    if name == "everything":
        states, rate = everything()
        return taylor_step(rate, states, (), 20), rate, [Fraction(n, 8) for n in (5, 11, 3)]
    rate = {"free": FREE, "top": TOP}[name]
    return taylor_step(rate, BODY, (), 20), rate, STATE


def one_step(step: TaylorStep, values: Sequence[Fraction], h: Fraction) -> list[flint.arb]:
    with flint.ctx.workprec(1000):
        return run_series(step, BALLS | CHOICES, [*map(ball, values), ball(h)], 53)


CHOICES = {
    "less": lambda a, b: float(a) < float(b),
    "abs": abs,
}


def truncation(
    step: TaylorStep, rate: Program, values: Sequence[Fraction], h: Fraction
) -> dict[str, flint.arb]:
    """Return what a step leaves out of each state: against 24 more terms of the solution."""
    with flint.ctx.workprec(1000):
        flint.ctx.cap = step.order + 25
        true = picard(rate, step.inputs, state_names(step), values)
        end = {x: sum(t * ball(h) ** k for k, t in enumerate(terms)) for x, terms in true.items()}
        found = dict(zip(end, one_step(step, values, h), strict=False))
        return {x: abs(found[x] - end[x]) for x in step.rates}


def largest(errors: Mapping[str, flint.arb]) -> float:
    return max(float(e.abs_upper()) for e in errors.values())
