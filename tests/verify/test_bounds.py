"""Proved bounds hold: at samples followed in many digits, against mutants, as Gappa proves them."""

import json
import shutil
import subprocess
from fractions import Fraction
from itertools import product
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

from derive.library.library import Library
from derive.program.arithmetic import working
from derive.program.precision import F32, PRECISIONS, Precision
from derive.program.program import Op, Program
from derive.scene import catalogue
from derive.verify.draw import with_motion
from derive.verify.kept import stated_bounds
from derive.verify.measure import exact, replayed
from derive.verify.proved import enclosed, meant, ranges, slopes
from derive.verify.proved.bounds import WORK, Proof, UnprovedError, bounds_of, cutting
from derive.verify.proved.ranges import Interval
from derive.verify.proved.seen import Search
from derive.verify.sample import Sample, samples
from derive.verify.scale import measured_outputs
from tests.made import library_of

GENERATED = Path(__file__).parents[2] / "generated"
ALL = slice(0, None)
QUICK = Proof(WORK // 64, Search(2048, 24, 512))
LEAST = Search(16, 1, 16)
BITS = 200
WITHIN = ("ordinary", "extremes", "at rest")
"""The kinds of samples that lie in the ranges."""


def drawn(library: Library, precision: Precision, count: int) -> list[Sample]:
    """Return samples of the ranges of a scene, those of motion too."""
    every = samples(library.mechanism, precision, count, 2).each
    return [s for s in with_motion(library, every, precision) if s.kind in WITHIN]


def furthest(library: Library, precision: Precision, count: int) -> dict[tuple[str, str], float]:
    """Return how far each output is off at samples, from programs followed in many digits."""
    each = drawn(library, precision, count)
    found = replayed(library, each, precision, working(precision.dtype))
    most: dict[tuple[str, str], float] = {}
    for program in library.printed():
        columns = [np.broadcast_to(c, len(each)) for c in found[program.name]]
        for n, sample in enumerate(each):
            true = exact(library, program, sample)
            for q, span in measured_outputs(program):
                with ctx.workprec(BITS):
                    gaps = [
                        abs(float(arb(float(c[n])) - t))
                        for c, t in zip(columns[span], true[span], strict=True)
                    ]
                place = program.name, q.name
                most[place] = max(most.get(place, 0.0), *gaps)
    return most


def stated(name: str) -> list[Any]:
    """Return the bounds that the JSON of a scene states."""
    text = (GENERATED / name / f"{name}.json").read_text(encoding="utf-8")
    return [b for b in stated_bounds(json.loads(text)) if b.proved is not None]


@pytest.mark.long
@pytest.mark.parametrize("name", catalogue())
def test_no_sample_is_further_off_than_is_proved(name: str) -> None:
    library = library_of(name)
    for precision in PRECISIONS:
        most = furthest(library, precision, 12)
        own = [b for b in stated(name) if b.precision == precision.name]
        assert not [b for b in own if most[b.function, b.output] > b.proved]
        assert not [b for b in own if b.seen > b.proved]


@pytest.mark.long
@pytest.mark.parametrize("name", catalogue())
def test_no_stated_bound_is_below_what_is_proved_again(name: str) -> None:
    library, said = library_of(name), stated(name)
    named = {b.function for b in said}
    each = [p for p in library.printed() if p.name in named]
    own = [b for p in each for b in bounds_of(library, p, Proof(search=LEAST))]
    proved = {(b.function, b.precision, b.output): b.proved for b in own if b.proved is not None}
    assert {(b.function, b.precision, b.output): b.proved for b in said} == proved


def test_a_bound_is_close_to_what_is_seen() -> None:
    library = library_of("free_body_principal")
    for program in library.printed():
        for b in bounds_of(library, program, QUICK):
            assert b.proved is not None
            assert b.seen <= b.proved <= 3 * b.seen


def proved_and_seen(name: str, function: str) -> list[tuple[float, float]]:
    """Return bounds and what is seen, in both precisions."""
    library = library_of(name)
    each = list(bounds_of(library, library[function], QUICK))
    return [(b.proved or 0.0, b.seen) for b in each]


def forgets_half(most: Any, bits: int, least: float) -> Any:
    """Be a rounding that is half as large as it may be."""
    return ranges.half_unit(most, bits, least) / 2


def forgets_a_factor(slope: Interval, _: Interval, each: Any) -> list[Interval | None]:
    """Be the slopes of a product that forgets the error of its first operand."""
    return [None, ranges.times(slope, (each[0][0][None, :], each[0][1][None, :]))]


def forgets_constants(of: Any, index: int, step: Any) -> Any:
    """Be what encloses values, but for the rounding of constants."""
    *whole, own = WHOLE(of, index, step)
    return *whole, None if step.origin == "rounded" else own


WHOLE = enclosed._made


@pytest.mark.parametrize(
    ("place", "mutant", "scene", "function"),
    [
        ((enclosed, "half_unit"), forgets_half, "heavy_top", "angular_momentum"),
        ((enclosed, "_made"), forgets_constants, "edge_runner_flat", "hinge_radial"),
        ((slopes, "SLOPES"), {**slopes.SLOPES, "mul": forgets_a_factor}, "edge_runner_flat", "N"),
    ],
)
def test_a_mutant_of_the_proof_is_seen_through(
    monkeypatch: Any, place: tuple[Any, str], mutant: Any, scene: str, function: str
) -> None:
    assert all(seen <= proved for proved, seen in proved_and_seen(scene, function))
    monkeypatch.setattr(*place, mutant)
    assert any(seen > proved for proved, seen in proved_and_seen(scene, function))


def a_range(dice: Random) -> tuple[Interval, list[Fraction]]:
    """Return a range and numbers in it, its ends among them."""
    ends = sorted(dice.uniform(-3, 3) * 2.0 ** dice.randrange(-8, 8) for _ in range(2))
    low, high = map(Fraction, ends)
    inside = [low, high, low + (high - low) * Fraction(dice.random())]
    return (np.array(ends[:1]), np.array(ends[1:])), inside


EXACTLY = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
}


