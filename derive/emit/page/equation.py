"""The equations of one scene for its page: the lecture's, with the scene's own quantities in place.

Every line is one residual of a truth, arranged so that what it determines stands on the left.
"""

from collections.abc import Mapping

from sympy import Add, Expr, Symbol

from derive.emit.notation import equation_mathml, sympy_equation_mathml
from derive.emit.page import machine
from derive.emit.page.passage import Line, Passage
from derive.lecture.chapters import LECTURE
from derive.library.library import Library
from derive.mechanics.mechanism import Mechanism
from derive.mechanics.truth import Truth
from derive.program.program import Quantity

# Letters of the lecture for the quantities that every scene calls by a word.
_LETTERS = {
    "moment": ("M",), "force": ("F",), "attitude": ("q",), "position": ("p",), "velocity": ("v",),
    "point_acceleration": ("a_A", "moving_point_a"), "kinetic_energy": ("T", "E"),
    "angular_momentum": ("l", "L"), "rate_in_axes": ("l_dot", "L_dot"),
    "rate_absolute": ("l_N_dot", "L_N_dot"), "attitude_rate": ("q_dot",),
    "position_rate": ("p_dot",), "velocity_rate": ("v_dot",),
}  # fmt: skip
_BALANCES = ("general_form", "moving_point_form", "gyrostat_form")
_STEPS = {
    "omega_dot": _BALANCES,
    "wheel_accelerations": ("wheel_equation",),
    "coordinate_rates": ("angular_velocities_add",),
    "attitude_rate": ("quaternion_rate_scalar", "quaternion_rate_vector"),
    "velocity_rate": ("mass_centre_motion", "rotation_of_vector"),
    "rate_in_axes": ("rate_in_axes",),
    "rate_absolute": ("transport_theorem",),
    "position_rate": (),
}


def letter(quantity: str, taken: frozenset[str]) -> str:
    """Return the letter for a quantity on a page: the lecture's, unless the user took it."""
    free = (a for a in _LETTERS.get(quantity, ()) if a.split("_")[0] not in taken)
    return next(free, quantity)


def written_names(library: Library) -> dict[Symbol, str]:
    """Return how the page writes each symbol of a scene."""
    words = library.known.words
    taken = taken_names(library)
    names: dict[Symbol, str] = {}
    for q in words.every():
        for component in q.components:
            own = component.removeprefix(q.name)
            new = letter(q.name, taken) if component.startswith(q.name) else component
            names[words.symbols[component]] = new + own if new != component else component
    return names


def taken_names(library: Library) -> frozenset[str]:
    """Return the names that the user chose."""
    words = library.known.words
    return frozenset(
        c for q in (*words.parameters, *words.states, *words.inputs) for c in q.components
    )


def passages(library: Library, fact: Truth) -> tuple[Passage, ...]:
    """Return the equations of a wanted function, each group with the lecture steps behind it."""
    if isinstance(library.known, Mechanism):
        return machine.passages(library.known, fact)
    names = written_names(library)
    components = {symbol: c for c, symbol in library.known.words.symbols.items()}
    owners = _owners(library)
    groups: dict[tuple[str, ...], list[Line]] = {}
    for unknown, residual in zip(fact.unknowns, fact.residuals, strict=True):
        component = components[unknown]
        left, right = arranged(residual, unknown, fact, _known_loads(library))
        shown = sympy_equation_mathml(left, right, names)
        line = Line(f"{fact.name}.{component}", component, shown)
        groups.setdefault(_steps(owners[component], component, fact), []).append(line)
    return tuple(_passage(steps, lines) for steps, lines in groups.items())


def _passage(names: tuple[str, ...], lines: list[Line]) -> Passage:
    steps = tuple(LECTURE[name] for name in names)
    return Passage(steps, tuple(map(equation_mathml, steps)), tuple(lines))


def _owners(library: Library) -> Mapping[str, Quantity]:
    return {c: q for q in library.known.words.every() for c in q.components}


def _steps(owner: Quantity, component: str, fact: Truth) -> tuple[str, ...]:
    """Return the lecture steps that determine one component."""
    if owner.name == "attitude_rate":
        wanted = _STEPS["attitude_rate"][0 if component.endswith("_w") else 1]
        return (wanted,)
    if owner.name in _STEPS:
        return tuple(step for step in fact.steps if step in _STEPS[owner.name])
    return fact.steps


def _known_loads(library: Library) -> frozenset[Symbol]:
    words = library.known.words
    names = [n for n in ("moment", "wheel_torques") if n in words]
    return frozenset(symbol for name in names for symbol in words.column(name))


def arranged(
    residual: Expr, unknown: Symbol, fact: Truth, loads: frozenset[Symbol]
) -> tuple[Expr, Expr]:
    """Return left and right of ``residual = 0``.

    On the left stands the unknown itself if it is determined outright, else the load that the line
    balances, else every term that holds an unknown.
    """
    terms = Add.make_args(residual)
    unknowns = set(fact.unknowns)
    outright = residual.free_symbols & unknowns == {unknown}
    for symbol in [unknown] * outright + sorted(loads & residual.free_symbols, key=str):
        for sign in (1, -1):
            if sign * symbol in terms:
                return symbol, -sign * (residual - sign * symbol)
    left = Add(*(term for term in terms if term.free_symbols & unknowns))
    return left, left - residual
