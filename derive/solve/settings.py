"""Values that a user gives to a scene's quantities: whole vectors, or component by component."""

import re
from collections.abc import Mapping, Sequence
from math import isfinite, nan, pi

import numpy as np
from numpy.typing import ArrayLike

from derive.program.program import Quantity
from derive.scene import SceneError
from derive.scene.table import MANY, nearest, shown
from derive.scene.unit import ANGULAR_VELOCITY, NONE, dimension
from derive.solve.arguments import by_name, real, shape_text

NamedValues = Mapping[str, ArrayLike | str]
"""Values by name, in SI units, or texts as ``"3deg"`` and ``"5000rpm"``."""
FACTORS = {"": 1.0, "deg": pi / 180, "rpm": 2 * pi / 60}
OF = {"deg": NONE, "rpm": ANGULAR_VELOCITY}
NUMBER = re.compile(r"([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,6})?) ?(|deg|rpm)")


def settings(scene: str, quantities: Sequence[Quantity], values: NamedValues) -> dict[str, float]:
    """Return the value of each component that is set.

    Raises SceneError for names that the scene does not have, and for what are no finite numbers.
    """
    found: dict[str, float] = {}
    for name, value in by_name(f"scene '{scene}'", values).items():
        q = settable(scene, quantities, name)
        shape, names = (q.shape, q.components) if name == q.name else ((), (name,))
        own = number(f"{name}={value}", value.strip(), q.unit) if isinstance(value, str) else value
        array = real(f"scene '{scene}'", name, shape, own, np.dtype(np.float64))
        if array.shape != shape:
            rule = f"must have the shape {shape_text(shape)}"
            raise SceneError(f"scene '{scene}': {name} {rule}, not {shape_text(array.shape)}")
        for component, x in zip(names, array.ravel().tolist(), strict=True):
            if not isfinite(x):
                raise SceneError(f"scene '{scene}': {component} must be finite, not {x}")
            if component in found:
                raise SceneError(f"scene '{scene}': '{component}' is set twice")
            found[component] = x
    return found


def settable(scene: str, quantities: Sequence[Quantity], name: str) -> Quantity:
    """Return the quantity that is called so, or has a component that is.

    Raises SceneError if there is none.
    """
    found = next((q for q in quantities if name == q.name or name in q.components), None)
    if found is None:
        names = [c for q in quantities for c in q.components]
        few = [*names[:MANY], *([f"{len(names) - MANY} more"] if len(names) > MANY else [])]
        told = f" (known: {', '.join(few)})" if names else ", nor anything else"
        hint = nearest(str(name), names) or told
        raise SceneError(f"scene '{scene}' has no {shown(name)} to set{hint}")
    return found


def number(label: str, text: str, unit: str) -> float:
    """Return the number of a text, in SI units. Raises SceneError for one that is none."""
    found = NUMBER.fullmatch(text)
    if found and found[2] and dimension(unit) != OF[found[2]]:
        raise SceneError(f"{label[:60]}: the value is in {unit}, not in {found[2]}")
    number = float(found[1]) * FACTORS[found[2]] if found else nan
    if not isfinite(number):
        rule = f"a value is a finite number in SI units (here {unit}), as 0.5, an angle also 3deg"
        raise SceneError(f"{label[:60]}: {rule}, not {shown(text)}")
    return number
