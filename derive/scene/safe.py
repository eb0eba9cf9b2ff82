"""Whether every formula of a scene has a value on the declared ranges, or where it has none.

Divisors must not vanish, square roots must be of what is not negative. Middle, corners and points
between are tried first; then intervals prove what is left, or close in on a place that breaks the
rule. A part with a symbol of no range (an unknown, the attitude) is only refused if it is zero
whatever its symbols are.
"""

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import reduce
from operator import add, mul
from random import Random
from typing import Any

from mpmath import iv, mpf

from derive.scene.declaration import SceneError
from derive.scene.escape import at_place, brief
from derive.scene.formula import Formula, apply, evaluate, in_floats, symbols
from derive.scene.functions import INTERVALS
from derive.scene.numbers import Ranges, Valuation, middle, valuations

BETWEEN, BOXES = 64, 2000
"""Points tried between; boxes that a proof may take."""
ROUNDING = 1e-12
"""What is smaller beside its own terms is zero: a dozen roundings of 2^-53 are 1.3e-15."""
SMALLEST_BOX = 2.0**-36
"""Part of a range in which a zero that no sign shows is taken to lie."""
_WORDS = {
    "Member": "body", "Force": "load", "Weight": "load", "Spring": "load", "Gradient": "load",
    "Moving": "coordinate", "Scene": "", "Named": "formula",
}  # fmt: skip
"""What those are called whose class has another name; of a whole, its fields are."""


def require_values(scene: object) -> None:
    """Refuse a scene with a formula that has no value somewhere on the declared ranges."""
    ranges = ranges_of(scene)
    seen: set[tuple[str, Formula]] = set()
    for label, formula in formulas_of(scene):
        for kind, part in _dangers(formula):
            if (kind, part) not in seen:
                seen.add((kind, part))
                _require(label, kind, part, ranges)


def ranges_of(scene: object) -> Ranges:
    """Return the range of everything in a scene that has one, by its name; pi is a point."""
    return {"pi": (math.pi, math.pi), **dict(_ranges(scene))}


def negative_somewhere(part: Formula, ranges: Ranges) -> Valuation | None:
    """Return a place on the ranges where a formula is negative, None if none was found."""
    used = symbols(part)
    if any(name not in ranges for name in used):
        return None
    return _place("radicand", part, {name: ranges[name] for name in used})


def values_within(formula: Formula, ranges: Ranges) -> list[float]:
    """Return a formula's values at the middle, the corners and between; none without ranges."""
    used = symbols(formula)
    if any(name not in ranges for name in used):
        return []
    box = {name: ranges[name] for name in used}
    return [_sized(formula, values)[0] for values in _valuations(box)]


def _ranges(value: object) -> Iterator[tuple[str, tuple[float, float]]]:
    """Yield the range of everything in a scene that has one."""
    for inner in _parts(value):
        low, high = getattr(inner, "low", None), getattr(inner, "high", None)
        if low is not None and high is not None and hasattr(inner, "name"):
            yield inner.name, (float(low), float(high))
        yield from _ranges(inner)


def _parts(value: object) -> Iterator[Any]:
    if is_dataclass(value) and not isinstance(value, Formula):
        yield from (getattr(value, f.name) for f in fields(value))
    elif isinstance(value, tuple):
        yield from value
    elif isinstance(value, dict):
        yield from value.values()


def formulas_of(value: object, label: str = "") -> Iterator[tuple[str, Formula]]:
    """Yield every formula of a scene with what it belongs to."""
    if isinstance(value, Formula):
        yield label, value
    elif is_dataclass(value):
        kind, name = type(value).__name__, getattr(value, "name", "")
        word = _WORDS.get(kind, kind.lower()) if name else ""
        own = f"{word} '{name}'" if word else label
        for f in fields(value):
            yield from formulas_of(getattr(value, f.name), own or f.name)
    elif isinstance(value, tuple):
        for inner in value:
            yield from formulas_of(inner, label)
    elif isinstance(value, dict):
        for key, inner in value.items():
            apart = key if key.startswith(label) else f"{label}.{key}"
            yield from formulas_of(inner, label if "'" in label else apart)


def _dangers(formula: Formula) -> Iterator[tuple[str, Formula]]:
    """Yield the divisors and the radicands in a formula, inner ones first."""
    for part in formula.operands:
        yield from _dangers(part)
    if formula.operator == "div":
        yield "divisor", formula.operands[1]
    elif formula.operator == "power" and formula.number < 0:
        yield "divisor", formula.operands[0]
    elif formula.operator == "tan":
        yield "divisor of a tangent", apply("cos", formula.operands[0])
    elif formula.operator == "sqrt":
        yield "radicand", formula.operands[0]


