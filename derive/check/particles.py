"""The answers of a machine beside a cloud of particles that knows positions only."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from flint import arb, ctx
from mpmath import mp, mpf

from derive.check.verdict import JUDGED, Verdict
from derive.cloud import Answers, answers
from derive.cloud.series import DIGITS
from derive.cloud.small import at_rest, slopes
from derive.equations import equations
from derive.formula import symbols
from derive.largest import largest
from derive.library import Library
from derive.machine.mechanism import Mechanism
from derive.machine.words import MATRICES
from derive.reference import Known, reference
from derive.sample import Sample
from derive.scene import Machine
from derive.scene.machine import Result
from derive.scene.results import written_out

AGREE = mpf(10) ** -25
AGREE_QUATERNIONS = mpf(10) ** -13  # those of a sample have norm 1 only to double precision
AGREE_SLOPES = mpf(10) ** -12
PLAIN = (
    "kinetic_energy",
    "potential_energy",
    "energy",
    "angular_momentum_x",
    "angular_momentum_y",
    "angular_momentum_z",
)


def clouds(library: Library, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every function of a machine has the answers of its cloud of particles."""
    known = library.known
    if not isinstance(known, Mechanism):
        return
    for base, fact in library.truths.items():
        question = equations(known, fact)
        worst, count, limit = 0.0, 0, AGREE
        for sample in each:
            true = reference(question, sample.values, ())
            if base == "linearised" or fact.outputs[0].name in MATRICES:
                limit = AGREE_SLOPES
                gaps = _small(known.scene, sample, true)
            else:
                names = [c for q in fact.outputs for c in q.components]
                gaps = _gaps(known.scene, sample, names, true)
            if any(frame.quaternion for frame in known.scene.frames):
                limit = max(limit, AGREE_QUATERNIONS)
            worst, count = largest([worst, *gaps]), count + len(gaps)
        if not count:
            says = "the cloud has no such number at these points"
            yield Verdict(known.scene.name, base, "exact", "cloud of particles", "skipped", says)
            continue
        says = f"{count} numbers, {worst:.1g} apart, relative to the largest term"
        verdict = JUDGED[bool(worst < limit)]
        yield Verdict(known.scene.name, base, "exact", "cloud of particles", verdict, says)


def _gaps(
    machine: Machine, sample: Sample, names: Sequence[str], true: Mapping[str, Known]
) -> list[Any]:
    """Return how far each answer is from the cloud's, relative to the function's largest term."""
    cloud = answers(machine, sample.values)
    if machine.steady is not None and cloud.contradiction > AGREE:
        return []  # off the root the balances contradict each other, and each says something else
    found = [_of_cloud(machine, cloud, name) for name in names]
    with mp.workdps(DIGITS):
        scale = max([mpf(true[name].scale) for name in names] + [abs(x) for x in found if x] or [1])
        return [
            abs(digits(true[name].value) - value) / (scale or 1)
            for name, value in zip(names, found, strict=True)
            if value is not None
        ]


def _of_cloud(machine: Machine, cloud: Answers, name: str) -> Any:
    """Return an answer of the cloud, None if it has none."""
    if name in cloud.unknowns:
        return cloud.unknowns[name]
    if name in PLAIN:
        return cloud.momenta[name]
    result = next((r for r in machine.results if r.name == name), None)
    if result is None or _of_matrices(machine, result):
        return None
    return cloud.result(result.formula)


def _of_matrices(machine: Machine, result: Result) -> bool:
    return any(
        s.startswith(tuple(MATRICES)) for s in symbols(written_out(result.formula, machine.results))
    )


def digits(ball: Any) -> Any:
    """Return the middle of a ball with all the digits that are compared."""
    with ctx.workprec(400):
        man, exp = arb(ball).mid().man_exp()
    return mpf(int(man)) * mpf(2) ** int(exp)


def _small(machine: Machine, sample: Sample, true: Mapping[str, Known]) -> list[Any]:
    """Return how far M, D and K are from the slopes of the cloud's accelerations."""
    if not at_rest(machine, sample.values):
        return []  # the given motion is none, for these values
    by_velocity, by_place = slopes(machine, sample.values)
    size = by_velocity.rows
    with mp.workdps(DIGITS):
        M, D, K = (mp.matrix([[digits(true[f"{name}_{i + 1}_{k + 1}"].value) for k in range(size)]
                              for i in range(size)]) for name in MATRICES)  # fmt: skip
        gaps = []
        for left, right in ((D, by_velocity), (K, by_place)):
            gap, whole = M * right + left, max(mp.mnorm(left, 1), mp.mnorm(M * right, 1)) or mpf(1)
            gaps += [abs(x) / whole for x in gap]
        return gaps
