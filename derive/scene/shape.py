"""Inertia of named homogeneous shapes, with exact factors, and its parallel axes.

A shape is a row of ``ROUND``: each moment about the mass centre is the mass times a sum of factors
times squared lengths. The tests integrate every shape again, by quadrature over its mass.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from derive.scene.declaration import Axis, Sextuple, Triple
from derive.scene.formula import ZERO, Formula, number

LinearForm = tuple[tuple[Fraction, str], ...]


@dataclass(frozen=True)
class Round:
    """A shape with an axis, or a sphere: its moments along the axis and across it."""

    kind: str
    axial: LinearForm
    transverse: LinearForm

    @property
    def lengths(self) -> tuple[str, ...]:
        """Return the names of the lengths that its moments are made of."""
        return tuple(dict.fromkeys(name for _, name in (*self.transverse, *self.axial)))

    @property
    def sphere(self) -> bool:
        """Tell whether all its axes are alike."""
        return self.kind == "spherical"


def _round(kind: str, axial: str, transverse: str) -> Round:
    """Return the shape whose moments are sums such as "1/4 radius + 1/12 length"."""
    both = ([term.split() for term in text.split(" + ") if term] for text in (axial, transverse))
    along, across = (tuple((Fraction(q), name) for q, name in terms) for terms in both)
    return Round(kind, along, across)


ROUND: Mapping[str, Round] = {
    "cylinder": _round("axisymmetric", "1/2 radius", "1/4 radius + 1/12 length"),
    "disc": _round("axisymmetric", "1/2 radius", "1/4 radius"),
    "hoop": _round("axisymmetric", "1 radius", "1/2 radius"),
    "cone": _round("axisymmetric", "3/10 radius", "3/20 radius + 3/80 height"),
    "rod": _round("rod", "", "1/12 length"),
    "sphere": _round("spherical", "2/5 radius", "2/5 radius"),
    "hollow_sphere": _round("spherical", "2/3 radius", "2/3 radius"),
    "tube": _round("axisymmetric", "1/2 inner + 1/2 outer", "1/4 inner + 1/4 outer + 1/12 length"),
}
SHAPES = (*(name for name in ROUND if name != "tube"), "box")
"""Shapes that a single body may have."""
CONE_CENTRE = Fraction(3, 4)
"""How far the mass centre of a cone lies from its apex, in heights."""


def moment(terms: LinearForm, mass: Formula, lengths: Mapping[str, Formula]) -> Formula:
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


def by_parallel_axes(inertia: Sextuple, mass: Formula, centre: Triple) -> Sextuple:
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
