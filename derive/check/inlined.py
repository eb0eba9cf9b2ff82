"""CasADi's functions called with SX, where it makes their expressions anew, beside themselves.

CasADi simplifies (a + b) - a to b there unless that is hidden from it: pairs and what rounding
left would be gone. Last places may differ; a formula that lost its pairs differs by more.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import casadi

from derive.check.emitted import from_parameters
from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library
from derive.program.largest import largest
from derive.program.program import Program, Quantity
from derive.verify.sample import Sample

SAMPLES = 2
LAST = 2 * 2.0**-53  # of each constant: its own rounding, once here and once there
ROUNDING = 1e-9  # of the largest component: rounding magnified by a condition of up to 1e6
LEFT = "remainder_next"


def inlined(library: Library, module: Any, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether each function gives the same where it is called with SX."""
    plain = [s for s in each if s.kind == "ordinary"][:SAMPLES]
    programs = library.emitted()
    for program in programs if plain else ():
        function = getattr(module, program.name)()
        given = [casadi.SX.sym(f"x{k}", function.sparsity_in(k)) for k in range(function.n_in())]
        anew = casadi.Function("anew", given, function.call(given))
        differ = [
            f"{q.name} at sample {s.number}"
            for s in plain
            for q in _differing(program, from_parameters(module, function, program, s),
                                from_parameters(module, anew, program, s))
        ]  # fmt: skip
        says = f"{differ[0]} is not what it is elsewhere" if differ else f"{len(plain)} samples"
        scene, outcome = library.scene.name, JUDGED[not differ]
        yield Verdict(scene, program.name, "f64", "CasADi's inlined", outcome, says)


def _differing(
    program: Program, true: Sequence[Sequence[float]], found: Sequence[Sequence[float]]
) -> Iterator[Quantity]:
    """Yield the outputs that are not the same but for rounding."""
    for q, a, b in zip(program.outputs, true, found, strict=True):
        if q.name == LEFT:
            same = any(b) or not any(a)
        elif program.makes("constants"):
            same = all(abs(x - y) <= LAST * abs(x) for x, y in zip(a, b, strict=True))
        else:
            size = largest([abs(x) for x in a])
            same = all(abs(x - y) <= ROUNDING * size for x, y in zip(a, b, strict=True))
        if not same:
            yield q
