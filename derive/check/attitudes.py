"""Formulas for attitudes beside what their names mean: turns about an axis, by Rodrigues' formula.

No quaternion is multiplied here and no matrix is made of one: a quaternion says an axis and an
angle, vectors are turned about it, and the three unit vectors so turned must be the same.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import atan, atan2, cos, hypot, inf, pi, sin, sqrt
from random import Random

from derive.check.emitted import Emitted, verdict
from derive.check.verdict import JUDGED, Verdict
from derive.program.added import added
from derive.program.largest import largest
from derive.scene.wanted import ATTITUDES

Row = Sequence[float]
Values = Mapping[str, Row]
Turns = list[list[float]]  # the three unit vectors, turned

COUNT = 200
ALLOWED = 32.0
"""In u: a formula promises 8 u at most, and a turn of rounded numbers is not far from that."""
ROUNDED = 1e-6
UNIT: Turns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


def definitions(emitted: Emitted) -> Iterator[Verdict]:
    """Yield whether every formula for attitudes gives what its name means."""
    dice = Random("attitudes")  # noqa: S311 - samples, no secret
    for program in emitted.library.printed():
        if program.name not in ATTITUDES:
            continue
        function = emitted.functions[program.name]
        gaps = []
        for _ in range(COUNT):
            given = {q.name: _held(emitted, _drawn(dice, q.name)) for q in program.inputs}
            (found,) = function(given).values()
            gaps.append(largest(_gaps(program.name, list(given.values()), found)))
        worst = largest(gaps) / emitted.precision.unit_roundoff
        says = f"{COUNT} samples, largest gap {worst:.2g} u"
        yield verdict(emitted, program.name, "definition", JUDGED[worst <= ALLOWED], says)


def _held(emitted: Emitted, values: Row) -> list[float]:
    return [float(emitted.precision.dtype(x)) for x in values]


def _drawn(dice: Random, name: str) -> Row:
    """Return a sample of an input: quaternions of length 1, matrices that turn."""
    four = [dice.gauss(0, 1) for _ in range(4)]
    unit = [x / _size(four) for x in four]
    match name:
        case "matrix":
            return _flat(_turned(unit))
        case "quaternion":
            return four
        case "attitude" | "left" | "right":
            return unit
        case _:
            return [dice.uniform(-3, 3) for _ in range(3)]


def _gaps(name: str, given: Sequence[Row], found: Row) -> Iterator[float]:
    """Yield how far what is found is from what it means: a few distances."""
    way, _, sequence = name.removeprefix("quaternion_").partition("_euler_")
    if way == "to" and sequence:
        yield from _apart(_in_turn(sequence, found), _turned(given[0]))
    elif way == "from" and sequence:
        yield from _apart(_turned(found), _in_turn(sequence, given[0]))
    else:
        yield from MEANT[way](given, found)


def _product(given: Sequence[Row], found: Row) -> Iterator[float]:
    left, right = given
    yield from _apart(_turned(found), [_turn(left, v) for v in _turned(right)])
    yield abs(_cosine(left, right) - found[0])  # which of the two quaternions of a turn


def _normalise(given: Sequence[Row], found: Row) -> Iterator[float]:
    size = _size(given[0])
    yield from _apart([[x * size for x in found]], given)


def _exp(given: Sequence[Row], found: Row) -> Iterator[float]:
    angle = _size(given[0])
    yield from _apart(_turned(found), _about(given[0], angle))
    yield abs(found[0] - cos(angle / 2))


def _log(given: Sequence[Row], found: Row) -> Iterator[float]:
    yield from _apart(_about(found, _size(found)), _turned(given[0]))
    yield _none_above(_size(found), pi)


def _rotate(given: Sequence[Row], found: Row) -> Iterator[float]:
    yield from _apart([found], [_turn(*given)])


def _rotate_back(given: Sequence[Row], found: Row) -> Iterator[float]:
    yield from _apart([_turn(given[0], found)], [given[1]])


def _to_matrix(given: Sequence[Row], found: Row) -> Iterator[float]:
    yield from _apart([found], [_flat(_turned(given[0]))])


def _from_matrix(given: Sequence[Row], found: Row) -> Iterator[float]:
    yield from _apart([_flat(_turned(found))], given)
    yield _none_above(-found[0], 0.0)


def _to_mrp(given: Sequence[Row], found: Row) -> Iterator[float]:
    yield from _apart(_about(found, 4 * atan(_size(found))), _turned(given[0]))
    yield _none_above(_size(found), 1.0)


def _from_mrp(given: Sequence[Row], found: Row) -> Iterator[float]:
    yield from _apart(_turned(found), _about(given[0], 4 * atan(_size(given[0]))))


MEANT: Mapping[str, Callable[[Sequence[Row], Row], Iterator[float]]] = {
    "product": _product,
    "normalise": _normalise,
    "exp": _exp,
    "log": _log,
    "rotate": _rotate,
    "rotate_back": _rotate_back,
    "to_matrix": _to_matrix,
    "from_matrix": _from_matrix,
    "to_mrp": _to_mrp,
    "from_mrp": _from_mrp,
}


def _none_above(x: float, limit: float) -> float:
    """Return 0 if a number keeps to its limit, but for rounding in float, else infinity."""
    return 0.0 if x <= limit + ROUNDED else inf


def _apart(found: Sequence[Row], should: Sequence[Row]) -> Iterator[float]:
    """Yield the distance of every vector from what it should be, beside that one's length."""
    for a, b in zip(found, should, strict=True):
        yield _size([x - y for x, y in zip(a, b, strict=True)]) / max(_size(b), 1.0)


