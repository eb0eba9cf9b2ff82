"""The answers of a scene beside a cloud of particles that knows positions only."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import arb, ctx
from mpmath import mp, mpf

from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library
from derive.program.largest import largest
from derive.scene import Input, Scene
from derive.scene.formula import symbols
from derive.scene.machine import Result
from derive.scene.results import MATRICES, written_out
from derive.scene.steady import steady_parts
from derive.verify.cloud import CloudAnswers, answers
from derive.verify.cloud.fulfilled import fulfilled
from derive.verify.cloud.series import DIGITS, ball_of
from derive.verify.cloud.small import is_at_rest, slopes_about_rest
from derive.verify.convergence import unit_attitude
from derive.verify.equations import Equations, equations_of, stated
from derive.verify.reference import BITS, reference
from derive.verify.sample import Sample
from derive.verify.solution import Solved

AGREE = mpf(10) ** -25
SECANTS = 60
SAME = 1e-60
"""Two guesses of a root that are one: half of the digits that it is computed in."""


def clouds(library: Library, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether every function of a scene has the answers of its cloud of particles."""
    scene = library.scene
    for base, equations in stated(library).items():
        outputs = library.problems[base].outputs
        names = [c for q in outputs for c in q.components]
        worst, count = 0.0, 0
        for values in _where_it_lasts(library, each):
            true = reference(equations, values, ())
            with mp.workdps(DIGITS):
                given = {name: digits(x) for name, x in values.items()}
            if base == "linearised" or outputs[0].name in MATRICES:
                gaps = _small(scene, given | _left_out(library, base), true)
            else:
                gaps = _gaps(scene.posed(base), given, base, {name: true[name] for name in names})
            worst, count = largest([worst, *gaps]), count + len(gaps)
        if not count:
            says = "the cloud has no such number at these points"
            yield Verdict(scene.name, base, "exact", "cloud of particles", "skipped", says)
            continue
        says = f"{count} numbers, {worst:.1g} apart, relative to the largest term"
        verdict = JUDGED[bool(worst < AGREE)]
        yield Verdict(scene.name, base, "exact", "cloud of particles", verdict, says)


def _where_it_lasts(library: Library, each: Sequence[Sample]) -> Iterator[dict[str, Any]]:
    """Yield the values of samples; of a steady motion at a root of its residual, if one is near.

    Off the root the balances contradict each other, and each says something else. Quaternions are
    brought to length 1, which floats have only to their own precision.
    """
    with ctx.workprec(BITS):
        balls = [unit_attitude(library, {c: arb(x) for c, x in s.values.items()}) for s in each]
    balls = [own for values in balls if (own := on_constraints(library.scene, values))]
    balanced = {name: own.unknown for name, own in library.scene.steady.items()
                if not own.vanishes and name in library.problems}  # fmt: skip
    if not balanced:
        yield from balls
    for name, unknown in [*balanced.items()][:1]:  # at whose root all others vanish, too
        equations = equations_of(library.mechanism, library.problems[name])
        for moving in balls if len(unknown) == 1 else ():
            values = moving | dict.fromkeys(_rates(library), arb(0))
            root = _root(equations, values, name, unknown[0])
            if root is not None:
                yield values | {unknown[0]: root}


