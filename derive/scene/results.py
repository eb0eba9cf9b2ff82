"""What a machine is asked: the answers it has, results made of them, and what is wanted."""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet

from derive.scene.constraint import Constraint
from derive.scene.declaration import AXES, SceneError
from derive.scene.entries import RESULT
from derive.scene.entry import Reading, entries_of
from derive.scene.escape import brief
from derive.scene.formula import Formula, substitute, symbols
from derive.scene.loads import MARK, unknown_units
from derive.scene.machine import Result, Unknown
from derive.scene.names import identifier, refuse_taken_functions
from derive.scene.scalars import Scalars, unknown_rates
from derive.scene.scope import Scope, measured
from derive.scene.table import Table, shown, text
from derive.scene.unit import BESIDE_SI, NONE, Dimension, UnitError, dimension, spelled
from derive.scene.wanted import JACOBIAN, OF_MACHINES, WANTED, resembling

ENERGIES = ("kinetic_energy", "potential_energy", "energy")
FUNCTIONS = (
    *ENERGIES,
    *("angular_momentum", "accelerations", "state_rate", "linearised", "steady"),
)
DISTANCES = "constraint_distances"
"""The answer that machines with constraints have beside all others."""
MATRICES = {
    "mass_matrix": "acceleration",
    "damping_matrix": "velocity, gyroscopic terms included",
    "stiffness_matrix": "displacement",
}
"""The matrices of small motion, each with what its entries multiply."""


def read_results(
    given: Table, scalars: Scalars, unknowns: tuple[Unknown, ...]
) -> tuple[Result, ...]:
    """Return the results of a scene file; each may be made of those before it."""
    answers, found = answer_units(scalars, unknowns), list[Result]()
    scope, energies = scalars.known, {*ENERGIES}
    for key, value in given.entries.items():
        name, meaning, said = identifier(key, "a result"), "", value
        if isinstance(value, dict):
            entry = entries_of(Table(f"result '{key}'", value), RESULT, Reading())
            said, meaning = entry["formula"], entry["meaning"] or ""
        both = Scope(dict(scope.dimensions) | answers, {}, "", scope.meanings)
        read, unit = of_any_unit(said, f"result '{key}'", both)
        energy = unit == dimension("J") and not energies.isdisjoint(symbols(read))
        energies |= {name} if energy else set()
        spelling = "J" if energy else spelled(unit)
        if isinstance(value, dict) and "unit" in value:
            spelling = _spelling(value["unit"], f"result '{key}'", unit)
            if spelling in BESIDE_SI:
                inside = f"({said})/({BESIDE_SI[spelling][1]})"
                read, _ = of_any_unit(inside, f"result '{key}'", both)
        if spelling not in BESIDE_SI:
            answers[name] = unit
        found.append(Result(name, spelling, read, meaning or f"{read}"))
    return tuple(found)


def _spelling(value: object, label: str, found: Dimension) -> str:
    """Return the unit that a result is given in; it must be one of what its formula is."""
    spelling = text(value, f"{label}.unit")
    try:
        asked = dimension(BESIDE_SI.get(spelling, (spelling, ""))[0])
    except UnitError as error:
        raise SceneError(f"{label}: {error}") from None
    if asked != found:
        rule = f"a formula in {spelled(found)} cannot be given in '{brief(spelling)}'"
        raise SceneError(f"{label}: {rule}")
    return spelling


def of_any_unit(value: object, label: str, scope: Scope) -> tuple[Formula, Dimension]:
    """Return a formula and the dimension that it turns out to have."""
    plain = MARK.sub(r"\1", value) if isinstance(value, str) else value
    read, unit = measured(plain, label, scope)
    return read, unit or NONE


def read_asked(
    value: object,
    scalars: Scalars,
    unknowns: tuple[Unknown, ...],
    results: tuple[Result, ...],
    lasting: tuple[str, ...],
    held: tuple[Constraint, ...] = (),
) -> Mapping[str, tuple[str, ...]]:
    """Return the answers that each wanted function gives.

    lasting : the functions of steady motions        held : the constraints
    """
    if not isinstance(value, list) or not value:
        raise SceneError(f"wanted must be a list of at least one answer, not {shown(value)}")
    for result in results:
        if result.name in unknown_vectors(unknowns):
            rule = f"is the vector of the unknowns '{result.name}_x' to '{result.name}_z' already"
            raise SceneError(f"result '{result.name}' needs another name: '{result.name}' {rule}")
    parts = _parts(scalars, unknowns)
    vectors = (m.answer for m in scalars.moving if m.free and m.vector)
    named = (*(u.name for u in unknowns), *(r.name for r in results))
    known_ = [*FUNCTIONS, *([DISTANCES] if held else []), *lasting, *OF_MACHINES,
              *unknown_vectors(unknowns), *named, *unknown_rates(scalars), *vectors]  # fmt: skip
    asked: dict[str, tuple[str, ...]] = {}
    for entry in value:
        name, answers = _entry(entry, known_, {"steady", *lasting})
        if name in asked:
            raise SceneError(f"wanted has '{brief(name)}' twice")
        twice = [(p, a) for a in answers for p in parts.get(a, ()) if p in answers]
        if twice:
            part, whole = twice[0]
            raise SceneError(f"wanted '{name}' gives '{part}' twice: by '{whole}' and alone")
        asked[identifier(name, "a wanted function")] = answers
    refuse_taken_functions(asked)
    return asked


