"""Inertia of named homogeneous shapes, with exact factors, and its parallel axes.

A shape is a row of ``ROUND``: each moment about the mass centre is the mass times a sum of factors
times squared lengths. The tests integrate every shape again, by quadrature over its mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from derive.scene.formula import ZERO, Formula, number

if TYPE_CHECKING:
    from collections.abc import Mapping

    from derive.scene.declaration import Axis, Sextuple, Triple

Terms = tuple[tuple[Fraction, str], ...]


@dataclass(frozen=True)
class Round:
    """A shape with an axis, or a sphere: its moments along the axis and across it."""

    kind: str
    lengths: tuple[str, ...]
    axial: Terms
    transverse: Terms

    @property
    def sphere(self) -> bool:
        """Tell whether all its axes are alike."""
        return self.kind == "spherical"


def _terms(*rows: tuple[int, int, str]) -> Terms:
    return tuple((Fraction(above, below), length) for above, below, length in rows)


ROUND: Mapping[str, Round] = {
    "cylinder": Round(
        "axisymmetric",
        ("radius", "length"),
        _terms((1, 2, "radius")),
        _terms((1, 4, "radius"), (1, 12, "length")),
    ),
    "disc": Round("axisymmetric", ("radius",), _terms((1, 2, "radius")), _terms((1, 4, "radius"))),
    "hoop": Round("axisymmetric", ("radius",), _terms((1, 1, "radius")), _terms((1, 2, "radius"))),
    "cone": Round(
        "axisymmetric",
        ("radius", "height"),
        _terms((3, 10, "radius")),
        _terms((3, 20, "radius"), (3, 80, "height")),
    ),
    "rod": Round("rod", ("length",), (), _terms((1, 12, "length"))),
    "sphere": Round("spherical", ("radius",), _terms((2, 5, "radius")), _terms((2, 5, "radius"))),
    "hollow_sphere": Round(
        "spherical", ("radius",), _terms((2, 3, "radius")), _terms((2, 3, "radius"))
    ),
    "tube": Round(
        "axisymmetric",
        ("inner", "outer", "length"),
        _terms((1, 2, "inner"), (1, 2, "outer")),
        _terms((1, 4, "inner"), (1, 4, "outer"), (1, 12, "length")),
    ),
}
SHAPES = (*(name for name in ROUND if name != "tube"), "box")
"""Shapes that a single body may have."""
CONE_CENTRE = Fraction(3, 4)
"""How far the mass centre of a cone lies from its apex, in heights."""


def moment(terms: Terms, mass: Formula, lengths: Mapping[str, Formula]) -> Formula:
    """Return the moment of inertia that a row of terms says, in kg m^2."""
    result = ZERO
    for factor, name in terms:
        result = result + number(factor) * mass * lengths[name] ** 2
    return result


def box(mass: Formula, lengths: Triple) -> Sextuple:
    """Return the inertia of a box about its mass centre, edges along x, y and z."""
    twelfth = number(Fraction(1, 12))
    a, b, c = (twelfth * mass * length**2 for length in lengths)
    return diagonal(b + c, a + c, a + b)


def diagonal(xx: Formula, yy: Formula, zz: Formula) -> Sextuple:
    """Return an inertia without products."""
    return xx, yy, zz, ZERO, ZERO, ZERO


def about_axis(axis: Axis | None, axial: Formula, transverse: Formula) -> Sextuple:
    """Return the inertia of an axisymmetric body; its two equal moments are one formula.

    axis : None for a sphere, whose moments are all transverse
    """
    xx, yy, zz = (axial if name == axis else transverse for name in ("x", "y", "z"))
    return diagonal(xx, yy, zz)


def moved(inertia: Sextuple, mass: Formula, centre: Triple) -> Sextuple:
    """Return the inertia about a point, from that about the mass centre (parallel axes).

    inertia : kg m^2, about the mass centre        centre : m, from the point, along the same axes
    Source: lecture step "parallel_axes".
    """
    x, y, z = centre
    xx, yy, zz, xy, xz, yz = inertia
    a, b, c = (ZERO if length == ZERO else length**2 for length in centre)
    return (
        xx + mass * (b + c),
        yy + mass * (a + c),
        zz + mass * (a + b),
        xy + mass * (x * y),
        xz + mass * (x * z),
        yz + mass * (y * z),
    )
