"""What a function is called with, checked: arrays of the right shapes, of real numbers, by name."""

from collections.abc import Mapping, Sequence
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.program.program import Quantity
from derive.scene import SceneError
from derive.scene.table import nearest, shown
from derive.solve.told import met

REAL = "iuf"
"""Kinds of numbers that are taken: whole and floating; no complex ones, truths or texts."""
NUMBER, ARRAY = "a real number", "an array of real numbers"
DEEPEST = 8
"""Lists within each other in which masked arrays are looked for."""


def named_values(
    label: str,
    inputs: Sequence[Quantity],
    parameters: Sequence[Quantity],
    given: Sequence[Any],
    named: Mapping[str, Any],
) -> dict[str, Any]:
    """Return the value of every input, by place or name, and of every parameter, by name.

    label : how sentences begin       Raises SceneError for what is missing, unknown or twice there.
    """
    names = [q.name for q in inputs]
    if len(given) > len(names):
        listed = f": {', '.join(names)}" if names else ""
        raise SceneError(f"{label} has {len(names)} inputs, not {len(given)}{listed}")
    values = dict(zip(names, given, strict=False))
    known = [*names, *(q.name for q in parameters)]
    for name, value in named.items():
        if name in values:
            raise SceneError(f"{label} is given '{name}' twice")
        if name not in known:
            raise SceneError(f"{label} takes no {shown(name)}{_hint(name, inputs, known)}")
        values[name] = value
    if missing := [name for name in known if name not in values]:
        raise SceneError(f"{label} needs {', '.join(missing)}")
    return values


def _hint(name: str, inputs: Sequence[Quantity], known: Sequence[str]) -> str:
    whole = next((q for q in inputs if name in q.components), None)
    if whole is not None:
        return f": it is a component of {whole.name}, an array {shape_text(whole.shape)}"
    return nearest(name, known)


def by_name(label: str, values: object) -> dict[str, Any]:
    """Return values by name.

    Raises SceneError for what is no mapping, and for a name that is none.
    """
    if not isinstance(values, Mapping):
        rule = "values are given by name, as {'m': 2.0}"
        raise SceneError(f"{label}: {rule}, not as {type(values).__name__}")
    strange = [name for name in values if not isinstance(name, str)]
    if strange:
        raise SceneError(f"{label}: a name is a text, not {type(strange[0]).__name__}")
    return dict(values)


def real(
    label: str, name: str, shape: tuple[int, ...], value: Any, dtype: np.dtype[Any]
) -> NDArray[Any]:
    """Return a value as a contiguous array of ``dtype`` whose last axes are of ``shape``.

    Raises SceneError for what are no real numbers, or of another shape.
    """
    if _masked(value, DEEPEST):
        rule = "must have a value everywhere, but some of it is masked"
        raise SceneError(f"{label}: {name} {rule}")
    try:
        found: NDArray[Any] = np.asarray(value, order="C")
    except Exception:  # of rows of different lengths, or whatever an object's own array raises
        why = "with rows of one length" if isinstance(value, list | tuple) else "of real numbers"
        raise SceneError(f"{label}: {name} must be an array {why}, not {met(value)}") from None
    if found.dtype != dtype:
        one = not shape and found.ndim == 0
        found = _converted(f"{label}: {name}", found, dtype, NUMBER if one else ARRAY, value)
    rank = len(shape)
    if found.ndim < rank or found.shape[found.ndim - rank :] != shape:
        rule = f"must have the shape {shape_text(shape)}, or that behind leading axes"
        raise SceneError(f"{label}: {name} {rule}, not {shape_text(found.shape)}")
    return found


def _masked(value: object, depth: int) -> bool:
    """Tell whether an entry of an array, or of arrays in lists so deep, is masked."""
    if isinstance(value, np.ma.MaskedArray):
        return bool(np.ma.getmaskarray(value).any())
    inner = value if depth and isinstance(value, list | tuple) else ()
    return any(_masked(own, depth - 1) for own in inner if not isinstance(own, float))


def _converted(
    label: str, found: NDArray[Any], dtype: np.dtype[Any], rule: str, value: object
) -> NDArray[Any]:
    whole = found.dtype.kind == "O" and all(type(x) in (int, float) for x in found.flat)
    if found.dtype.kind not in REAL and not whole:
        raise SceneError(f"{label} must be {rule}, not {met(found if found.ndim else value)}")
    try:
        with np.errstate(over="ignore"):  # what is beyond a float is infinite, as in C
            return found.astype(dtype)
    except OverflowError:
        raise SceneError(f"{label} must be within {dtype}, and a whole number is not") from None


def one_number(label: str, name: str, value: object, dtype: type = np.float64) -> float:
    """Return a value that is one number. Raises SceneError for any other."""
    found = real(label, name, (), value, np.dtype(dtype))
    if found.ndim:
        rule = "must be one number; parameters of a batch are named in its call"
        raise SceneError(f"{label}: {name} {rule}, not an array {shape_text(found.shape)}")
    return float(found)


def spread(
    label: str, quantities: Sequence[Quantity], arrays: Sequence[NDArray[Any]]
) -> tuple[tuple[int, ...], list[NDArray[Any]], list[int]]:
    """Return the leading axes of a call, the values of each quantity, and their step by member.

    A step of 0 stands for one value for all. Raises SceneError if axes cannot be broadcast.
    """
    pairs = list(zip(quantities, arrays, strict=True))
    leads = [a.shape[: a.ndim - len(q.shape)] for q, a in pairs]
    try:
        lead = np.broadcast_shapes(*leads)
    except ValueError:
        each = ", ".join(
            f"{q.name} has {shape_text(own)}"
            for q, own in zip(quantities, leads, strict=True)
            if own
        )
        raise SceneError(f"{label}: leading axes must broadcast, but {each}") from None
    whole = [
        a
        if own == lead or prod(own) == 1
        else np.ascontiguousarray(np.broadcast_to(a, lead + q.shape))
        for (q, a), own in zip(pairs, leads, strict=True)
    ]
    steps = [
        0 if prod(own) == 1 else prod(q.shape) for q, own in zip(quantities, leads, strict=True)
    ]
    return lead, whole, steps


def shape_text(shape: tuple[int, ...]) -> str:
    """Return a shape as NumPy shows it.

    >>> shape_text((3,)), shape_text(())
    ('(3,)', '()')
    """
    return f"({', '.join(map(str, shape))}{',' * (len(shape) == 1)})"
