"""The emitted C beside the same machine described along other axes, derived anew.

Frames, bodies and loads are told along other axes before the lecture's equations are written, and
what these give is told back: an error of one axis, of the order of turns, of a sign is seen.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import arb, ctx

from derive.check.agreement import ABSURD, LARGEST_BOUND, MORE
from derive.check.description import Description, relabelled, turned_machine
from derive.check.emitted import Emitted, errors_of, verdict
from derive.check.verdict import JUDGED, Verdict
from derive.program.largest import largest
from derive.program.program import Program, component_names
from derive.scene import Scene
from derive.scene.formula import symbols
from derive.scene.results import MATRICES, written_out
from derive.verify.draw import Sampled
from derive.verify.equations import Equations, retold
from derive.verify.measure import Expected, should
from derive.verify.reference import BITS, reference
from derive.verify.sample import Sample
from derive.verify.scale import base_of

Stated = Mapping[str, Mapping[str, Mapping[str, Mapping[str, Any]]]]


def turned_axes(one: Emitted, each: Sequence[Sample], stated: Stated) -> Iterator[Verdict]:
    """Yield whether every function is what the machine told along other axes gives."""
    scene = one.library.scene
    of = Sampled(one.library, one.precision)
    told = {"cyclic relabelling": relabelled(scene), "rotation of axes": turned_machine(scene)}
    for check, description in told.items():
        if description is None or not one.library.functions:
            says = "no frame with an angular velocity of its own holds bodies of any axes"
            says = says if one.library.functions else "nothing is wanted that equations state"
            yield verdict(one, "all", check, "skipped", says)
            continue
        bases = [base for base in one.library.problems if not _free_to_choose(scene, base)]
        anew = retold(description.told(), bases)
        for program, true in should(of, one.library.functions, each):
            equations = anew.get(base_of(program))
            if equations is None:
                says = "rows of small motion and what vanishes if steady may be told otherwise"
                yield verdict(one, program.name, check, "skipped", says)
            elif not program.sparsity:
                rows = [
                    _told_back(description, equations, program, s, own)
                    for s, own in zip(each, true, strict=True)
                ]
                yield _judged(one, check, program, (each, rows), stated)


def _free_to_choose(scene: Scene, base: str) -> bool:
    """Tell whether a function's rows may be multiplied or combined, and mean the same."""
    if base in scene.steady:
        return not scene.steady[base].vanishes
    names = scene.asked.get(base, (base,))
    results = [r for r in scene.results if r.name in names]
    used = {s for r in results for s in symbols(written_out(r.formula, scene.results))}
    matrices = tuple(MATRICES)
    return "linearised" in names or any(s.startswith(matrices) for s in (*names, *used))


def _told_back(
    description: Description,
    equations: Equations,
    program: Program,
    sample: Sample,
    own: Sequence[Expected],
) -> list[Expected]:
    """Return what the other description gives, with the scales of the scene's own.

    What vanishes for the scene, or nearly, is a ball around zero where it is a sum along others.
    """
    with ctx.workprec(BITS):
        given = description.given({c: arb(x) for c, x in sample.values.items()})
        solved = reference(equations, given, ())
        names = component_names(program)
        values = description.told_back({c: solved[c].value for c in names})
        pairs = [(values[c], true) for c, true in zip(names, own, strict=True)]
        return [
            true if x.contains(0) and x.overlaps(true.value) else replace(true, value=x)
            for x, true in pairs
        ]


def _judged(
    one: Emitted,
    check: str,
    program: Program,
    at: tuple[Sequence[Sample], Sequence[Sequence[Expected]]],
    stated: Stated,
) -> Verdict:
    """Return a verdict on C, which may differ by the stated error and that of its quaternions.

    These are of length 1 to a rounding only, and each description shows that in another way.
    """
    each, true = at
    worst, allowed = 0.0, 0.0
    for found in errors_of(one, program, each, true):
        figures = stated.get(program.name, {}).get(one.precision.name, {}).get(found.output, {})
        most = min(ABSURD, LARGEST_BOUND + MORE * float(figures.get("largest_ulp", 0.0)))
        gap = largest(found.largest())
        if not gap / most <= worst / (allowed or 1.0):
            worst, allowed = gap, most
    says = f"{len(each)} samples, largest gap {worst:.2g} u; allowed {allowed:.2g} u"
    return verdict(one, program.name, check, JUDGED[worst <= allowed], says)
