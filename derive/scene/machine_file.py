"""The scene file of a machine: its tables read into declarations, each by one function."""

from __future__ import annotations

import re
from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING

from derive.formula import ZERO, Formula, substitute
from derive.grammar import parse
from derive.scene.declaration import Given, Input, SceneError
from derive.scene.frames import read_frames
from derive.scene.load import MARK, read_loads, unknown_units
from derive.scene.machine import INERTIAL, Frame, Machine, Member, Place, Result, Steady, Unknown
from derive.scene.member import read_member
from derive.scene.names import distinct, identifier, label
from derive.scene.scalars import PER_SECOND, Scalars, known, places, read_scalars, unknown_rates
from derive.scene.table import (
    Scope,
    Table,
    formula,
    interval,
    keys,
    nearest,
    shown,
    table,
    text,
    triple,
    word,
)
from derive.scene.wanted import JACOBIAN
from derive.unit import LENGTH, NONE, Dimension, dimension, dimension_of, spelled

if TYPE_CHECKING:
    from collections.abc import Mapping

TABLES = (
    "parameters", "coordinates", "speeds", "inputs", "frames", "bodies", "loads", "results",
    "angular_momentum", "linearised", "steady", "motion",
)  # fmt: skip
OF_ONE_BODY = ("body", "axes", "wheels", "point", "known", "position")
ENERGIES = ("kinetic_energy", "potential_energy", "energy")
FUNCTIONS = (
    *ENERGIES,
    *("angular_momentum", "accelerations", "state_rate", "step_rk4", "linearised", "steady"),
)
AXES = ("x", "y", "z")


def is_machine(document: Mapping[str, object]) -> bool:
    """Tell whether a file describes a machine and not a single body."""
    return "bodies" in document or "frames" in document


def read_machine(document: Mapping[str, object], name: str, source: str) -> Machine:
    """Return the machine of a parsed TOML document, checked table by table."""
    for key in OF_ONE_BODY:
        if key in document:
            rule = "is for a single body; with bodies and frames, use bodies, frames and loads"
            raise SceneError(f"table '{key}' {rule}")
    if "wanted" not in document:
        raise SceneError("the file needs 'wanted', above its first [table]")
    keys(Table("the file", document), ("wanted", "bodies"),
         (*TABLES, "title", "source", "form"))  # fmt: skip
    part = {key: table(document.get(key, {}), key) for key in TABLES}
    scalars = read_scalars(part)
    frames = read_frames(part["frames"], scalars, tuple(part["bodies"].entries))
    bodies = _bodies(part["bodies"], frames, scalars)
    loads, unknowns = read_loads(part["loads"], scalars, frames, bodies)
    results = _results(part["results"], scalars, unknowns)
    distinct(_declared(scalars, unknowns, results))
    asked = _wanted(document["wanted"], scalars, unknowns, results)
    return Machine(
        name=name,
        title=text(document.get("title", name), "title"),
        source=text(document.get("source", "own"), "source"),
        text=source,
        parameters=scalars.parameters,
        coordinates=scalars.coordinates,
        speeds=scalars.speeds,
        inputs=scalars.inputs,
        frames=frames,
        bodies=bodies,
        loads=loads,
        unknowns=unknowns,
        results=results,
        momentum=_momentum(part["angular_momentum"], frames, bodies, scalars),
        about=_about(part["linearised"], scalars),
        steady=_steady(part["steady"], scalars, unknowns, results, asked),
        asked=asked,
        wanted=tuple(asked),
        form="accurate" if word(document.get("form", "fast"), "form", ("fast", "accurate"))
        == "accurate" else "fast",
        time_step=_time_step(part["motion"]),
        warnings=_unused(scalars, source),
    )  # fmt: skip


def _bodies(given: Table, frames: tuple[Frame, ...], scalars: Scalars) -> tuple[Member, ...]:
    if not given.entries:
        raise SceneError("bodies must hold at least one body")
    return tuple(
        read_member(label(name, "a body"), table(value, f"body '{name}'"), frames, scalars)
        for name, value in given.entries.items()
    )


def _answers(scalars: Scalars, unknowns: tuple[Unknown, ...]) -> dict[str, Dimension]:
    """Return all that a result may be made of beside what is known."""
    found = dict(unknown_units(unknowns)) | unknown_rates(scalars)
    found |= dict.fromkeys(ENERGIES, dimension("J"))
    momentum = dimension("kg m^2/s")
    found |= _entries(scalars)
    return found | {f"angular_momentum_{axis}": momentum for axis in AXES}