def on_constraints(scene: Scene, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of a state nearby that fulfils the constraints, nothing if none was found."""
    if not scene.constraints:
        return dict(values)
    with mp.workdps(DIGITS):
        found = fulfilled(scene, {name: digits(x) for name, x in values.items()})
        with ctx.workprec(BITS):
            return {name: ball_of(x) for name, x in found.items()} if found else {}


def fulfilling(scene: Scene, each: Sequence[Sample]) -> Sequence[Sample]:
    """Return samples brought to states nearby that fulfil the constraints."""
    if not scene.constraints:
        return each
    with ctx.workprec(BITS):
        balls = [{name: arb(x) for name, x in s.values.items()} for s in each]
    pairs = [(s, on_constraints(scene, own)) for s, own in zip(each, balls, strict=True)]
    return [replace(s, values=own) for s, own in pairs if own]


def _rates(library: Library) -> list[str]:
    """Return the rates of a machine's free coordinates, which rest while motion is steady."""
    coordinates = library.scene.coordinates
    return [c.rate.name for c in coordinates if c.free and isinstance(c.rate, Input)]


def _root(equations: Equations, values: Mapping[str, Any], steady: str, name: str) -> Any:
    """Return where the only residual vanishes, to a part in 10^60, by secants; None if nowhere."""

    def residual(x: Any) -> Any:
        return reference(equations, {**values, name: x}, ())[steady].value.mid()

    with ctx.workprec(BITS):
        last, here = values[name], (values[name] * arb("1.01")).mid()
        before, now = residual(last), residual(here)
        for _ in range(SECANTS):
            if now == before or not here.is_finite():
                return None
            last, here = here, (here - now * (here - last) / (now - before)).mid()
            if abs(here - last) < abs(here) * SAME:
                return here
            before, now = now, residual(here)
    return None


def _gaps(
    scene: Scene, given: Mapping[str, Any], base: str, true: Mapping[str, Solved]
) -> list[Any]:
    """Return how far the answers in ``true`` are from the cloud's, relative to the largest term."""
    cloud = answers(scene, given)
    lasts = any(not own.vanishes for own in scene.steady.values())
    if base in scene.steady and not scene.steady[base].vanishes:
        return [cloud.contradiction]  # at a root, the particles are in balance
    if lasts and cloud.contradiction > AGREE:
        return []
    found = of_cloud(scene, cloud, base, list(true))
    with mp.workdps(DIGITS):
        terms = max(mpf(one.scale) for one in true.values())
        # without a term, answers are 0 whatever is given, and what the cloud leaves is rounding
        scale = max([terms, *(abs(x) for x in found.values() if x)]) if terms else mpf(1)
        return [
            abs(digits(true[name].value) - value) / scale
            for name, value in found.items()
            if value is not None
        ] + ([cloud.contradiction] if scene.constraints else [])


def of_cloud(
    scene: Scene, cloud: CloudAnswers, function: str, names: Sequence[str]
) -> dict[str, Any]:
    """Return the answers of a function that a cloud has, None for those that it has not."""
    if function == "state_rate":
        states = (c for g in scene.groups.states for c in g.components)
        return {rate: cloud.rate(state) for rate, state in zip(names, states, strict=True)}
    return {name: _of_cloud(scene, cloud, function, name) for name in names}


def _of_cloud(machine: Scene, cloud: CloudAnswers, function: str, name: str) -> Any:
    """Return an answer of the cloud, None if it has none."""
    if function in machine.steady and machine.steady[function].vanishes:
        steady = machine.steady[function]
        parts = steady_parts(function, len(steady.unknown))
        return cloud.result(steady.vanishes[parts.index(name)])
    if function == "angular_momentum_rate":
        return cloud.momentum_rate.get(name)
    if name in cloud.unknowns:
        return cloud.unknowns[name]
    if name in cloud.momenta:
        return cloud.momenta[name]
    result = next((r for r in machine.results if r.name == name), None)
    if result is None:
        return None
    if _of_matrices(machine, result):
        return _of_slopes(machine, cloud, result)
    return cloud.result(result.formula)


def _of_slopes(machine: Scene, cloud: CloudAnswers, result: Result) -> Any:
    """Return a result of the matrices of small motion, None if it rests on more than slopes.

    The cloud knows M^-1 D and M^-1 K only, so a result must be the same for any M: it is taken
    with M = 1 and with another, and both must say the same.
    """
    by_velocity, by_place = slopes_about_rest(machine, cloud.given)
    size = by_velocity.rows
    with mp.workdps(DIGITS):
        values = []
        for M in (mp.eye(size), mp.diag([k + 2 for k in range(size)]) + mp.ones(size)):
            each = dict(zip(MATRICES, (M, -M * by_velocity, -M * by_place), strict=True))
            entries = {
                f"{name}_{i + 1}_{k + 1}": matrix[i, k]
                for name, matrix in each.items()
                for i in range(size)
                for k in range(size)
            }
            values.append(cloud.result(result.formula, entries))
        first, second = values
        return first if abs(first - second) <= AGREE * abs(first) else None


def _of_matrices(machine: Scene, result: Result) -> bool:
    return any(
        s.startswith(tuple(MATRICES)) for s in symbols(written_out(result.formula, machine.results))
    )


def digits(ball: Any) -> Any:
    """Return the middle of a ball with all the digits that are compared."""
    with ctx.workprec(400):
        man, exp = arb(ball).mid().man_exp()
    return mpf(int(man)) * mpf(2) ** int(exp)


def _left_out(library: Library, function: str) -> dict[str, Any]:
    """Return 0 for each input of a scene that a function does not take: a motor's that holds it."""
    (program,) = [one for one in library.functions if one.name == function]
    taken = {c for q in program.inputs for c in q.components}
    return {one.name: mpf(0) for one in library.scene.inputs if one.name not in taken}


def _small(machine: Scene, given: Mapping[str, Any], true: Mapping[str, Solved]) -> list[Any]:
    """Return how far M, D and K are from the slopes of the cloud's accelerations."""
    if not is_at_rest(machine, given):
        return []  # the given motion is none, for these values
    by_velocity, by_place = slopes_about_rest(machine, given)
    size = by_velocity.rows
    with mp.workdps(DIGITS):
        M, D, K = (mp.matrix([[digits(true[f"{name}_{i + 1}_{k + 1}"].value) for k in range(size)]
                              for i in range(size)]) for name in MATRICES)  # fmt: skip
        gaps = []
        for left, right in ((D, by_velocity), (K, by_place)):
            gap, terms = M * right + left, mp.mnorm(left, 1)
            whole = max(terms, mp.mnorm(M * right, 1)) if terms else max(mpf(1), mp.mnorm(M, 1))
            gaps += [abs(x) / whole for x in gap]
        return gaps
