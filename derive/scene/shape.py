"""Inertia of named homogeneous shapes, with exact factors, and what they look like.

A shape is a row of ``ROUND``: each moment about the mass centre is the mass times a sum of factors
times squared lengths; its rims, circles around the axis, say where its surface is. The tests
integrate every shape again, by quadrature over its mass and over what is drawn.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from derive.scene.declaration import Axis, Sextuple, Triple
from derive.scene.formula import ZERO, Formula, number

LinearForm = tuple[tuple[Fraction, str], ...]


@dataclass(frozen=True)
class Rim:
    """A circle around the axis: how far along it from the mass centre, inner and outer radius."""

    along: LinearForm
    inner: LinearForm
    outer: LinearForm


@dataclass(frozen=True)
class Round:
    """A shape with an axis, or a sphere: its moments along the axis and across it, its rims.

    A sphere has no rims; its one length is its radius.
    """

    kind: str
    axial: LinearForm
    transverse: LinearForm
    rims: tuple[Rim, ...]

    @property
    def lengths(self) -> tuple[str, ...]:
        """Return the names of the lengths that its moments are made of."""
        return tuple(dict.fromkeys(name for _, name in (*self.transverse, *self.axial)))

    @property
    def sphere(self) -> bool:
        """Tell whether all its axes are alike."""
        return self.kind == "spherical"


def _terms(text: str) -> LinearForm:
    """Return a sum such as "1/4 radius + 1/12 length"."""
    each = (term.split() for term in text.split(" + ") if term)
    return tuple((Fraction(q), name) for q, name in each)


def _round(kind: str, axial: str, transverse: str, *rims: str) -> Round:
    """Return the shape with these moments and rims; of a rim "along, inner, outer"."""
    circles = (Rim(*(_terms(part.strip()) for part in rim.split(","))) for rim in rims)
    return Round(kind, _terms(axial), _terms(transverse), tuple(circles))


ROUND: Mapping[str, Round] = {
    "cylinder": _round("axisymmetric", "1/2 radius", "1/4 radius + 1/12 length",
                       "-1/2 length,, 1 radius", "1/2 length,, 1 radius"),
    "disc": _round("axisymmetric", "1/2 radius", "1/4 radius", ",, 1 radius"),
    "hoop": _round("axisymmetric", "1 radius", "1/2 radius", ", 1 radius, 1 radius"),
    "cone": _round("axisymmetric", "3/10 radius", "3/20 radius + 3/80 height",
                   "-3/4 height,,", "1/4 height,, 1 radius"),
    "rod": _round("rod", "", "1/12 length", "-1/2 length,,", "1/2 length,,"),
    "sphere": _round("spherical", "2/5 radius", "2/5 radius"),
    "hollow_sphere": _round("spherical", "2/3 radius", "2/3 radius"),
    "tube": _round("axisymmetric", "1/2 inner + 1/2 outer", "1/4 inner + 1/4 outer + 1/12 length",
                   "-1/2 length, 1 inner, 1 outer", "1/2 length, 1 inner, 1 outer"),
}  # fmt: skip
SHAPES = (*(name for name in ROUND if name != "tube"), "box")
"""Shapes that a single body may have."""
AXIS_AFTER: Mapping[str, Axis] = {"x": "y", "y": "z", "z": "x"}
CONE_CENTRE = Fraction(3, 4)
"""How far the mass centre of a cone lies from its apex, in heights."""


@dataclass(frozen=True)
class Portion:
    """A part of a body to be drawn, about the body's mass centre, along its own axes.

    rims : circles around ``axis``: how far along, inner and outer radius; none of a ball or a box
    edges : of a box, along x, y and z; of a ball, its radius in each; three zeros of a point
            mass; of a blade, where it begins and ends along the axis after ``axis``, its length
    turned : of a blade, in whole turns about ``axis``
    """

    kind: Literal["round", "ball", "box", "blade"]
    axis: Axis
    rims: tuple[Triple, ...] = ()
    edges: Triple = (ZERO, ZERO, ZERO)
    turned: Fraction = Fraction(0)


def round_part(shape: str, axis: Axis | None, lengths: Mapping[str, Formula]) -> Portion:
    """Return what a row of ``ROUND`` looks like."""
    row = ROUND[shape]
    if axis is None or row.sphere:
        r = lengths["radius"]
        return Portion("ball", "z", edges=(r, r, r))
    circles = (
        (_added(rim.along, lengths), _added(rim.inner, lengths), _added(rim.outer, lengths))
        for rim in row.rims
    )
    return Portion("round", axis, tuple(circles))


def blade_parts(axis: Axis, first: Axis, count: int, length: Formula) -> tuple[Portion, ...]:
    """Return blades from the hub, the first along ``first``; one about its middle."""
    begin = Fraction(0 if first == AXIS_AFTER[axis] else 1, 4)
    start = number(Fraction(-1, 2)) * length if count == 1 else ZERO
    end = number(Fraction(1, 2)) * length if count == 1 else length
    return tuple(
        Portion("blade", axis, edges=(start, end, length), turned=begin + Fraction(k, count))
        for k in range(count)
    )


def _added(terms: LinearForm, lengths: Mapping[str, Formula]) -> Formula:
    """Return a sum of lengths."""
    result = ZERO
    for factor, name in terms:
        result = result + number(factor) * lengths[name]
    return result


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