def _require(label: str, kind: str, part: Formula, ranges: Ranges) -> None:
    used = symbols(part)
    if any(name not in ranges for name in used):
        if kind != "radicand" and _nothing(part):
            raise SceneError(f"{label}: the {kind} '{brief(part)}' is 0 whatever its symbols are")
        return
    box = {name: ranges[name] for name in used}
    if kind == "radicand" and _nowhere(part, box):
        rule = "is that of 0, but for rounding; write 0 instead"
        raise SceneError(f"{label}: the square root of '{brief(part)}' {rule}")
    place = _place(kind, part, box)
    if place is None:
        return
    where = at_place(place)
    if kind == "radicand":
        found = _sized(part, place)[0]
        raise SceneError(
            f"{label}: the square root of '{brief(part)}' needs what is not negative, but it is "
            f"{found:.6g}{where}"
        )
    raise SceneError(f"{label}: the {kind} '{brief(part)}' must not vanish, but does{where}")


def _nothing(part: Formula) -> bool:
    """Tell whether a formula is zero at points drawn at random, beside its own terms."""
    random = Random(0)  # noqa: S311 (points to try, no secret)
    every = [{n: random.uniform(0.5, 2) for n in symbols(part)} for _ in range(5)]
    sized = [_sized(part, values) for values in every]
    return all(math.isfinite(size) and abs(x) <= ROUNDING * size for x, size in sized)


def _nowhere(part: Formula, box: Ranges) -> bool:
    """Tell whether the terms of a formula cancel wherever it is declared."""
    sized = (_sized(part, values) for values in _valuations(box))
    return all(0 < size < math.inf and abs(x) <= ROUNDING * size for x, size in sized)


def _sized(part: Formula, values: Valuation) -> tuple[Any, Any]:
    """Return a formula's value and the size of its terms, nan where it has none."""
    return in_floats(part, values), _size(part, values)


def _size(part: Formula, values: Valuation) -> Any:
    """Return the size of a formula's terms; that of a sine is its angle's, but 1 at most."""
    if part.operator in ("add", "sub", "mul", "neg"):
        sizes = (mpf(_size(p, values)) for p in part.operands)  # a product may be beyond floats
        return reduce(mul if part.operator == "mul" else add, sizes)
    if part.operator in ("sin", "tan"):
        return max(abs(in_floats(part, values)), min(1.0, abs(in_floats(part.operands[0], values))))
    return 1.0 if part.operator == "cos" else abs(in_floats(part, values))


def _valuations(box: Ranges) -> Iterator[Valuation]:
    """Yield the middle, corners, and points between."""
    yield from valuations(box)
    random = Random(1)  # noqa: S311 (points to try, no secret)
    for _ in range(BETWEEN):
        yield {n: random.uniform(*ends) for n, ends in box.items()}


def _place(kind: str, part: Formula, box: Ranges) -> Valuation | None:
    """Return a place where a radicand is negative or a divisor vanishes, None if none is found."""
    signs: dict[bool, Valuation] = {}
    for values in _valuations(box):
        found, size = _sized(part, values)
        if found < -ROUNDING * size if kind == "radicand" else abs(found) <= ROUNDING * size:
            return values
        if not math.isnan(found):
            signs.setdefault(found > 0, values)
    if kind != "radicand" and len(signs) == 2:
        return _between(part, signs[False], signs[True])
    return _searched(kind, part, box)


def _between(part: Formula, below: Valuation, above: Valuation) -> Valuation:
    """Return where a formula changes its sign on the way from one point to another."""
    for _ in range(60):
        half = {n: (below[n] + above[n]) / 2 for n in below}
        if _sized(part, half)[0] > 0:
            above = half
        else:
            below = half
    return below


def _searched(kind: str, part: Formula, box: Ranges) -> Valuation | None:
    """Return a place that breaks the rule, found by halving the boxes that are not proved safe.

    A radicand is negative at the middle of a box; that a divisor is 0 a smallest box tells.
    """
    waiting = [box]
    for _ in range(BOXES):
        if not waiting:
            return None
        now = waiting.pop()
        bounds = evaluate(part, {n: iv.mpf(ends) for n, ends in now.items()}, INTERVALS)
        if bounds.a >= 0 if kind == "radicand" else 0 not in bounds:
            continue
        here = middle(now)
        found, size = _sized(part, here)
        if kind == "radicand" and found < -ROUNDING * size:
            return here
        parts = {n: _part(now[n], box[n]) for n in now}
        widest = max(parts, key=parts.__getitem__, default="")
        if widest and parts[widest] >= SMALLEST_BOX:
            (low, high), cut = now[widest], here[widest]
            halves = [{**now, widest: (low, cut)}, {**now, widest: (cut, high)}]
            waiting += sorted(halves, key=lambda half: _least(part, half), reverse=True)
        elif kind != "radicand":
            return here
    return None


def _least(part: Formula, box: Ranges) -> float:
    """Return how far from zero a formula is at the middle of a box: where to look first."""
    found, _ = _sized(part, middle(box))
    return math.inf if math.isnan(found) else abs(found)


def _part(inner: tuple[float, float], outer: tuple[float, float]) -> float:
    wide = outer[1] - outer[0]
    return (inner[1] - inner[0]) / wide if wide else 0.0
