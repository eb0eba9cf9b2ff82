"""Inertia of named homogeneous shapes: axial and transverse moments, or three, with exact factors.

Each row of a table is a function of mass and dimensions; ``tests/scenes`` integrates every one of
them again, by quadrature over the volume, surface or line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from derive.declaration import Axis, Sextuple, Triple
from derive.formula import ZERO, Formula, number


@dataclass(frozen=True)
class Shape:
    """What a shape needs to be said, and what kind of body it is."""

    kind: str
    lengths: tuple[str, ...]
    has_axis: bool


SHAPES: Mapping[str, Shape] = {
    "cylinder": Shape("axisymmetric", ("radius", "length"), True),
    "disc": Shape("axisymmetric", ("radius",), True),
    "cone": Shape("axisymmetric", ("radius", "height"), True),
    "hoop": Shape("axisymmetric", ("radius",), True),
    "rod": Shape("rod", ("length",), True),
    "box": Shape("principal", ("lengths",), False),
    "sphere": Shape("spherical", ("radius",), False),
    "hollow_sphere": Shape("spherical", ("radius",), False),
}


def axial_and_transverse(shape: str, mass: Formula, lengths: Mapping[str, Formula]) -> tuple[Formula, Formula]:
    """Return the moments about the axis and across it, about the mass centre.

    shape : a row of SHAPES other than "box"        mass, lengths : formulas in kg and m
    """
    if shape == "rod":
        return ZERO, _times(Fraction(1, 12), mass, lengths["length"])
    radius = lengths["radius"]
    match shape:
        case "cylinder":
            transverse = _times(Fraction(1, 4), mass, radius) + _times(
                Fraction(1, 12), mass, lengths["length"]
            )
            return _times(Fraction(1, 2), mass, radius), transverse
        case "cone":
            transverse = _times(Fraction(3, 20), mass, radius) + _times(
                Fraction(3, 80), mass, lengths["height"]
            )
            return _times(Fraction(3, 10), mass, radius), transverse
    axial, transverse = _ROUND[shape]
    return _times(axial, mass, radius), _times(transverse, mass, radius)


_ROUND = {
    "disc": (Fraction(1, 2), Fraction(1, 4)),
    "hoop": (Fraction(1), Fraction(1, 2)),
    "sphere": (Fraction(2, 5), Fraction(2, 5)),
    "hollow_sphere": (Fraction(2, 3), Fraction(2, 3)),
}
CONE_CENTRE = Fraction(3, 4)
"""How far the mass centre of a cone lies from its apex, in heights."""


def _times(factor: Fraction, mass: Formula, length: Formula) -> Formula:
    return number(factor) * mass * length**2


def box(mass: Formula, lengths: Triple) -> Sextuple:
    """Return the inertia of a box about its mass centre, edges along x, y and z."""
    a, b, c = (_times(Fraction(1, 12), mass, length) for length in lengths)
    return diagonal(b + c, a + c, a + b)


def diagonal(xx: Formula, yy: Formula, zz: Formula) -> Sextuple:
    """Return an inertia without products."""
    return xx, yy, zz, ZERO, ZERO, ZERO


def about_axis(axis: Axis, axial: Formula, transverse: Formula) -> Sextuple:
    """Return the inertia of an axisymmetric body; its two equal moments are one formula."""
    xx, yy, zz = (axial if name == axis else transverse for name in "xyz")
    return diagonal(xx, yy, zz)


def moved(inertia: Sextuple, mass: Formula, centre: Triple) -> Sextuple:
    """Return the inertia about a point, from that about the mass centre (parallel axes).

    inertia : kg m^2, about the mass centre        centre : m, from the point, along the same axes
    Source: lecture step "parallel_axes".
    """
    x, y, z = centre
    squares = [length**2 if length != ZERO else ZERO for length in centre]
    added = (
        *(mass * (squares[i] + squares[j]) for i, j in ((1, 2), (0, 2), (0, 1))),
        *(mass * (first * second) for first, second in ((x, y), (x, z), (y, z))),
    )
    xx, yy, zz, xy, xz, yz = (before + more for before, more in zip(inertia, added, strict=True))
    return xx, yy, zz, xy, xz, yz


def apex_transverse(mass: Formula, lengths: Mapping[str, Formula]) -> Formula:
    """Return the transverse moment of a cone about its apex."""
    radius = _times(Fraction(3, 20), mass, lengths["radius"])
    return radius + _times(Fraction(3, 5), mass, lengths["height"])
