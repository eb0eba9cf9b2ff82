"""Principal axes of bodies whose products of inertia do not vanish, in figures."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import cast

from derive.motion.exact.principal import principal_axes_of
from derive.scene import Scene
from derive.scene.declaration import Parameter, Sextuple
from derive.scene.numbers import inertia_matrix


@dataclass(frozen=True)
class PrincipalLine:
    """A body, the principal moments of its tensor, and their directions along its own axes."""

    body: str
    moments: str
    directions: tuple[str, ...]


def principal_lines(scene: Scene) -> Iterator[PrincipalLine]:
    """Yield the principal axes of tensors, as given, at seven tenths of all parameters' ranges.

    Those whose products vanish there have none but their own axes, and are left out, as are those
    whose inertia is not known as a whole.
    """
    values = {p.name: _within(p) for p in scene.parameters}
    for body in scene.bodies:
        inertia = body.given or body.inertia
        if None in inertia:
            continue
        rows = inertia_matrix(cast(Sextuple, inertia), values, f"body '{body.name}' inertia")
        if any(rows[i][k] for i, k in ((0, 1), (0, 2), (1, 2))):
            found = principal_axes_of(rows)
            moments, directions = _written(found.moments), map(_written, found.directions)
            yield PrincipalLine(body.name, moments, tuple(f"({d})" for d in directions))


def _within(parameter: Parameter) -> float:
    return float((3 * parameter.low + 7 * parameter.high) / 10)


def _written(numbers: Sequence[float]) -> str:
    return ", ".join(f"{x:.4g}" for x in numbers).replace("-", "−")
