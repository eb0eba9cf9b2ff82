"""Laws that no derivation is needed for, checked on the emitted double C.

Power balance: the kinetic energy grows at the power of moments, forces and motors. Rotation of
axes: a body described along other axes fixed in it moves the same way.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import frexp, isfinite

from derive.check.emitted import Emitted
from derive.check.turning import Turning, turnings
from derive.check.verdict import JUDGED, Outcome, Verdict
from derive.mechanics.mechanism import single
from derive.mechanics.specialise import Specialised
from derive.program.added import added
from derive.program.largest import largest
from derive.program.program import Quantity
from derive.scene.formula import FLOATS, evaluate
from derive.scene.wanted import JACOBIAN
from derive.verify.sample import Sample, Values, varying

ROUNDING = 256 * 2.0**-53  # of the largest energy or power in the balance
TURNED = 1e-12  # of the largest value met: entering a turned tensor rounds it
RATES = {
    "position": "position_rate",
    "attitude": "attitude_rate",
    "velocity": "velocity_rate",
    "omega": "omega_dot",
    "wheel_speeds": "wheel_accelerations",
}


def power_balance(emitted: Emitted, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether dT/dt is the power put in, from the emitted functions alone."""
    reason = _no_balance(emitted)
    if reason:
        yield _verdict(emitted, "kinetic_energy", "power balance", "skipped", reason)
        return
    gaps = [_power_gap(emitted, s) for s in each]
    worst = largest(gaps)
    says = f"{len(each)} samples, largest gap {worst:.2g} of what rounding allows"
    yield _verdict(emitted, "kinetic_energy", "power balance", JUDGED[worst <= 1], says)


def _no_balance(emitted: Emitted) -> str:
    known = single(emitted.library.known)
    if "kinetic_energy" not in emitted.functions:
        return "the scene does not ask for the kinetic energy"
    if not _forward(emitted):
        return "the scene does not ask for a forward function"
    moved = {known.words.symbols[c] for q in varying(known) for c in q.components}
    if known.motion.tensor.free_symbols & moved:
        return "the energy is not quadratic in the motion: the tensor turns in these axes"
    if known.scene.position is not None and not known.scene.axes.quaternion:
        return "the force is not turned by a quaternion"
    return ""


def _forward(emitted: Emitted) -> list[str]:
    """Return the emitted functions that find the acceleration, those with a Jacobian too."""
    every = (n + more for n in ("state_rate", "acceleration") for more in ("", JACOBIAN))
    return [name for name in every if name in emitted.functions]


def _power_gap(emitted: Emitted, sample: Sample) -> float:
    """Return the gap in the power balance over what rounding may make of it.

    The energy is quadratic in the velocities, so a central difference along their rates is exact.
    """
    rates = _rates(emitted, sample)
    moving = emitted.library["kinetic_energy"].inputs
    names = [c for q in moving if q.role != "constants" for c in q.components]
    fastest = max((abs(sample.values[c]) for c in names), default=0.0)
    step = 2.0 ** (frexp(fastest)[1] - frexp(max(abs(rates[c]) for c in names))[1])
    ahead, behind = (
        _energy(emitted, sample, {c: sample.values[c] + h * rates[c] for c in names})
        for h in (step, -step)
    )
    powers = _powers(single(emitted.library.known), sample.values)
    allowed = ROUNDING * ((abs(ahead) + abs(behind)) / (2 * step) + added(map(abs, powers)))
    gap = abs((ahead - behind) / (2 * step) - added(powers))
    return gap / allowed if allowed else 0.0


def _energy(emitted: Emitted, sample: Sample, moved: Values) -> float:
    program = emitted.library["kinetic_energy"]
    there = Sample(sample.number, sample.kind, sample.values | moved)
    return emitted.results(program, there)[0]


