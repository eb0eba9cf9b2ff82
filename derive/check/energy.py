"""Energy beside power: along a motion, a machine's energy grows by what its loads put in.

Energy and rates are those of the scene's own programs, replayed in long floats, and rates once more
those of the emitted C; powers are those of a cloud of particles. So what both the derivation and
the cloud leave out of an energy is seen, and what C leaves out of a rate.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import arb, ctx
from mpmath import mp, mpf

from derive.check.emitted import Emitted
from derive.check.particles import AGREE, digits, fulfilling
from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library, library
from derive.program.largest import largest
from derive.program.program import Program, component_names
from derive.scene import Input, SceneError
from derive.scene.results import ENERGIES
from derive.verify.cloud import CloudAnswers, answers
from derive.verify.cloud.power import Powers, powers
from derive.verify.cloud.series import DIGITS
from derive.verify.convergence import unit_attitude
from derive.verify.measure import results
from derive.verify.sample import Sample
from derive.verify.scale import base_of

BITS = 600
STEP_BITS = 150  # a central difference leaves out the square of the step: 90 digits agree
RATE_FUNCTION, KINETIC = "state_rate", "kinetic_energy"
NOTHING = mpf(10) ** -20
"""Of the energy: rates so small are what a difference leaves of an energy that does not change."""
ROUNDED = 2.0**-40
"""Of the largest term: C's rates are right to a few roundings of theirs, which may be larger."""
FindRates = Callable[[Sample, Mapping[str, Any]], Mapping[str, Any]]


