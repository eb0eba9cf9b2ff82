"""The scene file of a machine: its tables read into declarations, each by one function."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any

from derive.scene.bodies import read_member
from derive.scene.constraint import distances
from derive.scene.constraints import read_constraints, with_dependent
from derive.scene.declaration import Input, SceneError
from derive.scene.demands import of_bodies
from derive.scene.doubtful import doubts, require_sizes
from derive.scene.entries import COLUMN, FILE, MOMENTUM, TIME, TIME_STEP
from derive.scene.entry import REQUIRED, Entry, Reading, entries_of
from derive.scene.formula import ZERO, Formula, symbols
from derive.scene.frames import read_frames
from derive.scene.groups import grouped
from derive.scene.loads import read_loads
from derive.scene.machine import Frame, Member, Place, Result, Scene, Steady, Unknown
from derive.scene.named import check_named, named_told, named_unused, widened
from derive.scene.names import distinct, label
from derive.scene.numbers import member_doubts
from derive.scene.results import (
    matrix_entries,
    read_asked,
    read_results,
    unknown_vectors,
)
from derive.scene.safe import require_values
from derive.scene.said import said
from derive.scene.scalars import PER_SECOND, Scalars, read_scalars
from derive.scene.scope import Scope, formula
from derive.scene.steady import read_steady, steady_names
from derive.scene.table import THE_FILE, Table, keys, table
from derive.scene.unit import dimension, misnamed
from derive.scene.wanted import check_form, moves
from derive.scene.welds import welded


@dataclass(frozen=True)
class Form:
    """Tables of a form, first the one it needs; of the other, and why not; entries of [motion]."""

    tables: tuple[str, ...]
    foreign: tuple[str, ...]
    rule: str
    motion: tuple[Entry, ...]


SCALARS = ("parameters", "coordinates", "speeds", "inputs", "formulas", "motion")
MACHINE = Form(
    (
        "bodies",
        "frames",
        "loads",
        "constraints",
        "results",
        "angular_momentum",
        "linearised",
        "steady",
        *SCALARS,
    ),
    ("body", "axes", "wheels", "point", "known", "position"),
    "is for a single body; with bodies and frames, use bodies, frames and loads",
    (TIME_STEP, COLUMN),
)


def read_file(
    document: dict[str, Any], name: str, source: str, form: Form
) -> tuple[dict[str, Any], Mapping[str, Table]]:
    """Return what a scene is called and how it is made, and its tables, empty where it has none."""
    for key in form.foreign:
        if key in document:
            raise SceneError(f"table '{key}' {form.rule}")
    if "wanted" not in document:
        near = get_close_matches("wanted", document, 1)
        hint = f" (is it meant by '{near[0]}'?)" if near else ""
        raise SceneError(f"the file needs 'wanted', above its first [table]{hint}")
    rows = [Entry(key, "any", "", default={}) for key in form.tables]
    rows[0] = replace(rows[0], default=REQUIRED)
    said = entries_of(Table(THE_FILE, document), (*FILE, *rows), Reading())
    own = {key: said.pop(key) for key in form.tables}
    part = {key: table(value, key) for key, value in own.items() if key != "wheels"}
    times = entries_of(Table("motion", {}), (TIME_STEP, TIME, COLUMN), Reading())
    times |= entries_of(part["motion"], form.motion, Reading())
    head = {"name": name, "text": source, **said, **times}
    head |= {"title": said["title"] or name, "source": said["source"] or ""}
    return head, part


def read_machine(document: dict[str, Any], name: str, source: str) -> Scene:
    """Return the machine of a parsed TOML document, checked table by table."""
    head, part = read_file(document, name, source, MACHINE)
    scalars = with_dependent(part["constraints"], read_scalars(part))
    check_named(scalars.named, scalars.known)
    frames = read_frames(part["frames"], scalars, tuple(part["bodies"].entries))
    bodies = _bodies(part["bodies"], frames, scalars)
    loads, unknowns = read_loads(part["loads"], scalars, frames, bodies)
    held = read_constraints(part["constraints"], scalars, frames, bodies, (loads, unknowns))
    constraints, loads, unknowns = held
    results = read_results(part["results"], scalars, unknowns)
    distinct(_declared(scalars, unknowns, results))
    lasting = steady_names(part["steady"])
    asked = read_asked(head.pop("wanted"), scalars, unknowns, results, lasting,
                       constraints)  # fmt: skip
    distinct([*_declared(scalars, (), ()), *_vectors(unknowns, asked)])
    steady = read_steady(part["steady"], scalars, unknowns, results, asked)
    welds, hidden = welded(bodies, loads, unknowns, scalars.parameters)
    made = _made(scalars, frames, results, asked, steady)
    zeros = ((name, f"what is 0 by {says}") for name, says in distances(constraints))
    distinct([*_declared(scalars, unknowns, results), *made, *zeros])
    scene = Scene(
        **head, parameters=scalars.parameters, coordinates=scalars.coordinates,
        speeds=scalars.speeds, inputs=scalars.inputs,
        frames=frames, bodies=bodies, loads=(*loads, *welds), unknowns=(*unknowns, *hidden),
        results=results,
        momentum=_momentum(part["angular_momentum"], frames, bodies, scalars),
        about=_about(part["linearised"], scalars),
        steady=steady, asked=asked, wanted=tuple(asked), demands=of_bodies(bodies),
        constraints=constraints,
        warnings=(*_unused(scalars, source), *_doubts(bodies, scalars),
                  *_misnamed(scalars, results)),
    )  # fmt: skip
    require_sizes(scene)
    check_form(scene.wanted, scene.form, scene.emission)
    require_values(scene)
    told = (*said(scene), *named_told(scalars.named))
    return grouped(replace(scene, warnings=(*scene.warnings, *doubts(scene)), told=told))


def _misnamed(scalars: Scalars, results: tuple[Result, ...]) -> list[str]:
    """Return doubts about names that end in a unit which is not theirs."""
    named = [(q.name, q.unit) for q in scalars.parameters]
    named += [(q.name, q.unit) for q in scalars.moving]
    named += [(q.name, q.unit) for q in results]
    return [doubt for name, unit in named if (doubt := misnamed(name, unit))]


def _bodies(given: Table, frames: tuple[Frame, ...], scalars: Scalars) -> tuple[Member, ...]:
    if not given.entries:
        raise SceneError("bodies must hold at least one body")
    return tuple(
        read_member(label(name, "a body"), table(value, f"body '{name}'"), frames, scalars)
        for name, value in given.entries.items()
    )


def _declared(
    scalars: Scalars, unknowns: tuple[Unknown, ...], results: tuple[Result, ...]
) -> list[tuple[str, str]]:
    """List every name of the scene with what it is, derived ones included."""
    found = [*scalars.declared, *((u.name, f"the unknown '{u.name}'") for u in unknowns)]
    return found + [(r.name, f"the result '{r.name}'") for r in results]


def _vectors(
    unknowns: tuple[Unknown, ...], asked: Mapping[str, tuple[str, ...]]
) -> Iterator[tuple[str, str]]:
    """Yield the vectors of unknowns that are wanted, with what each is."""
    answers = {name for each in asked.values() for name in each}
    for name in unknown_vectors(unknowns):
        if name in answers:
            yield name, f"the vector of the unknowns '{name}_x' to '{name}_z'"


def _made(
    scalars: Scalars,
    frames: tuple[Frame, ...],
    results: tuple[Result, ...],
    asked: Mapping[str, tuple[str, ...]],
    steady: Mapping[str, Steady],
) -> Iterator[tuple[str, str]]:
    """Yield the quantities that functions have by themselves, with what each is."""
    answers = {name for each in asked.values() for name in each}
    moved = [m for m in scalars.moving if m.state]
    parts = [(m, name) for m in moved for name in (m.name, *(rate.name for rate in m.given))]
    states = [name for m, own in parts for name in (own, m.of_vector(own))]
    for frame in frames:
        if frame.attitude:
            own = [f"{frame.attitude}{part}" for part in ("", "_w", "_x", "_y", "_z")]
            yield from ((name, f"the attitude of frame '{frame.name}'") for name in own)
            states += own
    steps = any(map(moves, answers))
    for state in dict.fromkeys(states):
        if steps or "state_rate" in answers:
            yield f"{state}_rate", f"the rate of the state '{state}'"
        if steps:
            yield f"{state}_next", f"the next value of the state '{state}'"
    used = {name for result in results for name in symbols(result.formula)}
    for name in matrix_entries(scalars):
        if "linearised" in answers or name in used:
            yield name, "an entry of a matrix of small motion"
    for name in sorted(answers & steady.keys()):
        yield from ((f"{name}_{n + 1}", "what vanishes") for n in range(len(steady[name].unknown)))
        if name != "steady":
            yield name, f"what vanishes in steady.{name.removeprefix('steady_')}"


def _unused(scalars: Scalars, source: str) -> tuple[str, ...]:
    """Return a sentence for every scalar whose name, or rate, the file never mentions again."""
    words = Counter(re.findall(r"[A-Za-z][A-Za-z0-9_]*", source))
    entries = [(f"parameter '{p.name}' is not used", p.name, 1) for p in scalars.parameters]
    entries += [(f"no formula uses {m.kind} '{m.name}'", m.name, 0 if m.vector else 1)
                for m in scalars.moving]  # fmt: skip
    unused = (
        says
        for says, name, declared in entries
        if words[name] == declared and not words[f"{name}_dot"] + words[f"{name}_ddot"]
    )
    return (*unused, *named_unused(scalars.named, source))


def _doubts(bodies: tuple[Member, ...], scalars: Scalars) -> Iterator[str]:
    """Yield a sentence for every body that no masses can make up."""
    for body in bodies:
        yield from member_doubts(f"body '{body.name}'", body.inertia, scalars.parameters)


def _momentum(
    given: Table, frames: tuple[Frame, ...], bodies: tuple[Member, ...], scalars: Scalars
) -> Place:
    names = {"frame": tuple(f.name for f in frames), "body": tuple(b.name for b in bodies)}
    said = entries_of(given, MOMENTUM, Reading(scalars.scopes, names))
    return Place(said["frame"], said["at"], said["of"] or names["body"])


def _about(given: Table, scalars: Scalars) -> Mapping[str, Formula]:
    """Return the values of free coordinates and speeds about which motion is small.

    What stands for itself, as ``theta = "theta"``, is an argument of ``linearised``.
    """
    free = {m.name: m.unit for m in (*scalars.coordinates, *scalars.speeds) if m.free}
    free |= {c.rate.name: PER_SECOND[c.unit] for c in scalars.coordinates
             if c.free and isinstance(c.rate, Input)}  # fmt: skip
    keys(given, (), free)
    kept = {name for name, says in given.entries.items() if says == name}
    others = dict.fromkeys(free.keys() - kept, "free, and not known")
    dimensions = {n: d for n, d in scalars.known.dimensions.items() if n not in others}
    dimensions |= {n: dimension(free[n]) for n in kept}
    base = Scope(dimensions, others, "only what is given may stand here")
    scope = widened(base, scalars.named)
    return {
        name: formula(given.entries[name], f"linearised.{name}", scope, dimension(unit))
        if name in given.entries
        else ZERO
        for name, unit in free.items()
    }
