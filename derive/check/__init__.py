"""Emitted files in, rows of evidence out: everything that is checked of a scene.

C is compiled with warnings as errors, loaded, and compared with its programs, with CasADi, with
the reference, and with laws of mechanics. Nothing is left out silently: a check that is not made
is a row that says why.
"""

import shlex
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from derive.check.agreement import (
    accuracy,
    aliasing,
    casadi_bits,
    dense_agrees,
    replay,
)
from derive.check.attitudes import attitude_definitions
from derive.check.compiler import Compiler, CompilerError, find_compiler
from derive.check.derivatives import derivatives
from derive.check.emitted import (
    Emitted,
    Files,
    casadi_module,
    files,
    is_double,
    loaded,
    sampling_of,
    verdict,
)
from derive.check.energy import emitted_balance, energy_balance
from derive.check.external import compiled_steps
from derive.check.fresh import fresh
from derive.check.inlined import inlined
from derive.check.motion import orders_hold, step_slopes_hold
from derive.check.particles import clouds
from derive.check.refusals import casadi_status, refuses_alike
from derive.check.sphere import near_a_sphere
from derive.check.turned import turned_axes
from derive.check.verdict import JUDGED, Verdict
from derive.library.library import Library
from derive.scene.escape import visible
from derive.verify.draw import Sampled, with_motion
from derive.verify.kept import stated_figures
from derive.verify.prove import ProofError, prove
from derive.verify.sample import Sample, samples
from derive.verify.scale import with_values
from derive.verify.search import SAMPLING

ORDINARY, CORNERS, FEW, TWO = 300, 6, 8, 2
REASONS = {
    "large spin": "nothing that varies is in rad/s",
    "denormal": "parts of steps fall below the smallest float",
    "half turn": "no quaternion enters",
    "gimbal": "no coordinate enters by itself",
}
"""Why a kind of samples is not drawn."""
NO_PARAMETERS = "none with values was found"


def check(
    made: Library, source: str, folder: Path, samples: int, told: Callable[[str], None]
) -> Iterator[Verdict]:
    """Yield verdicts on a scene's files, made anew; what lies below ``folder`` must be the same.

    Nothing that lies there is run.

    source  : what the user named the scene by, for the command that makes its files
    samples : fresh ones that stated errors are tried at       told : hears how far that is
    Raises CompilerError if there is no C compiler.
    """
    with_ = find_compiler()
    with TemporaryDirectory(prefix="derive-") as workshop:
        found = files(made, folder, sampling_of(folder, made.scene.name))
        yield as_made(made, found, source)
        yield from check_library(made, found, Path(workshop), with_, ORDINARY)
        yield from fresh(made, stated_figures(found.manifest), samples, told)


def check_library(
    made: Library, found: Files, workshop: Path, with_: Compiler, ordinary: int
) -> Iterator[Verdict]:
    """Yield the verdicts on one scene's files, at so many ordinary samples and the corners."""
    yield proof(made)
    described = interface(made, found)
    yield described
    if described.outcome == "FAILS":
        return
    emitted = loaded(made, found, workshop, with_)
    try:
        for one in emitted:
            says = f"{with_.name}, {found.origin}"
            yield verdict(one, "all", "compiles without warnings", "holds", says)
            yield from _checks(one, found, workshop, ordinary)
    except CompilerError as error:
        name = made.scene.name
        yield Verdict(name, "all", "", "compiles without warnings", "FAILS", str(error))


def as_made(made: Library, found: Files, source: str) -> Verdict:
    """Return whether the files that lie there are what the scene makes.

    source : what the user named the scene by, for the command that makes them
    """
    name, check_ = made.scene.name, "lies as it is made"
    if found.origin == "made in memory":
        return Verdict(name, "all", "", check_, "skipped", "no files of the scene lie there")
    few = ["--samples", str(found.samples)] if found.samples != SAMPLING.samples else []
    few += [f"--{part}" for part in found.parts]
    says = " ".join([f"{found.origin}: as made", *(["by", *few] if few else [])])
    if wrong := (*found.differ, *found.left):
        again = ["derive", "generate", source, *few]
        each = [again] if found.differ else []
        each += [["rm", *found.left]] if found.left else []
        commands = " and ".join(f"`{visible(shlex.join(command))}`" for command in each)
        says = f"not as made: {', '.join(wrong)}; run {commands}"
    return Verdict(name, "all", "", check_, JUDGED[not wrong], says)