def _entries(scalars: Scalars) -> dict[str, Dimension]:
    """Return the entries of the matrices of small motion, each with its dimension.

    Entries stand for forces or moments; of one kind alone they are told apart by nothing else.
    """
    free = [m for m in (*scalars.coordinates, *scalars.speeds) if m.free]
    inertia = {"rad": "kg m^2", "rad/s": "kg m^2", "m": "kg", "m/s": "kg"}
    found = {}
    for name, per in (("mass", 0), ("damping", 1), ("stiffness", 2)):
        for i in range(len(free)):
            for k, m in enumerate(free):
                unit = dimension(inertia[m.unit])
                found[f"{name}_matrix_{i + 1}_{k + 1}"] = (unit[0], unit[1], unit[2] - per)
    return found


def _results(given: Table, scalars: Scalars, unknowns: tuple[Unknown, ...]) -> tuple[Result, ...]:
    answers, found = _answers(scalars, unknowns), list[Result]()
    scope = known(scalars)
    for key, value in given.entries.items():
        name, meaning, said = identifier(key, "a result"), "", value
        if isinstance(value, dict):
            inner = Table(f"result '{key}'", value)
            keys(inner, ("formula",), ("meaning",))
            said, meaning = inner.entries["formula"], str(inner.entries.get("meaning", ""))
        both = Scope(dict(scope.dimensions) | answers, {}, "")
        read, unit = _of_any_unit(said, f"result '{key}'", both)
        answers[name] = unit
        found.append(Result(name, spelled(unit), read, meaning or f"{read}"))
    return tuple(found)


def _of_any_unit(value: object, label: str, scope: Scope) -> tuple[Formula, Dimension]:
    """Return a formula and the dimension that it turns out to have."""
    plain = MARK.sub(r"\1", value) if isinstance(value, str) else value
    try:
        read = formula(plain, label, scope, NONE)
    except SceneError as error:
        unit = _unit_found(str(error), plain, scope)
        if unit is None:
            raise
        return formula(plain, label, scope, unit), unit
    return read, dimension_of(read, scope.dimensions) or NONE


def _unit_found(sentence: str, value: object, scope: Scope) -> Dimension | None:
    """Return the dimension of a formula that was refused for not being a plain number."""
    if " is in " not in sentence or not isinstance(value, str):
        return None
    return dimension_of(parse(value), scope.dimensions)


def _declared(
    scalars: Scalars, unknowns: tuple[Unknown, ...], results: tuple[Result, ...]
) -> list[tuple[str, str]]:
    """List every name of the scene with what it is, derived ones included."""
    found = [(p.name, f"parameter '{p.name}'") for p in scalars.parameters]
    for m in scalars.moving:
        found.append((m.name, f"{m.kind} '{m.name}'"))
        rates = [i.name for i in (m.rate, m.acceleration) if isinstance(i, Input)]
        if m.free and m.kind != "input":
            rates.append(m.unknown)
        found += [(name, f"the rate '{name}'") for name in rates]
    found += [(u.name, f"the unknown '{u.name}'") for u in unknowns]
    return found + [(r.name, f"the result '{r.name}'") for r in results]


def _wanted(
    value: object, scalars: Scalars, unknowns: tuple[Unknown, ...], results: tuple[Result, ...]
) -> Mapping[str, tuple[str, ...]]:
    if not isinstance(value, list) or not value:
        raise SceneError(f"wanted must be a list of at least one answer, not {shown(value)}")
    groups = _groups(unknowns)
    known_ = [*FUNCTIONS, *groups, *(u.name for u in unknowns), *(r.name for r in results),
              *unknown_rates(scalars)]  # fmt: skip
    asked: dict[str, tuple[str, ...]] = {}
    for entry in value:
        if not isinstance(entry, str):
            raise SceneError(f"wanted has {shown(entry)}, which is no answer")
        name, colon, parts = (part.strip() for part in entry.partition(":"))
        base = name.removesuffix(JACOBIAN)
        answers = tuple(p.strip() for p in parts.split(",")) if colon else (base,)
        for answer in answers:
            if answer not in known_:
                raise SceneError(
                    f"wanted has '{answer}', which is no answer{nearest(answer, known_)}"
                )
        if name in asked:
            raise SceneError(f"wanted has '{name}' twice")
        asked[identifier(name, "a wanted function")] = answers
    return asked


