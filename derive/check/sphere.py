"""Bodies that are nearly spheres, left to themselves: what is left of their moments' differences.

I_yy - I_zz is made once, in pairs of floats. Whoever forms I_yy omega_y omega_z and
I_zz omega_z omega_y apart in every call loses it, by no more than a few units of these products.
So errors are counted here by the difference.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from statistics import median

from derive.check.agreement import LARGEST_BOUND
from derive.check.emitted import Emitted, errors_of, verdict
from derive.check.verdict import JUDGED, Verdict
from derive.program.largest import largest
from derive.verify.draw import Sampled
from derive.verify.measure import should
from derive.verify.reference import DIFFERENCES
from derive.verify.sample import Sample

KIND = "near sphere"


def near_a_sphere(one: Emitted, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every function keeps the digits of differences of nearly equal moments."""
    own = [_left_alone(one, s) for s in each if s.kind.endswith(KIND)]
    if not own:
        return
    of = Sampled(one.library, one.precision)
    for program, true in should(of, one.library.functions, own, DIFFERENCES):
        for found in errors_of(one, program, own, true):
            each_worst = [largest([median(column)]) for column in zip(*found.rows, strict=True)]
            most = max(each_worst, default=0.0)
            says = f"{found.output}: median of a component at most {most:.2g} u of the differences"
            says += f" at {len(own)} samples; allowed {LARGEST_BOUND:g} u"
            holds = JUDGED[most <= LARGEST_BOUND]
            yield verdict(one, program.name, "near a sphere", holds, says)


def _left_alone(one: Emitted, sample: Sample) -> Sample:
    """Return a sample on which nothing acts from outside."""
    acts = {c: 0.0 for q in one.library.vocabulary.inputs for c in q.components}
    return replace(sample, values=sample.values | acts)
