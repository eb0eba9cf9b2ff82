"""How far errors are magnified on their way through equations: what tiny results are counted in.

Where no sample comes near to that, a bound for all of them is enough.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from typing import Any

from derive.scene.formula import Arithmetic
from derive.verify.equations import Sum
from derive.verify.solution import SolvedEquations, differentiated, times
from derive.verify.valuation import raised


def gains(
    of: SolvedEquations, arithmetic: Arithmetic, ends: Callable[[Any], tuple[Any, Any]]
) -> dict[str, Any]:
    """Return how far an error of what each unknown is made of is magnified in it, at least 1.

    ends : the smallest and the largest of sizes, where a bound for all samples is enough
    """
    found: dict[int, Any] = {}
    most = arithmetic["most"]
    scales = {place: ends(known.scale) for place, known in of.known.items()}
    sizes = [None if s is None else ends(s)[1] for _, s in of.coefficients]
    for block, inverse in zip(of.equations.blocks, of.inverses, strict=True):
        right = [_gain(s, found, scales, sizes, most) for s in block.right]
        for atom, row in zip(block.unknowns, inverse, strict=True):
            each = (ends(x)[1] * r for x, r in zip(row, right, strict=True))
            found[atom] = reduce(most, each, 1.0)
    return {of.equations.names[atom]: gain for atom, gain in found.items()}


def _gain(
    parts: Sum,
    found: Mapping[int, Any],
    scales: Mapping[int, tuple[Any, Any]],
    sizes: Sequence[Any],
    most: Callable[[Any, Any], Any],
) -> Any:
    """Return the largest of what a sum magnifies its factors by, times what these have gained."""
    gain: Any = 1.0
    for part in parts:
        for place, (atom, _) in enumerate(part.factors):
            size = sizes[part.coefficient]
            for other, count, left in differentiated(part, place):
                size = size if count == 1 else times(size, float(abs(count)))
                if left:
                    size = times(size, raised(scales[other][left > 0], left))
            gain = most(gain, times(size, found.get(atom, 1.0)))
    return gain
