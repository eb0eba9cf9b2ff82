"""Energy beside power: along a motion, a machine's energy grows by what its loads put in.

Energy and rates are those of the scene's own programs, replayed in long floats; powers are those of
a cloud of particles. So what both the derivation and the cloud leave out of an energy is seen.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import arb, ctx
from mpmath import mp, mpf

from derive.check.particles import AGREE, digits
from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library, library
from derive.mechanics.mechanism import Mechanism
from derive.program.largest import largest
from derive.program.program import Program, component_names
from derive.program.run import run
from derive.scene import Machine, SceneError
from derive.scene.results import ENERGIES
from derive.verify.cloud import Answers, answers
from derive.verify.cloud.power import Powers, powers
from derive.verify.cloud.series import DIGITS
from derive.verify.convergence import unit_attitude
from derive.verify.operators import LONG_FLOATS
from derive.verify.sample import Sample

BITS = 600
STEP_BITS = 150  # a central difference leaves out the square of the step: 90 digits agree
RATES = "state_rate"


def energy_balance(made: Library, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every energy of a machine changes by the power of the loads that change it."""
    if not isinstance(made.known, Mechanism):
        return
    for program in made.functions:
        names = [n for n in component_names(program) if n in ENERGIES]
        if names and not program.sparsity:
            yield _verdict(made, program, names, each)


def _verdict(
    made: Library, program: Program, names: Sequence[str], each: Sequence[Sample]
) -> Verdict:
    scene, says = made.known.scene, "power balance"
    try:
        rates = rates_of(made)
    except SceneError as error:
        reason = f"no rates to move it by: {error}"
        return Verdict(scene.name, program.name, "exact", says, "skipped", reason)
    gaps = [gap for s in each for gap in power_gaps(made, rates, program, s)]
    if not gaps:
        reason = "the loads contradict each other at these points"
        return Verdict(scene.name, program.name, "exact", says, "skipped", reason)
    worst = largest(gaps)
    found = f"{len(gaps)} rates of {', '.join(names)}, {worst:.1g} apart, relative to the largest"
    outcome = JUDGED[bool(worst < AGREE)]
    return Verdict(scene.name, program.name, "exact", says, outcome, found)


def rates_of(made: Library) -> Library | None:
    """Return programs that give the rates of a machine's states; None if it has no state."""
    scene = made.known.scene
    if not made.known.words.states:
        return None
    if any(p.name == RATES for p in (*made.functions, *made.rates)):
        return made
    assert isinstance(scene, Machine)  # noqa: S101
    return library(replace(scene, wanted=(RATES,), asked={RATES: (RATES,)}))


def power_gaps(made: Library, rates: Library | None, program: Program, sample: Sample) -> list[Any]:
    """Return how far the rates of a program's energies are from powers, beside their terms."""
    scene = made.known.scene
    assert isinstance(scene, Machine)  # noqa: S101
    with ctx.workprec(BITS):
        at = unit_attitude(made, {c: arb(x) for c, x in sample.values.items()})
        with mp.workdps(DIGITS):
            cloud = answers(scene, {name: digits(x) for name, x in at.items()})
        if cloud.contradiction > AGREE:
            return []
        velocity = _velocities(cloud, at) | (_rates(rates, at) if rates is not None else {})
        found = _slopes(made, program, at, velocity)
    acting = powers(cloud)
    with mp.workdps(DIGITS):
        return [
            abs(digits(found[name]) - total) / size
            for name in component_names(program)
            if name in ENERGIES
            for total, size in (_expected(acting, name, found[name]),)
        ]


def _expected(acting: Powers, name: str, found: Any) -> tuple[Any, Any]:
    """Return the rate that an energy should have, and the largest term of it."""
    loads = () if name == "potential_energy" else acting.every
    weights = () if name == "kinetic_energy" else acting.conservative
    terms = [*loads, *(-p for p in weights)]
    size = max([abs(p) for p in terms] + [abs(digits(found))], default=mpf(0))
    return mp.fsum(terms), size or mpf(1)


def _velocities(cloud: Answers, at: Mapping[str, Any]) -> dict[str, Any]:
    """Return the given rates of what is prescribed, as the scene declares them."""
    with mp.workdps(DIGITS):
        scalars = cloud.history({}).scalars
        own = {name: scalars[name].velocity for name in at if name in scalars}
        return {name: arb(mp.nstr(v, DIGITS)) for name, v in own.items() if v}


def _rates(rates: Library, at: Mapping[str, Any]) -> dict[str, Any]:
    program = next(p for p in (*rates.functions, *rates.rates) if p.name == RATES)
    found = _results(rates, program, at)
    return {name.removesuffix("_rate"): value for name, value in found.items()}


def _slopes(
    made: Library, program: Program, at: Mapping[str, Any], velocity: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the rates of a program's results, by central differences along the motion."""
    h = arb(2) ** -STEP_BITS
    ahead, behind = (
        _results(made, program, {n: x + s * h * velocity.get(n, 0) for n, x in at.items()})
        for s in (1, -1)
    )
    return {name: (ahead[name] - behind[name]) / (2 * h) for name in ahead}


def _results(made: Library, program: Program, at: Mapping[str, Any]) -> dict[str, Any]:
    known = dict(at)
    for one in (made.setup, program):
        given = [known[c] for q in one.inputs for c in q.components]
        known |= dict(zip(component_names(one), run(one, LONG_FLOATS, given), strict=True))
    return {name: known[name] for name in component_names(program)}
