"""What the formulas of a free rotation are told about the body."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from derive.program.operations import less, select
from derive.program.tape import Number

SixEntries = tuple[Number, Number, Number, Number, Number, Number]


@dataclass(frozen=True)
class Inertia:
    """The tensor about the scene's point along body axes, on the tape of set-up.

    tensor : (xx, yy, zz, xy, xz, yz), tensor entries (I_xy = -sum x y dm), kg m^2
    kind   : what is known of it beforehand: "principal" has no products, "axisymmetric" is
             principal with two equal moments across ``axis``, "spherical" has three equal ones
    """

    tensor: SixEntries
    kind: Literal["general", "principal", "axisymmetric", "spherical"]
    axis: Literal["x", "y", "z"] | None

    @property
    def places(self) -> tuple[int, int, int]:
        """Return the places of two axes across the axis of revolution, and its own."""
        k = "xyz".index(self.axis or "z")
        return (k + 1) % 3, (k + 2) % 3, k


def as_symmetric(tensor: SixEntries) -> Inertia:
    """Return the most special body that has this tensor: equal moments are the same number."""
    xx, yy, zz, *products = tensor
    if any(n.exact != 0 for n in products):
        return Inertia(tensor, "general", None)
    if xx == yy == zz:
        return Inertia(tensor, "spherical", None)
    if yy == zz:
        return Inertia(tensor, "axisymmetric", "x")
    if zz == xx:
        return Inertia(tensor, "axisymmetric", "y")
    if xx == yy:
        return Inertia(tensor, "axisymmetric", "z")
    return Inertia(tensor, "principal", None)


def ascending(moments: Sequence[Number]) -> tuple[Number, Number, Number]:
    """Return three moments, the smallest first.

    >>> from derive.program.tape import number
    >>> [int(m.exact) for m in ascending([number(3), number(1), number(2)])]
    [1, 2, 3]
    """
    x, y, z = moments
    x, y = _swapped(x, y)
    y, z = _swapped(y, z)
    x, y = _swapped(x, y)
    return x, y, z


def _swapped(x: Number, y: Number) -> tuple[Number, Number]:
    first = less(y, x)
    return select(first, y, x), select(first, x, y)
