"""What set-up returns: 0, or which rule the parameters break, the same number in every language."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from derive.program.arithmetic import extended, paired, rounded
from derive.program.program import Operand, Program
from derive.program.run import run
from derive.scene.escape import at_place

Kept = Literal["finite", "positive", "not negative", "within"]
Test = tuple[Kept, Operand, tuple[Fraction, ...]]
"""What a value must keep: of a range its ends, too."""
RIGHT, PARAMETER, MASS, LENGTH, INERTIA, CONSTANT, RANGE = range(7)
SAYS = {
    RIGHT: "all is right",
    PARAMETER: "a parameter is not finite",
    MASS: "a mass is not positive",
    LENGTH: "a length of a body is not positive",
    INERTIA: "an inertia is none that a body can have",
    CONSTANT: "a constant is not finite",
    RANGE: "a parameter is outside of its range",
}
"""Each status in words. The first rule that is broken counts, in this order."""
OF_KIND = {"mass": MASS, "length": LENGTH, "inertia": INERTIA}


def possible(program: Program) -> dict[int, str]:
    """Return every status that ``program``, a set-up, can return, with its words."""
    found = {RIGHT, PARAMETER, CONSTANT} if program.inputs else {RIGHT}
    found |= {rule.status for rule in program.rules}
    if computed(program) or any(rule.relation != "within" for rule in program.rules):
        found |= {CONSTANT}
    else:
        found -= {CONSTANT}  # parameters alone, and those are finite
    return {number: SAYS[number] for number in sorted(found)}


def computed(program: Program) -> tuple[Operand, ...]:
    """Return the results that set-up works out: neither numbers nor parameters as they are."""
    given = {c for q in program.inputs for c in q.components}
    own = dict.fromkeys(r for r in program.results if isinstance(r, str) and r not in given)
    return tuple(own)


def tried(program: Program) -> list[tuple[int, list[Test]]]:
    """Return each status but the first with what must be kept for it not to be; what counts first.

    What set-up makes is tried after the rules, and the values that they speak of with it.
    """
    names = [c for q in program.inputs for c in q.components]
    made = dict.fromkeys((*(rule.value for rule in program.rules), *computed(program)))
    found: dict[int, list[Test]] = {PARAMETER: [("finite", c, ()) for c in names]}
    for rule in program.rules:
        found.setdefault(rule.status, []).append((rule.relation, rule.value, rule.ends))
    found[CONSTANT] = [("finite", value, ()) for value in made if value not in names]
    return [(number, kept) for number, kept in sorted(found.items()) if kept]


_BROKEN: Mapping[Kept, Callable[..., NDArray[Any]]] = {
    "finite": lambda x: ~np.isfinite(x),
    "positive": lambda x: x <= 0,
    "not negative": lambda x: x < 0,
    "within": lambda x, low, high: ~((low <= x) & (x <= high)),
}


def statuses(program: Program, given: Sequence[NDArray[Any]], dtype: type) -> NDArray[Any]:
    """Return what set-up says of columns of parameters: its status, row by row, as C gives it.

    given : a column of each component of the program's inputs, in order
    """
    every = tried(program)
    asked = tuple(dict.fromkeys(value for _, kept in every for _, value, _ in kept))
    columns = np.array([np.asarray(column, dtype) for column in given])
    status = np.zeros(columns.shape[1] if len(columns) else 1, int)
    with np.errstate(all="ignore"):
        found = run(replace(program, results=asked), extended(dtype), paired(columns))
        values = {value: pair[0] for value, pair in zip(asked, found, strict=True)}
        for number, kept in reversed(every):
            for relation, value, ends in kept:
                limits = (rounded(end, dtype) for end in ends)
                status = np.where(_BROKEN[relation](values[value], *limits), number, status)
    return status


def refusal(program: Program, given: Sequence[float]) -> str:
    """Return why set-up in double refuses these parameters, a clause; "" if it does not."""
    columns = [np.array([x]) for x in given]
    names = [c for q in program.inputs for c in q.components]
    at = at_place(dict(zip(names, given, strict=True)))
    status = int(statuses(program, columns, np.float64)[0])
    if status == RIGHT:
        return ""
    for rule in program.rules:
        alone = replace(program, rules=(rule,), results=())
        if rule.status == status == statuses(alone, columns, np.float64)[0]:
            return f"{rule.says}, and is not so{at} (status {status})"
    return f"{SAYS[status]}{at} (status {status})"