def energy_balance(made: Library, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every energy of a machine changes by the power of the loads that change it.

    A scene that wants none has its kinetic energy derived for this.
    """
    try:
        told = _with_energy(made)
    except SceneError as error:
        yield Verdict(made.scene.name, "all", "exact", "power balance", "skipped", str(error))
        return
    for program, names in _energies(told):
        row = (made.scene.name, program.name, "exact", "power balance")
        try:
            rates = rates_of(told)
        except SceneError as error:
            yield Verdict(*row, "skipped", f"no rates to move it by: {error}")
            continue
        gaps = _gaps(told, _exactly(rates), program, fulfilling(made.scene, each))
        yield _verdict(row, names, gaps, float(AGREE))


def emitted_balance(one: Emitted, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every energy changes by these powers along the rates that C gives."""
    made = one.library
    forward = [
        f for f in made.functions if base_of(f) == RATE_FUNCTION or _finds_accelerations(made, f)
    ]
    if not forward:
        says = "no function that is wanted finds accelerations"
        row = (made.scene.name, "all", one.precision.name, "power balance")
        yield Verdict(*row, "skipped", says)
        return
    try:
        told = _with_energy(made)
    except SceneError:
        return  # said of the exact balance
    if made.mechanism.redundant:
        row = (made.scene.name, "all", one.precision.name, "power balance")
        yield Verdict(*row, "skipped", "floats fulfil redundant constraints to a rounding only")
        return
    for program, names in _energies(told):
        row = (made.scene.name, program.name, one.precision.name, "power balance")
        rates = _emitted(one, forward[0], _exactly(rates_of(told)))
        yield _verdict(row, names, _gaps(told, rates, program, each), ROUNDED)


def _finds_accelerations(made: Library, program: Program) -> bool:
    return bool(_highest(made).keys() & {*component_names(program)})


def _highest(made: Library) -> dict[str, str]:
    """Return of which quantity each acceleration that may be found is the rate."""
    scene = made.scene
    return {
        m.unknown: m.rate.name if isinstance(m.rate, Input) else m.name
        for m in (*scene.coordinates, *scene.speeds)
    }


def _with_energy(made: Library) -> Library:
    """Return a library in which an energy is wanted: its own if one is, else another."""
    if any(_energies(made)):
        return made
    return library(replace(made.scene, wanted=(KINETIC,), asked={KINETIC: (KINETIC,)}))


def _energies(made: Library) -> Iterator[tuple[Program, list[str]]]:
    for program in made.functions:
        names = [n for n in component_names(program) if n in ENERGIES]
        if names and not program.sparsity:
            yield program, names


def _gaps(made: Library, rates: FindRates, program: Program, each: Sequence[Sample]) -> list[Any]:
    return [gap for s in each for gap in power_gaps(made, rates, program, s)]


def _verdict(
    row: tuple[str, str, str, str], names: Sequence[str], gaps: Sequence[Any], allowed: float
) -> Verdict:
    if not gaps:
        return Verdict(*row, "skipped", "the loads contradict each other at these points")
    worst = largest(gaps)
    found = f"{len(gaps)} rates of {', '.join(names)}, {worst:.1g} apart, relative to the largest"
    return Verdict(*row, JUDGED[bool(worst < allowed)], found)


def rates_of(made: Library) -> Library | None:
    """Return programs that give the rates of a machine's states; None if it has no state."""
    scene = made.scene
    if not made.vocabulary.states:
        return None
    if any(p.name == RATE_FUNCTION for p in (*made.functions, *made.rates)):
        return made
    return library(replace(scene, wanted=(RATE_FUNCTION,), asked={RATE_FUNCTION: (RATE_FUNCTION,)}))


def _exactly(rates: Library | None) -> FindRates:
    """Return the rates of the state as programs give them in long floats."""
    if rates is None:
        return lambda _, __: {}
    program = next(p for p in (*rates.functions, *rates.rates) if base_of(p) == RATE_FUNCTION)
    states = [c for q in rates.vocabulary.states for c in q.components]
    return lambda _, at: dict(zip(states, results(rates, program, at).values(), strict=False))


def _emitted(one: Emitted, program: Program, others: FindRates) -> FindRates:
    """Return the rates that a function of C gives at a sample, and what others give besides."""
    highest = _highest(one.library)
    states = [c for q in one.library.vocabulary.states for c in q.components]

    def rates(sample: Sample, at: Mapping[str, Any]) -> Mapping[str, Any]:
        names, found = component_names(program), map(arb, one.results(program, sample))
        if base_of(program) == RATE_FUNCTION:
            return dict(zip(states, found, strict=False))
        own = dict(zip(names, found, strict=True))
        return {**others(sample, at), **{highest[n]: x for n, x in own.items() if n in highest}}

    return rates


def power_gaps(made: Library, rates: FindRates, program: Program, sample: Sample) -> list[Any]:
    """Return how far the rates of a program's energies are from powers, beside their terms."""
    with ctx.workprec(BITS):
        at = unit_attitude(made, {c: arb(x) for c, x in sample.values.items()})
        cloud = _in_balance(made, program, at)
        if cloud is None:
            return []
        velocity = _velocities(cloud, at)
        if cloud.machine is made.scene:
            velocity |= rates(sample, at)
        if not all(arb(v).is_finite() for v in velocity.values()):
            return [mpf("inf")]
        found = _slopes(made, program, at, velocity)
        energies = results(made, program, at)
    acting = powers(cloud)
    with mp.workdps(DIGITS):
        size = {n: abs(digits(x)) * NOTHING for n, x in energies.items() if n in ENERGIES}
        return [
            abs(mp.fsum(terms)) / (max(*map(abs, terms), size[name]) or 1)
            for name in size
            for terms in ([*_negative(acting, name), *map(digits, found[name])],)
        ]


def _in_balance(made: Library, program: Program, at: Mapping[str, Any]) -> CloudAnswers | None:
    """Return a cloud whose loads and motion do not contradict each other, None if none is so.

    Where the motion is prescribed, loads that are known too cannot hold: those it needs do.
    """
    for machine in (made.scene, made.scene.posed(base_of(program))):
        with mp.workdps(DIGITS):
            cloud = answers(machine, {name: digits(x) for name, x in at.items()})
        if cloud.contradiction <= AGREE:
            return cloud
    return None


def _negative(acting: Powers, name: str) -> list[Any]:
    """Return the terms of the rate that an energy should have, all with the other sign."""
    loads = () if name == "potential_energy" else acting.every
    weights = () if name == "kinetic_energy" else acting.conservative
    return [mpf(0), *(-p for p in loads), *weights]


def _velocities(cloud: CloudAnswers, at: Mapping[str, Any]) -> dict[str, Any]:
    """Return the given rates of what is prescribed, as the scene declares them."""
    with mp.workdps(DIGITS):
        scalars = cloud.history({}).scalars
        own = {name: scalars[name].velocity for name in at if name in scalars}
        return {name: arb(mp.nstr(v, DIGITS)) for name, v in own.items() if v}


def _slopes(
    made: Library, program: Program, at: Mapping[str, Any], velocity: Mapping[str, Any]
) -> dict[str, list[Any]]:
    """Return the rates of a program's results, a term for each of what moves.

    They are central differences along the motion of one quantity at a time.
    """
    h = arb(2) ** -STEP_BITS
    terms: dict[str, list[Any]] = {name: [] for name in component_names(program)}
    for moving, v in velocity.items():
        if moving in at:
            ahead, behind = (
                results(made, program, {**at, moving: at[moving] + s * h * v}) for s in (1, -1)
            )
            for name, own in terms.items():
                own.append((ahead[name] - behind[name]) / (2 * h))
    return terms
