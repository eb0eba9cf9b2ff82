"""One RK4 step of a principal body and its quaternion, with its 7x7 Jacobian, by several tools.

Every tool is given the step in its own ordinary way and asked for the derivatives by the state; the
moment is a parameter, the length of the step an input. Ours normalises the quaternion and has the
derivatives of that; the others do not.
"""

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from math import sqrt
from pathlib import Path
from typing import Any

from bench import own
from bench.build import O2, O3_NATIVE, BuildError, Row, answers, build
from bench.callgrind import instructions
from bench.candidate import SAMPLES, Argument, Candidate, Source, pointer_glue
from bench.contest import operations
from bench.flops import Flops
from bench.motion.ours import Emission
from bench.peers import casadi, symforce
from bench.problem import ATTITUDE, OMEGA, TENSOR, Problem
from derive.program.added import added
from derive.program.largest import largest

SCENE, FUNCTION = "moment", "step_rk4_jacobian"
SYMPY = "SymPy cse"
STATE = ATTITUDE + OMEGA
AFTER = tuple(f"{name}_next" for name in STATE)
PATTERN = tuple(
    (f"{row}_next", column)
    for column in STATE
    for row in (ATTITUDE if column in ATTITUDE else STATE)
)
PROBLEM = Problem(
    "step_rk4_jacobian",
    "RK4 step of a principal body with its 7x7 Jacobian",
    SCENE,
    FUNCTION,
    (*TENSOR[:3], "M_x", "M_y", "M_z"),
    (*STATE, "time_step"),
    AFTER,
    (),
    PATTERN,
)


@dataclass(frozen=True)
class Entry:
    """What one tool's step and Jacobian cost; ``missing`` says why something was not run.

    apart : largest difference from the first author's new state
    """

    author: str
    flops: Flops | None
    instructions: dict[str, float]
    apart: float
    missing: str = ""


def entries(made: Emission | None, folder: Path) -> Iterator[Entry]:
    """Yield the entry of every tool, ours first."""
    authors: dict[str, Callable[[], Candidate]] = {
        own.AUTHOR: partial(_own, made, folder / "generated"),
        symforce.AUTHOR: partial(symforce.candidate, PROBLEM, _symforce),
        casadi.AUTHOR: partial(casadi.candidate, PROBLEM, _casadi),
        SYMPY: _sympy,
    }
    first: list[Row] = []
    for name, answer in authors.items():
        try:
            candidate = answer()
            flops = operations(candidate)
            programs = {c.name: build(candidate, c, folder / name / c.name)
                        for c in (O2, O3_NATIVE)}  # fmt: skip
            found = answers(programs[O2.name], _rows(), PROBLEM.width)
            first = first or found
            cost = {c: round(instructions(p, _rows()), 1) for c, p in programs.items()}
        except (ImportError, LookupError, FileNotFoundError, BuildError) as reason:
            yield Entry(name, None, {}, 0.0, f"not run: {reason}")
            continue
        yield Entry(name, flops, cost, _apart(found, first))


def _apart(found: Sequence[Row], first: Sequence[Row]) -> float:
    states = ((x[: len(AFTER)], y[: len(AFTER)]) for x, y in zip(found, first, strict=True))
    return largest(abs(a - b) for x, y in states for a, b in zip(x, y, strict=True))


def _rows() -> list[Row]:
    dice = random.Random("step")
    return [_row(dice) for _ in range(SAMPLES)]


def _row(dice: random.Random) -> Row:
    a, b, c = (dice.uniform(0.5, 2) for _ in range(3))
    q = [dice.gauss(0, 1) for _ in range(4)]
    size = sqrt(added(x * x for x in q))
    others = [dice.uniform(-1, 1) for _ in range(6)]
    return (b + c, c + a, a + b, *others[:3], *(x / size for x in q), *others[3:], 0.01)


def _own(made: Emission | None, folder: Path) -> Candidate:
    if made is None:
        raise LookupError(f"scene '{SCENE}' was not emitted")
    place = folder / SCENE
    place.mkdir(parents=True, exist_ok=True)
    for name in made.manifest["files"]["f64"].values():
        (place / name).write_text(made.texts[name], encoding="utf-8")
    (place / f"{SCENE}.json").write_text(made.json, encoding="utf-8")
    return own.candidate(folder, PROBLEM)


def _stepped(p: Sequence[Any], x: Sequence[Any]) -> list[Any]:
    """Return the state after a step of the classic RK4, over the numbers of any tool."""
    start, h = list(x[:7]), x[7]
    k1 = _rate(p, start)
    k2 = _rate(p, [s + h / 2 * k for s, k in zip(start, k1, strict=True)])
    k3 = _rate(p, [s + h / 2 * k for s, k in zip(start, k2, strict=True)])
    k4 = _rate(p, [s + h * k for s, k in zip(start, k3, strict=True)])
    every = zip(start, k1, k2, k3, k4, strict=True)
    return [s + h / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in every]


def _rate(p: Sequence[Any], y: Sequence[Any]) -> list[Any]:
    q, w = y[:4], y[4:]
    return [
        -(q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) / 2,
        (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2,
        (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2,
        (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2,
        ((p[1] - p[2]) * w[1] * w[2] + p[3]) / p[0],
        ((p[2] - p[0]) * w[2] * w[0] + p[4]) / p[1],
        ((p[0] - p[1]) * w[0] * w[1] + p[5]) / p[2],
    ]


def _symforce(_: Any, p: list[Any], x: list[Any]) -> list[Any]:
    return _stepped(p, x)


def _casadi(p: list[Any], x: list[Any]) -> list[Any]:
    return _stepped(p, x)


def _sympy() -> Candidate:
    """Return plain SymPy's answer: Jacobian, cse with its defaults, and its C99 printer."""
    from sympy import Matrix, ccode, cse, symbols

    p, x = symbols(f"p:{len(PROBLEM.parameters)}"), symbols(f"x:{len(PROBLEM.inputs)}")
    after = Matrix(_stepped(p, x))
    slopes = after.jacobian(Matrix(x[:7]))
    places = [(AFTER.index(row), STATE.index(column)) for row, column in PATTERN]
    shared, results = cse([*after, *(slopes[place] for place in places)])
    lines = [f"const double p{n} = p_[{n}];" for n in range(len(p))]
    lines += [f"const double x{n}_ = x_[{n}];" for n in range(len(x))]
    names = {symbol: f"x{n}_" for n, symbol in enumerate(x)}
    text = _printed(shared, results, names, ccode)
    declared = "void evaluate(const double *p_, const double *x_, double *y)"
    body = "\n    ".join([*lines, *text])
    source = f"#include <math.h>\n{declared}\n{{\n    {body}\n}}\n"
    takes = [Argument("parameters", 0), Argument("inputs", 0), Argument("outputs", 0)]
    glue = pointer_glue(PROBLEM, f"{declared};\n", "evaluate", takes)
    return Candidate(
        SYMPY, PROBLEM, (Source("evaluate.c", source),), glue, ("evaluate.c", ("evaluate",))
    )


def _printed(shared: Any, results: Any, names: dict[Any, str], ccode: Any) -> list[str]:
    from sympy import Symbol

    renamed = {old: Symbol(new) for old, new in names.items()}
    renamed |= {symbol: Symbol(f"t{n}") for n, (symbol, _) in enumerate(shared)}
    lines = [
        f"const double t{n} = {ccode(value.xreplace(renamed))};"
        for n, (_, value) in enumerate(shared)
    ]
    return lines + [f"y[{n}] = {ccode(r.xreplace(renamed))};" for n, r in enumerate(results)]