def escapes(operator: str) -> int:
    """Count the numbers that an operation takes out of its range."""
    dice, found = Random(operator), 0
    for _ in range(400):
        (a, first), (b, second) = a_range(dice), a_range(dice)
        with np.errstate(all="ignore"):
            low, high = meant.MEANT[operator](a, b)
        for x, y in product(first, second):
            if (operator != "div" or y) and np.isfinite(low[0]) and np.isfinite(high[0]):
                found += not Fraction(low[0]) <= EXACTLY[operator](x, y) <= Fraction(high[0])
    return found


@pytest.mark.parametrize("operator", EXACTLY)
def test_ranges_hold_what_is_in_them_and_rounded_inwards_they_do_not(
    monkeypatch: Any, operator: str
) -> None:
    assert escapes(operator) == 0
    monkeypatch.setattr(ranges, "SLACK", 0.0)
    monkeypatch.setattr(ranges, "LEAST", 0.0)
    assert escapes(operator) > 0


@pytest.mark.parametrize("which", [0, 1])
def test_ranges_of_sines_and_roots_hold_what_is_in_them(which: int) -> None:
    dice = Random(which)
    for _ in range(400):
        middle, width = dice.uniform(-20, 20), dice.uniform(0, 8) ** 2 / 8
        ends = np.array([middle - width]), np.array([middle + width])
        low, high = ranges.wave(ends, which)
        positive = np.abs(ends[0]), np.abs(ends[0]) + width
        least, most = ranges.root_of(positive)
        with ctx.workprec(BITS):
            for part in (0.0, 1.0, dice.random()):
                x, y = (
                    arb(a[0]) + arb(part) * (arb(b[0]) - arb(a[0])) for a, b in (ends, positive)
                )
                value = x.cos() if which else x.sin()
                assert bool(value >= low[0])
                assert bool(value <= high[0])
                assert bool(y.sqrt() >= least[0])
                assert bool(y.sqrt() <= most[0])


def test_what_cannot_be_proved_says_why() -> None:
    library = library_of("attitude")
    (first, *_) = bounds_of(library, library["quaternion_log"], QUICK)
    assert first.proved is None
    assert first.why
    with pytest.raises(UnprovedError, match="its plan"):
        cutting(library_of("tumbling_disc"), library_of("tumbling_disc")["step_dmv"], ALL, F32, 1)


def in_gappa(library: Library, program: Program, bound: float) -> str:
    """Return a straight function of exact constants for Gappa: all results within a bound."""
    made = dict(zip(library.constants, library.setup.results, strict=True))
    ends = {
        c: q.ends for q in (*library.setup.inputs, *program.inputs) for c in q.components
        if q.role != "constants"
    }  # fmt: skip
    read = {o for op in program.ops if isinstance(op, Op) for o in op.operands}
    given = sorted(o for o in read if isinstance(o, str) and (o in ends or o in made))
    lines = ["@r = float<ieee_32,ne>;", *(f"{c} = r({c}_given);" for c in given)]
    signs = {"add": "+", "sub": "-", "mul": "*", "div": "/"}
    for op in program.ops:
        assert isinstance(op, Op)
        first, second = op.operands
        lines.append(f"f_{op.result} r= {named(first, given, 'f_')} {signs[op.operator]} "
                     f"{named(second, given, 'f_')};")  # fmt: skip
        lines.append(f"e_{op.result} = {named(first, given, 'e_')} {signs[op.operator]} "
                     f"{named(second, given, 'e_')};")  # fmt: skip
    of = {c: ends[str(made.get(c, c))] for c in given}
    within = [f"{c} in [{decimal(low)}, {decimal(high)}]" for c, (low, high) in of.items()]
    wanted = [f"|f_{r} - e_{r}| <= {bound!r}" for r in program.results]
    both = " /\\ "
    return "\n".join([*lines, f"{{ {both.join(within)} -> {both.join(wanted)} }}", ""])


def named(operand: str | Fraction, given: list[str], prefix: str) -> str:
    """Return an operand as Gappa has it."""
    if isinstance(operand, Fraction):
        return decimal(operand)
    return operand if operand in given else f"{prefix}{operand}"


def decimal(q: Fraction) -> str:
    """Return a short decimal number as Gappa reads it."""
    assert Fraction(str(float(q))) == q
    return str(float(q))


@pytest.mark.skipif(shutil.which("gappa") is None, reason="gappa is not installed")
@pytest.mark.parametrize(
    ("name", "function"),
    [
        ("free_body_principal", "angular_momentum"),
        pytest.param("free_body", "angular_momentum", marks=pytest.mark.long),
    ],
)
def test_gappa_proves_the_same_bound_and_no_half_of_it(name: str, function: str) -> None:
    library = library_of(name)
    (bound,) = [b for b in bounds_of(library, library[function], QUICK) if b.precision == F32.name]
    assert bound.proved is not None
    for share, code in ((1.0, 0), (0.5, 1)):
        text = in_gappa(library, library[function], bound.proved * share)
        run = subprocess.run(["gappa"], input=text, capture_output=True, text=True, check=False)
        assert bool(run.returncode) == bool(code), run.stderr
