"""Units of a scene: their dimensions, and the dimension of a formula.

Only coherent SI units are read, so that a number never needs a factor; a degree or a millimetre
is refused with the unit to give instead. The radian is dimensionless.
"""

import re
from collections.abc import Mapping
from fractions import Fraction

from derive.scene.escape import brief
from derive.scene.formula import Formula

Dimension = tuple[Fraction, Fraction, Fraction]
"""Powers of metre, kilogram and second."""


class UnitError(ValueError):
    """A unit that is not SI, or a formula whose terms do not agree in dimension."""


def _dimension(metre: int, kilogram: int, second: int) -> Dimension:
    return Fraction(metre), Fraction(kilogram), Fraction(second)


UNITS: Mapping[str, Dimension] = {
    "1": _dimension(0, 0, 0),
    "rad": _dimension(0, 0, 0),
    "m": _dimension(1, 0, 0),
    "kg": _dimension(0, 1, 0),
    "s": _dimension(0, 0, 1),
    "N": _dimension(1, 1, -2),
    "J": _dimension(2, 1, -2),
    "W": _dimension(2, 1, -3),
    "Pa": _dimension(-1, 1, -2),
}
REFUSED: Mapping[str, str] = {
    **dict.fromkeys(("deg", "degree", "degrees", "°"), "rad"),
    **dict.fromkeys(("rpm", "Hz", "rev"), "rad/s"),
    **dict.fromkeys(("mm", "cm", "km", "um", "in", "ft"), "m"),
    **dict.fromkeys(("g", "mg", "t", "lb"), "kg"),
    **dict.fromkeys(("ms", "us", "min", "h"), "s"),
    **dict.fromkeys(("kN", "mN", "lbf"), "N"),
    **dict.fromkeys(("Nm", "kNm", "mNm"), "N m"),
}
BESIDE_SI: Mapping[str, tuple[str, str]] = {
    "min": ("s", "60"),
    "h": ("s", "3600"),
    "d": ("s", "86400"),
    "deg": ("rad", "pi/180"),
    "rpm": ("rad/s", "pi/30"),
}
"""Units that a result may be given in: of which SI unit each is how much."""

NAMED_AFTER: Mapping[str, str] = {
    **dict.fromkeys(("day", "days"), "d"),
    **dict.fromkeys(("hour", "hours"), "h"),
    **dict.fromkeys(("minute", "minutes"), "min"),
    **dict.fromkeys(("deg", "degree", "degrees"), "deg"),
    **dict.fromkeys(("rpm", "Hz", "mm", "cm", "km", "kN", "kNm", "ms"), ""),
    "rpm": "rpm",
}
"""Units that the last word of a name may claim, and how a result spells them, if it can."""

NONE = UNITS["1"]
ANGULAR_VELOCITY = _dimension(0, 0, -1)
ANGULAR_ACCELERATION = _dimension(0, 0, -2)
INERTIA = _dimension(2, 1, 0)
MASS, LENGTH, MOMENT, FORCE = UNITS["kg"], UNITS["m"], UNITS["J"], UNITS["N"]
VELOCITY, ACCELERATION = _dimension(1, 0, -1), _dimension(1, 0, -2)

_FACTOR = re.compile(r"(?P<name>[A-Za-z°]+|1)(?:\^?(?P<power>-?[0-9]))?")
_SEPARATOR = re.compile(r" */ *|[ *·]+")


def dimension(unit: str) -> Dimension:
    """Return the dimension of a unit such as "kg m^2", "N m", "m/s^2" or "1".

    Factors are joined by a space, "*" or "·"; each "/" divides by the one factor after it.
    Raises UnitError for a unit that is unknown or not coherent SI.

    >>> dimension("N m") == dimension("kg m^2/s^2")
    True
    """
    result, place, divide, shown = NONE, 0, False, brief(unit)
    while True:
        match = _FACTOR.match(unit, place)
        if match is None:
            raise UnitError(f"unit '{shown}' cannot be read at {place + 1}")
        power = int(match["power"] or 1) * (-1 if divide else 1)
        result = multiplied(result, raised(_unit(match["name"], shown), Fraction(power)))
        place = match.end()
        if place == len(unit):
            return result
        separator = _SEPARATOR.match(unit, place)
        if separator is None:
            raise UnitError(f"unit '{shown}' cannot be read at {place + 1}")
        if divide and "/" not in separator.group():
            raise UnitError(f"unit '{shown}' is ambiguous: divide by each factor with its own '/'")
        divide, place = "/" in separator.group(), separator.end()


