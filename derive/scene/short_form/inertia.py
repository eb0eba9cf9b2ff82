"""The inertia of a body and its wheels: what it demands of parameters, and what is doubtful."""

from collections.abc import Iterable, Iterator, Sequence

from derive.scene.declaration import Parameter, Sextuple
from derive.scene.demands import in_order, of_substance
from derive.scene.formula import Formula
from derive.scene.machine import Above, Demand, Entries, Tensor
from derive.scene.numbers import (
    FractionMatrix,
    Valuation,
    definite,
    ends_of,
    first_wrong,
    inertia_matrix,
    middle,
    not_definite,
    second_moments,
    semidefinite,
    tensor_doubts,
    trace,
    triangle,
    valuations_of,
)
from derive.scene.shape import by_parallel_axes
from derive.scene.short_form.declared import Body, ShortForm


def of_one_body(scene: ShortForm) -> tuple[Demand, ...]:
    """Return what the scene of a single body demands of its parameters."""
    body, found = scene.body, list[Demand]()
    found += of_substance("body", body.mass, body.lengths)
    for wheel in scene.wheels:
        found.append(Above(f"wheel '{wheel.name}': axial", "inertia", wheel.axial))
    label = "body inertia less that of the wheels" if scene.wheels else "body inertia"
    return in_order((*found, Tensor(label, _about_every_axis(body, carrier(scene)), "positive",
                                     body.inertia)))  # fmt: skip


def carrier(scene: ShortForm) -> Sextuple:
    """Return the inertia of the body without what its wheels have about their axes."""
    xx, yy, zz, xy, xz, yz = scene.body.inertia
    for wheel in scene.wheels:
        (x, y, z), axial = wheel.axis, wheel.axial
        xx, yy, zz = xx - axial * x * x, yy - axial * y * y, zz - axial * z * z
        xy, xz, yz = xy + axial * x * y, xz + axial * x * z, yz + axial * y * z
    return xx, yy, zz, xy, xz, yz


def _about_every_axis(body: Body, inertia: Sextuple) -> Entries:
    """Return the entries that count: a thin rod need not have a moment about its own axis."""
    if body.kind != "rod":
        return inertia
    xx, yy, zz, xy, xz, yz = inertia
    first, second, third = (
        None if name == body.axis else m for name, m in zip("xyz", (xx, yy, zz), strict=True)
    )
    return first, second, third, xy, xz, yz


def check_inertia(body: Body, parameters: tuple[Parameter, ...]) -> Iterator[str]:
    """Yield a sentence on an inertia that is not positive definite at the middle of the ranges.

    Of a thin rod only the transverse moment must be positive.
    """
    values = middle(ends_of(parameters))
    if not _possible(body, inertia_matrix(body.inertia, values, "body inertia")):
        yield not_definite("body inertia", body.inertia, values)


def _possible(body: Body, matrix: FractionMatrix) -> bool:
    if body.kind != "rod":
        return definite(matrix)
    return all(matrix[i][i] > 0 for i in range(3) if "xyz"[i] != body.axis)


def inertia_doubts(body: Body, parameters: tuple[Parameter, ...]) -> Iterator[str]:
    """Yield what is doubtful about an inertia, and about what it leaves about the mass centre."""
    yield from tensor_doubts("body inertia", body.inertia, parameters, lambda m: _possible(body, m))
    if body.mass is None or body.centre is None:
        return
    own = by_parallel_axes(body.inertia, -body.mass, body.centre)

    def no_masses(values: Valuation) -> bool:
        about, left = (inertia_matrix(part, values, "body inertia") for part in (body.inertia, own))
        size = abs(trace(about))
        masses = semidefinite(left, size) and semidefinite(second_moments(left), size)
        return semidefinite(about, size) and triangle(about) and not masses

    formulas = (*body.inertia, body.mass, *body.centre)
    says = "body inertia less that of its mass at body.centre is no masses'"
    yield from first_wrong(says, valuations_of(parameters, formulas), formulas, no_masses)


def carrier_doubts(
    carrier: Sextuple, formulas: Sequence[Formula], each: Iterable[Valuation]
) -> Iterator[str]:
    """Yield a sentence on the first values at which wheels leave their carrier no inertia.

    carrier : inertia of the body without what its wheels have about their axes
    """
    says = "body inertia is that of the whole, but the wheels alone exceed it"
    label = "body inertia"
    yield from first_wrong(
        says, each, formulas, lambda v: not definite(inertia_matrix(carrier, v, label))
    )
