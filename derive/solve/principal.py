"""Principal axes of an inertia tensor that a user gives, as an array or as rows."""

from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike

from derive.motion.exact.principal import PrincipalAxes, principal_axes_of
from derive.scene import SceneError
from derive.solve.arguments import real, shape_text

__all__ = ["PrincipalAxes", "principal_axes"]


def principal_axes(tensor: ArrayLike) -> PrincipalAxes:
    """Return the principal moments of a symmetric tensor and the directions of its axes.

    tensor : (3, 3) kg m^2, rows along body axes; products of inertia enter with minus
    Directions are unit vectors along the same axes, the largest component of the first two
    positive. All is right to a rounding, whatever the moments: it is worked out in 192 bits.
    Raises DeriveError if the tensor is not symmetric or not finite.
    Source: lecture step "principal_directions".

    >>> principal_axes([[2, 0, 0], [0, 3, 0], [0, 0, 1]]).moments
    (1.0, 2.0, 3.0)
    """
    found = real("principal axes", "the inertia tensor", (3, 3), tensor, np.dtype(np.float64))
    if found.ndim != 2:
        rule = "the inertia tensor must be one, of the shape (3, 3)"
        raise SceneError(f"principal axes: {rule}, not {shape_text(found.shape)}")
    rows: list[list[float]] = found.tolist()
    if not np.isfinite(found).all():
        raise SceneError(f"inertia tensor: must be finite, not {rows}")
    for i, k in ((0, 1), (0, 2), (1, 2)):
        if rows[i][k] != rows[k][i]:
            facing = f"{rows[i][k]!r} faces {rows[k][i]!r}"
            raise SceneError(f"inertia tensor: must be symmetric, but {facing}")
    return principal_axes_of([[Fraction(entry) for entry in row] for row in rows])