def _rates(emitted: Emitted, sample: Sample) -> dict[str, float]:
    """Return the rate of every state's component, from the forward function."""
    program, words = emitted.library[_forward(emitted)[0]], emitted.library.known.words
    components = [c for q in program.outputs for c in q.components]
    found = dict(zip(components, emitted.results(program, sample), strict=True))
    pairs = [(q, words[RATES[q.name]]) for q in words.states if q.name in RATES]
    return {
        state: found[rate]
        for q, r in pairs
        for state, rate in zip(q.components, r.components, strict=True)
        if rate in found
    }


def _powers(known: Specialised, values: Values) -> list[float]:
    """Return the powers of the moment, the motors and the force, term by term."""
    numbers = values | {n: float(x) for n, x in known.words.numbers.items()}
    moment = _known(known, numbers, "moment")
    omega = [values[c] for c in known.words["omega"].components]
    powers = [m * w for m, w in zip(moment, omega, strict=True)]
    powers += [values[w.torque.name] * values[w.speed.name] for w in known.scene.wheels]
    if known.scene.position is not None:
        force = _known(known, numbers, "force")
        velocity = [values[c] for c in known.words["velocity"].components]
        turned = _turned([values[c] for c in known.words["attitude"].components], force)
        powers += [f * v for f, v in zip(turned, velocity, strict=True)]
    return powers


def _known(known: Specialised, numbers: Mapping[str, float], name: str) -> list[float]:
    """Return a known moment or force along the axes, as the scene has it."""
    given = known.scene.known[name].formulas
    if given is None:
        return [numbers[c] for c in known.words[name].components]
    return [evaluate(f, numbers, FLOATS) for f in given]


def _turned(q: Sequence[float], v: Sequence[float]) -> list[float]:
    """Return v turned by a unit quaternion, by its matrix."""
    w, x, y, z = q
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return [added(r * a for r, a in zip(row, v, strict=True)) for row in rows]


@dataclass(frozen=True)
class _Compared:
    """A component of an output along the turned axes: as computed, and as it should be."""

    name: str
    found: float
    should: float


def turned_axes(emitted: Emitted, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every function commutes with a turn of the axes, and with x -> y -> z -> x."""
    for check, turning, reason in turnings(single(emitted.library.known)):
        if turning is None:
            yield _verdict(emitted, "all", check, "skipped", reason)
            continue
        for program in emitted.library.functions:
            if program.sparsity:
                continue
            rows = [_compared(emitted, turning, program.name, s) for s in each]
            yield _turn_verdict(emitted, program.name, check, rows)


def _compared(emitted: Emitted, turning: Turning, function: str, sample: Sample) -> list[_Compared]:
    program = emitted.library[function]
    moved = Sample(sample.number, sample.kind, turning.turned(sample.values))
    outputs: list[Quantity] = [q for q in program.outputs if turning.turns(q)]
    names = [c for q in program.outputs for c in q.components]
    before = dict(zip(names, emitted.results(program, sample), strict=True))
    after = dict(zip(names, emitted.results(program, moved), strict=True))
    should = {c: x for q in outputs for c, x in turning.quantity(q, before).items()}
    return [_Compared(c, after[c], x) for c, x in should.items()]


def _turn_verdict(
    emitted: Emitted, function: str, check: str, rows: Sequence[Sequence[_Compared]]
) -> Verdict:
    every = [c for row in rows for c in row]
    if not every:
        says = "nothing that it returns is known to turn with the axes"
        return _verdict(emitted, function, check, "skipped", says)
    most = largest(abs(c.should) for c in every)
    gap = largest(abs(c.found - c.should) for c in every)
    says = f"{len(rows)} samples, largest gap {gap / (most or 1):.2g} of the largest value"
    holds = isfinite(most) and gap <= TURNED * most
    return _verdict(emitted, function, check, JUDGED[holds], says)


def _verdict(emitted: Emitted, function: str, check: str, outcome: Outcome, says: str) -> Verdict:
    scene = emitted.library.known.scene.name
    return Verdict(scene, function, emitted.precision.name, check, outcome, says)