def proof(made: Library) -> Verdict:
    """Return whether the programs satisfy the lecture's equations exactly."""
    name = made.scene.name
    if not made.functions:
        says = "nothing is wanted that the lecture's equations state: motions are measured"
        return Verdict(name, "all", "exact", "satisfies the lecture", "skipped", says)
    try:
        prove(made)
    except ProofError as error:
        return Verdict(name, "all", "exact", "satisfies the lecture", "FAILS", str(error))
    says = f"{len(made.functions)} functions, at random exact points"
    return Verdict(name, "all", "exact", "satisfies the lecture", "holds", says)


def interface(made: Library, found: Files) -> Verdict:
    """Return whether the JSON describes the functions that the scene asks for."""
    name, says = made.scene.name, ""
    described = {f["name"]: f["arguments"] for f in found.manifest["functions"]}
    programs = made.emitted()
    for program in programs:
        every = (*program.inputs, *program.outputs)
        meant = {q.name: list(q.components) for q in every if q.role != "constants"}
        given = {a["name"]: a["components"] for a in described.get(program.name, ())}
        given.pop("constants", None)
        if meant != given:
            says = f"{program.name}: not as in the JSON"
    outcome = JUDGED[not says]
    says = says or f"{len(described)} functions"
    return Verdict(name, "all", "", "describes the scene's functions", outcome, says)


def _checks(one: Emitted, found: Files, workshop: Path, ordinary: int) -> Iterator[Verdict]:
    drawn = samples(one.library.mechanism, one.precision, ordinary, CORNERS)
    drawn = with_values(Sampled(one.library, one.precision), drawn)
    each = with_motion(one.library, drawn.each, one.precision)
    few = spread(each)
    printed = {f["name"]: f.get("error", {}) for f in found.manifest["functions"]}
    stated = {n: e for n, e in printed.items() if isinstance(e, dict)}
    yield from accuracy(one, each, few, stated)
    yield from near_a_sphere(one, each)
    yield from attitude_definitions(one)
    yield from replay(one, each)
    yield from dense_agrees(one, few)
    yield from aliasing(one, few)
    yield refuses_alike(one, few)
    if is_double(one):
        yield from orders_hold(one.library, each)
        yield from step_slopes_hold(one.library, each)
        module = casadi_module(one.library, found, workshop)
        yield from casadi_bits(one, module, each)
        yield from inlined(one.library, module, each)
        yield from derivatives(one.library, module, each)
        if one.library.constants:
            yield casadi_status(one, module)
        if f"{one.library.scene.name}_external.c" in found.texts:
            at = (workshop, find_compiler())
            yield compiled_steps(one.library, found, module, each, at)
        plain = [s for s in each if s.kind == "ordinary"][: FEW * FEW]
        yield from clouds(one.library, plain[:FEW])
        yield from energy_balance(one.library, plain[:TWO])
        yield from emitted_balance(one, plain[:TWO])
        yield from turned_axes(one, few, stated)
    if drawn.skipped:
        yield verdict(one, "all", "hard corners", "skipped", not_drawn(drawn.skipped))


def not_drawn(kinds: Sequence[str]) -> str:
    """Return a sentence on kinds of samples that are not tried, with the reason of each."""
    each = "; ".join(f"{kind} ({REASONS.get(kind, NO_PARAMETERS)})" for kind in kinds)
    count = "1 kind is" if len(kinds) == 1 else f"{len(kinds)} kinds are"
    return f"{count} not tried: {each}"


def spread(each: Sequence[Sample]) -> tuple[Sample, ...]:
    """Return the first samples of every kind, a few of them ordinary."""
    by_kind: dict[str, list[Sample]] = {}
    for s in each:
        by_kind.setdefault(s.kind, []).append(s)
    firsts = [own[: FEW if kind == "ordinary" else 1] for kind, own in by_kind.items()]
    return tuple(s for own in firsts for s in own)