def _size(v: Row) -> float:
    return hypot(*v)


def _flat(turns: Turns) -> list[float]:
    return [x for v in turns for x in v]


def _cosine(left: Row, right: Row) -> float:
    """Return the cosine of half the angle of two turns in a row, by spherical trigonometry."""
    (w1, *a), (w2, *b) = left, right
    sizes = _size(a) * _size(b)
    between = added(x * y for x, y in zip(a, b, strict=True)) / (sizes or 1.0)
    alpha, beta = (atan2(_size(v), w) for v, w in ((a, w1), (b, w2)))
    return cos(alpha) * cos(beta) - sin(alpha) * sin(beta) * between


def _turn(q: Row, v: Row) -> list[float]:
    """Return a vector turned by a quaternion, which says an axis and half an angle."""
    w, *axis = q
    return _rodrigues(axis, 2 * atan2(_size(axis), w), v)


def _turned(q: Row) -> Turns:
    return [_turn(q, v) for v in UNIT]


def _about(axis: Row, angle: float) -> Turns:
    return [_rodrigues(axis, angle, v) for v in UNIT]


def _in_turn(sequence: str, angles: Row) -> Turns:
    """Return the unit vectors after turns about axes that the turns before have moved.

    The same as turns about the axes at rest in the other order: the last angle comes first.
    """
    turns = UNIT
    for axis, angle in reversed(list(zip(sequence, angles, strict=True))):
        turns = [_rodrigues(UNIT["xyz".index(axis)], angle, v) for v in turns]
    return turns


def _rodrigues(axis: Row, angle: float, v: Row) -> list[float]:
    """Return v turned about an axis: e (e v) + (v - e (e v)) cos + (e x v) sin."""
    size = sqrt(added(x * x for x in axis)) or 1.0
    e = [x / size for x in axis]
    along = added(x * y for x, y in zip(e, v, strict=True))
    across = [e[k - 2] * v[k - 1] - e[k - 1] * v[k - 2] for k in range(3)]
    c, s = cos(angle), sin(angle)
    return [n * along + (x - n * along) * c + y * s for n, x, y in zip(e, v, across, strict=True)]
