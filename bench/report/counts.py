"""Operations and bytes of what is emitted for the bodies of the cases: targets rest on them."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from bench.motion.ours import emission
from bench.report.code_size import code_size

SPECIAL = ("principal", "axisymmetric", "spherical")
STEPPERS = ("flow_exact", "step_dmv", "step_split6", "step_rk4", "step_taylor")
THIRTEEN, COMPACT = "thirteen", "compact"
DERIVED = "step_rk4_jacobian"
BYTES = "bytes on a Cortex-M4F"


@dataclass(frozen=True)
class Count:
    """How many operations, or bytes, a function of a scene takes; None if that is not known."""

    scene: str
    function: str
    of: str
    count: float | None


def counts(folder: Path) -> Iterator[Count]:
    """Yield the counts of all functions that targets ask for."""
    for scene in SPECIAL:
        own = _flops(scene)
        yield from (Count(scene, name, "operations", own.get(name)) for name in STEPPERS)
    yield Count(THIRTEEN, DERIVED, "operations", _flops(THIRTEEN).get(DERIVED))
    yield Count(COMPACT, DERIVED, BYTES, code_size(emission(COMPACT), folder))


def _flops(scene: str) -> dict[str, int | None]:
    functions = emission(scene).manifest["functions"]
    return {f["name"]: f.get("cost", {}).get("flops") for f in functions}
