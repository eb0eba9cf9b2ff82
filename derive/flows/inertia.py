"""What the formulas of a free rotation are told about the body."""

from dataclasses import dataclass
from typing import Literal

from derive.trace import Number


@dataclass(frozen=True)
class Inertia:
    """The tensor about the scene's point along body axes, on the tape of set-up.

    tensor : (xx, yy, zz, xy, xz, yz), tensor entries (I_xy = -sum x y dm), kg m^2
    kind   : what is known of it beforehand: "principal" has no products, "axisymmetric" is
             principal with two equal moments across ``axis``, "spherical" has three equal ones
    """

    tensor: tuple[Number, Number, Number, Number, Number, Number]
    kind: Literal["general", "principal", "axisymmetric", "spherical"]
    axis: Literal["x", "y", "z"] | None