def _parts(scalars: Scalars, unknowns: tuple[Unknown, ...]) -> Mapping[str, tuple[str, ...]]:
    """Return the unknowns that each answer gives as components of a vector."""
    parts = {v: tuple(f"{v}_{axis}" for axis in AXES) for v in unknown_vectors(unknowns)}
    for m in (m for m in scalars.moving if m.free and m.vector):
        for answer in (m.answer, "accelerations"):
            parts[answer] = (*parts.get(answer, ()), m.unknown)
    return parts


def _entry(
    entry: object, known_: Sequence[str], lasting: AbstractSet[str]
) -> tuple[str, tuple[str, ...]]:
    """Return a wanted function, ``name`` or ``name: answer, answer``, and its answers."""
    if not isinstance(entry, str):
        raise SceneError(f"wanted has {shown(entry)}, which is no answer")
    name, colon, parts = (part.strip() for part in entry.partition(":"))
    alone = name if name in OF_MACHINES else name.removesuffix(JACOBIAN)
    answers = tuple(p.strip() for p in parts.split(",")) if colon else (alone,)
    for answer in answers:
        if answers.count(answer) > 1:
            raise SceneError(f"wanted '{brief(name)}' gives '{brief(answer)}' twice")
        if colon and answer in OF_MACHINES:
            rule = f"within '{brief(name)}', but a step stands alone"
            raise SceneError(f"wanted has '{answer}' {rule}")
        if answer in lasting and len(answers) > 1:
            rule = f"within '{brief(name)}', but what vanishes in a steady motion stands alone"
            raise SceneError(f"wanted has '{answer}' {rule}")
        if answer not in known_ or (answer != name and answer in OF_MACHINES):
            alien = answer in WANTED and answer not in OF_MACHINES
            hint = " of a machine, but of a single body" if alien else resembling(answer, known_)
            shown_, base = answer if colon else name, answer.removesuffix(JACOBIAN)
            if colon and base != answer and base in known_:
                hint = f"; derivatives are asked for by the name, '{brief(name)}{JACOBIAN}: {base}'"
            raise SceneError(f"wanted has '{brief(shown_)}', which is no answer{hint}")
    return name, answers


def unknown_vectors(unknowns: tuple[Unknown, ...]) -> tuple[str, ...]:
    """Return the names of which all three components are unknowns."""
    names = {u.name for u in unknowns}
    firsts = [n.removesuffix("_x") for n in names if n.endswith("_x")]
    return tuple(sorted(f for f in firsts if {f"{f}_{a}" for a in AXES} <= names))


def answer_units(scalars: Scalars, unknowns: tuple[Unknown, ...]) -> dict[str, Dimension]:
    """Return all that a result may be made of beside what is known."""
    found = dict(unknown_units(unknowns)) | unknown_rates(scalars)
    found |= dict.fromkeys(ENERGIES, dimension("J"))
    momentum = dimension("kg m^2/s")
    found |= matrix_entries(scalars)
    return found | {f"angular_momentum_{axis}": momentum for axis in AXES}


def matrix_entries(scalars: Scalars) -> dict[str, Dimension]:
    """Return the entries of the matrices of small motion, each with its dimension.

    Entries stand for forces or moments; of one kind alone they are told apart by nothing else.
    """
    free = [m for m in (*scalars.coordinates, *scalars.speeds) if m.free and not m.dependent]
    of_a_turn, of_a_way = dimension("kg m^2"), dimension("kg")
    inertia = {"rad": of_a_turn, "rad/s": of_a_turn, "m": of_a_way, "m/s": of_a_way}
    found = {}
    for per, name in enumerate(MATRICES):
        units = [(u[0], u[1], u[2] - per) for u in (inertia[m.unit] for m in free)]
        for i in range(len(free)):
            for k, unit in enumerate(units):
                found[f"{name}_{i + 1}_{k + 1}"] = unit
    return found


def written_out(formula_: Formula, results: tuple[Result, ...]) -> Formula:
    """Return a formula with every result in it replaced by what it is made of."""
    for r in reversed(results):
        formula_ = substitute(formula_, {r.name: r.formula})
    return formula_
