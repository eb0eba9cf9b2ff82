"""Parameters that are fixed: C then has a table of constants, of the bits that set-up makes."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.library.library import Library
from derive.program.arithmetic import extended, paired
from derive.program.precision import PRECISIONS, Precision
from derive.program.program import component_names
from derive.program.run import run
from derive.program.status import RIGHT, SAYS, refusal, statuses
from derive.scene import SceneError


def with_fixed(library: Library, values: Mapping[str, float]) -> Library:
    """Return a library whose C has a table in the place of set-up.

    values : of every parameter that set-up is told; none leaves the library as it is
    Raises SceneError for values that are missing, that it is not told, or that it refuses.
    """
    if not values:
        return library
    scene, setup = library.scene.name, library.setup
    names = [c for q in setup.inputs for c in q.components]
    if not library.constants:
        raise SceneError(
            f"scene '{scene}': nothing rests on parameters only, so none is to be fixed"
        )
    if missing := [c for c in names if c not in values]:
        rule = "every parameter that set-up is told must be fixed"
        raise SceneError(f"scene '{scene}': {rule}, but not {', '.join(missing)}")
    if strange := [c for c in values if c not in names]:
        raise SceneError(
            f"scene '{scene}': set-up is not told '{strange[0]}', so it cannot be fixed"
        )
    given = [values[c] for c in names]
    if why := refusal(setup, given):
        raise SceneError(f"scene '{scene}': set-up refuses these values: {why}")
    for precision in PRECISIONS:
        columns: list[NDArray[Any]] = [np.array([x], precision.dtype) for x in given]
        status = int(statuses(setup, columns, precision.dtype)[0])
        if status != RIGHT:
            by = f"set-up in {precision.scalar} refuses these values"
            odd = [f"{c} = {values[c]:g} is {x[0]:g}" for c, x in zip(names, columns, strict=True)
                   if not np.isfinite(x[0]) or (x[0] == 0) != (values[c] == 0)]  # fmt: skip
            shown = odd or [f"{c} = {values[c]:g}" for c in names]
            raise SceneError(f"scene '{scene}': {by}: {SAYS[status]}; there {', '.join(shown)}")
    return replace(library, fixed={c: values[c] for c in names})


def unstated_values(library: Library) -> tuple[str, ...]:
    """Return what is to be said of fixed parameters outside of their ranges."""
    return tuple(
        f"{c} = {library.fixed[c]:g} is outside of its range, {float(q.low):g} .. "
        f"{float(q.high):g}, and errors are stated for these"
        for q in library.setup.inputs
        for c in q.components
        if library.fixed and q.low is not None and q.high is not None
        and not float(q.low) <= library.fixed[c] <= float(q.high)
    )  # fmt: skip


def fixed_constants(library: Library, precision: Precision) -> dict[str, float]:
    """Return what set-up makes of the fixed parameters, by name, in a precision."""
    given = np.array([[library.fixed[c]] for q in library.setup.inputs for c in q.components])
    pairs = run(library.setup, extended(precision.dtype), paired(given.astype(precision.dtype)))
    made = [float(np.ravel(high)[0]) for high, _ in pairs]
    return dict(zip(component_names(library.setup), made, strict=True))


def fixed_text(values: Mapping[str, float]) -> str:
    """Return fixed values as the command line takes them.

    >>> fixed_text({"m": 2.0, "d": 0.06})
    'm=2,d=0.06'
    """
    return ",".join(f"{name}={_shortest(x)}" for name, x in values.items())


def _shortest(x: float) -> str:
    return repr(x).removesuffix(".0")
