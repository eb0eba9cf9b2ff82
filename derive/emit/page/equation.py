"""The letters of a scene's page: the lecture's for what every scene calls by a word."""

from sympy import Symbol

from derive.library.library import Library

# Letters of the lecture for the quantities that every scene calls by a word.
_LETTERS = {
    "moment": ("M",), "force": ("F",), "attitude": ("q",), "position": ("p",), "velocity": ("v",),
    "point_acceleration": ("a_A", "moving_point_a"), "kinetic_energy": ("T", "E"),
    "angular_momentum": ("l", "L"), "rate_in_axes": ("l_dot", "L_dot"),
    "rate_absolute": ("l_N_dot", "L_N_dot"), "attitude_rate": ("q_dot",),
    "position_rate": ("p_dot",), "velocity_rate": ("v_dot",),
}  # fmt: skip


def letter(quantity: str, taken: frozenset[str]) -> str:
    """Return the letter for a quantity on a page: the lecture's, unless the user took it."""
    free = (a for a in _LETTERS.get(quantity, ()) if a.split("_")[0] not in taken)
    return next(free, quantity)


def written_names(library: Library) -> dict[Symbol, str]:
    """Return how the page writes each symbol of a scene."""
    words, taken = library.known.words, taken_names(library)
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