def _groups(unknowns: tuple[Unknown, ...]) -> tuple[str, ...]:
    """Return the names of which all three components are unknowns."""
    names = {u.name for u in unknowns}
    firsts = [n.removesuffix("_x") for n in names if n.endswith("_x")]
    return tuple(sorted(f for f in firsts if {f"{f}_{a}" for a in AXES} <= names))


def _unused(scalars: Scalars, source: str) -> tuple[str, ...]:
    """Return a sentence for every scalar whose name, or rate, the file never mentions again."""
    words = Counter(re.findall(r"[A-Za-z][A-Za-z0-9_]*", source))
    entries = [("parameter", p.name) for p in scalars.parameters]
    entries += [(m.kind, m.name) for m in scalars.moving]
    return tuple(
        f"{kind} '{name}' is not used"
        for kind, name in entries
        if words[name] == 1 and not words[f"{name}_dot"] + words[f"{name}_ddot"]
    )


def _time_step(given: Table) -> Given:
    """Return the range of the length of a step."""
    keys(given, (), ("time_step",))
    if "time_step" not in given.entries:
        return Given(Fraction(0), Fraction(1, 100), None)
    inner = table(given.entries["time_step"], "motion.time_step")
    keys(inner, ("range",), ())
    return Given(*interval(inner.entries["range"], "motion.time_step.range"), None)


def _momentum(
    given: Table, frames: tuple[Frame, ...], bodies: tuple[Member, ...], scalars: Scalars
) -> Place:
    keys(given, (), ("frame", "at", "of"))
    frame = word(given.entries.get("frame", INERTIAL), "angular_momentum.frame",
                 [f.name for f in frames])  # fmt: skip
    at = triple(given.entries.get("at", [0, 0, 0]), "angular_momentum.at", places(scalars), LENGTH)
    names = [b.name for b in bodies]
    value = given.entries.get("of", names)
    each = value if isinstance(value, list) else [value]
    return Place(frame, at, tuple(word(one, "angular_momentum.of", names) for one in each))


def _about(given: Table, scalars: Scalars) -> Mapping[str, Formula]:
    """Return the values of free coordinates and speeds about which motion is small."""
    free = {m.name: m.unit for m in (*scalars.coordinates, *scalars.speeds) if m.free}
    free |= {c.rate.name: PER_SECOND[c.unit] for c in scalars.coordinates
             if c.free and isinstance(c.rate, Input)}  # fmt: skip
    keys(given, (), free)
    others = dict.fromkeys(free, "free, and not known")
    dimensions = {n: d for n, d in known(scalars).dimensions.items() if n not in free}
    scope = Scope(dimensions, others, "only what is given may stand here")
    return {
        name: formula(given.entries[name], f"linearised.{name}", scope, dimension(unit))
        if name in given.entries
        else ZERO
        for name, unit in free.items()
    }


def _steady(
    given: Table,
    scalars: Scalars,
    unknowns: tuple[Unknown, ...],
    results: tuple[Result, ...],
    asked: Mapping[str, tuple[str, ...]],
) -> Steady | None:
    if not given.entries:
        if any("steady" in answers for answers in asked.values()):
            raise SceneError("wanted has 'steady', which needs [steady] with its unknown")
        return None
    keys(given, ("unknown",), ("vanishes",))
    value = given.entries["unknown"]
    each = value if isinstance(value, list) else [value]
    scalar = [*(p.name for p in scalars.parameters if p.value is None),
              *(m.name for m in scalars.moving), *known(scalars).dimensions]  # fmt: skip
    names = tuple(word(one, "steady.unknown", scalar) for one in each)
    vanishes = None
    if "vanishes" in given.entries:
        answers = _answers(scalars, unknowns) | {r.name: dimension(r.unit) for r in results}
        both = Scope(dict(known(scalars).dimensions) | answers, {}, "")
        vanishes, _ = _of_any_unit(given.entries["vanishes"], "steady.vanishes", both)
        vanishes = written_out(vanishes, results)
    return Steady(names, vanishes)


def written_out(formula_: Formula, results: tuple[Result, ...]) -> Formula:
    """Return a formula with every result in it replaced by what it is made of."""
    for r in reversed(results):
        formula_ = substitute(formula_, {r.name: r.formula})
    return formula_
