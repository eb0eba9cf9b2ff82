"""Stated errors beside samples of another seed: none may be larger by more than a tenth.

The figures are read from the scene's JSON. What is larger in pairs of doubles is measured again in
balls before it counts.
"""

from collections.abc import Callable, Iterator, Sequence

from derive.check.agreement import ABSURD, MORE
from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library
from derive.program.largest import largest
from derive.program.precision import PRECISIONS
from derive.program.program import Measurement, Program
from derive.verify.draw import Sampled
from derive.verify.scale import measured_outputs
from derive.verify.search import Worst, sampled
from derive.verify.stated import at_rows, at_samples

SEED = "checked"
KEPT = 4


def fresh(
    library: Library,
    stated: Sequence[Measurement],
    samples: int,
    told: Callable[[str], None],
) -> Iterator[Verdict]:
    """Yield whether any error at fresh samples is larger than stated, a row an output.

    told : is called with a sentence as samples are done
    """
    said = {(m.function, m.precision, m.output): m.within for m in stated}
    for precision in PRECISIONS:
        of = Sampled(library, precision)
        found: list[Worst] = []
        for done, found in sampled(of, SEED, samples, KEPT):  # noqa: B007 - the last is kept
            told(f"{library.scene.name}: {precision.name}, {done} of {samples} samples")
        for program in library.printed():
            for place, (q, _) in enumerate(measured_outputs(program)):
                own = [w for w in found if (w.function, w.output) == (program.name, q.name)]
                limit = said.get((program.name, precision.name, q.name))
                yield _verdict(of, program, place, own[0], limit, samples)


def _verdict(
    of: Sampled, program: Program, place: int, found: Worst, stated: float | None, samples: int
) -> Verdict:
    seen = largest(found.errors)
    if stated is not None and seen > MORE * stated:
        each = at_rows(of, [found.rows], 0)
        seen = largest(at_samples(of, program, each)[place].largest())
    holds = stated is not None and stated <= ABSURD and seen <= MORE * stated
    says = f"{found.output}: largest {seen:.3g} u at {samples} fresh samples; "
    says += "no figure is stated" if stated is None else f"stated {stated:.2g} u"
    if stated is not None and not holds:
        limit = f"no more than {MORE * stated:.3g} u" if stated <= ABSURD else f"below {ABSURD:g} u"
        says += f", and it must be {limit}"
    scene = of.library.scene.name
    return Verdict(scene, program.name, of.precision.name, "stated error", JUDGED[holds], says)