def _unit(name: str, shown: str) -> Dimension:
    if name in REFUSED:
        raise UnitError(f"unit '{shown}' is not coherent SI: give '{REFUSED[name]}', not '{name}'")
    if name not in UNITS:
        known = ", ".join(UNITS)
        raise UnitError(f"unit '{shown}' has an unknown part '{brief(name)}' (known: {known})")
    return UNITS[name]


def multiplied(left: Dimension, right: Dimension) -> Dimension:
    """Return the dimension of a product."""
    return left[0] + right[0], left[1] + right[1], left[2] + right[2]


def raised(base: Dimension, power: Fraction) -> Dimension:
    """Return the dimension of a power."""
    return base[0] * power, base[1] * power, base[2] * power


def unit_ratio(left: Dimension, right: Dimension) -> Dimension:
    """Return the dimension of a unit_ratio."""
    return multiplied(left, raised(right, Fraction(-1)))


def spelled(found: Dimension) -> str:
    """Return a dimension as a unit text, named where a name is usual.

    >>> spelled(dimension("kg m/s^2")), spelled(dimension("kg m^2"))
    ('N', 'kg m^2')
    """
    for name, known in UNITS.items():
        if known == found:
            return "N m" if name == "J" else name
    if found in (ANGULAR_VELOCITY, ANGULAR_ACCELERATION):
        return "rad/s" if found == ANGULAR_VELOCITY else "rad/s^2"
    parts = (("kg", found[1]), ("m", found[0]), ("s", found[2]))
    above = " ".join(_factor(name, power) for name, power in parts if power > 0)
    below = "".join("/" + _factor(name, -power) for name, power in parts if power < 0)
    return (above or "1") + below


def _factor(name: str, power: Fraction) -> str:
    return name if power == 1 else f"{name}^{power}"


def behind(unit: str) -> str:
    """Return what to write behind a number: a space and the unit, nothing for plain numbers.

    >>> behind("N m"), behind("1"), behind("")
    (' N m', '', '')
    """
    return "" if unit in ("", "1") else f" {unit}"


def misnamed(name: str, unit: str) -> str:
    """Return a doubt about a name that ends in a unit which is not its own, "" if there is none.

    >>> misnamed("period_days", "s")
    "'period_days' is called after days, but its unit is s"
    >>> misnamed("period_days", "d"), misnamed("period_s", "s")
    ('', '')
    """
    last = name.rpartition("_")[2]
    if "_" not in name or last not in NAMED_AFTER or unit in (last, NAMED_AFTER[last]):
        return ""
    return f"'{name}' is called after {last}, but its unit is {unit}"


def dimension_of(formula: Formula, dims: Mapping[str, Dimension]) -> Dimension | None:
    """Return the dimension of a formula; None for zero, which agrees with any.

    dims : dimension of each symbol of the formula
    Raises UnitError naming the terms that do not agree.
    """
    match formula.operator:
        case "symbol":
            return dims[formula.name]
        case "number":
            return NONE if formula.number else None
        case "add" | "sub":
            return _agreed(formula, dims)
        case "neg":
            return dimension_of(formula.operands[0], dims)
    parts = [dimension_of(part, dims) or NONE for part in formula.operands]
    match formula.operator:
        case "mul":
            return multiplied(parts[0], parts[1])
        case "div":
            return multiplied(parts[0], raised(parts[1], Fraction(-1)))
        case "power":
            return raised(parts[0], formula.number)
        case "sqrt":
            return raised(parts[0], Fraction(1, 2))
    if parts[0] != NONE:
        rule = f"needs an angle or a plain number, not {spelled(parts[0])}"
        raise UnitError(f"'{brief(formula)}' {rule}")
    return NONE


def _agreed(formula: Formula, dims: Mapping[str, Dimension]) -> Dimension | None:
    left, right = (dimension_of(part, dims) for part in formula.operands)
    if left is None or right is None or left == right:
        return right if left is None else left
    first, second = map(brief, formula.operands)
    raise UnitError(
        f"'{brief(formula)}' joins '{first}' in {spelled(left)} and '{second}' in {spelled(right)}"
    )
