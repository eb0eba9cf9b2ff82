"""Names that a scene may give: identifiers in C and Python at once, and not taken by the tool.

A name goes unchanged into C structs, CasADi inputs and JSON, so it must be usable in all of them.
"""

import re
from collections.abc import Iterable, Mapping

from derive.scene.declaration import SceneError
from derive.scene.functions import FUNCTIONS, PLAIN
from derive.scene.reserved import is_device, owner

LONGEST_NAME = 40
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*")
HELPERS: Mapping[str, str] = {
    "setup": "set-up",
    "setup_status": "what set-up says",
    "constants": "the struct of constants",
    "pair": "a pair of floats",
    **dict.fromkeys(
        (*PLAIN, *FUNCTIONS, "abs", "at_most", "less", "low", "pi", "power_of_two", "sine",
         "splitter", "two_product", "unit_roundoff"),
        "a function of pairs of floats",
    ),
    **dict.fromkeys(("sine_cosine", "sines"), "the sine and cosine of an angle"),
    "PARAMETERS": "the list of parameters in the CasADi module",
    "CONSTANTS": "the list of constants in the CasADi module",
    **dict.fromkeys(("ode", "step", "error"), "a function of x and u in the CasADi module"),
    **dict.fromkeys(
        ("STATES", "INPUTS", "UNITS", "RANGES", "SCALES"), "what the CasADi module says of x and u"
    ),
    "SETUP_STATUS": "the words of set-up's status in the CasADi module",
}  # fmt: skip
"""What emitted files call by a function's name beside the functions that are wanted."""
VARIANTS = ("_hot", "_dense")
"""How emitted files name a function from constants, and one with its whole Jacobian."""
GENERATED: Mapping[str, str] = {
    "omega": "the angular velocity of the body",
    "omega_dot": "the angular acceleration of the body",
    "Omega": "the angular velocity of the axes",
    "Omega_dot": "the angular acceleration of the axes",
    "moment": "the moment",
    "force": "the force",
    "position": "the position of the mass centre",
    "position_rate": "the rate of the position",
    "velocity": "the velocity of the mass centre",
    "velocity_rate": "the rate of the velocity",
    "attitude": "the attitude quaternion",
    "attitude_rate": "the rate of the attitude quaternion",
    "point_acceleration": "the acceleration of the moving point",
    "angular_momentum": "the angular momentum",
    "rate_in_axes": "the rate of the angular momentum in the axes",
    "rate_absolute": "the absolute rate of the angular momentum",
    "kinetic_energy": "the kinetic energy",
    "potential_energy": "the potential energy",
    "energy": "the energy",
    "accelerations": "the accelerations",
    "state_rate": "the rates of all states",
    "mass_matrix": "the mass matrix of small motion",
    "damping_matrix": "the damping matrix of small motion",
    "stiffness_matrix": "the stiffness matrix of small motion",
    "linearised": "small motion",
    "steady": "steady motion",
    "constraint_distances": "how far a state is from what constraints ask",
    "coordinate_rates": "the rates of the coordinates",
    "wheel_speeds": "the speeds of the wheels",
    "wheel_accelerations": "the accelerations of the wheels",
    "wheel_torques": "the torques on the wheels",
    "jacobian": "a Jacobian",
    "time_step": "the length of a step in time",
    "time": "the time that a flow goes on for",
    "plan": "what a plan for many steps holds",
    "remainder": "what rounding left of earlier steps",
    "step_proposed": "the length that a step proposes for the next",
    "dense": "a Jacobian with its zeros",
    "parameters": "the parameters of the CasADi functions",
    "constants": "what set-up computes",
    "pi": "the number pi is no symbol of a scene",
}
"""Names that the emitted code uses itself, and for what; so are their components, as omega_x."""
_COMPONENT = re.compile(r"(_[wxyz])?(_next)?(_in)?$")


def identifier(name: str, what: str) -> str:
    """Return a name that is an identifier in C and Python and nobody's word."""
    if whose := owner(label(name, what)):
        raise SceneError(f"{what} has the name '{name}', which is {whose}")
    return name


def file_name(name: str) -> str:
    """Return the name of a scene's file, which its C symbols begin with."""
    if is_device(name):
        raise SceneError(f"the file has the name '{name}', which is a device of Windows")
    return identifier(name, "the file")


def refuse_taken_functions(names: Iterable[str]) -> None:
    """Refuse wanted functions whose symbols are taken, by helpers or by variants of others."""
    names = tuple(names)
    variants = {f"{name}{ending}": name for name in names for ending in VARIANTS}
    for name in names:
        if name in HELPERS:
            raise SceneError(f"wanted has '{name}', which emitted files call {HELPERS[name]}")
        if name in variants:
            raise SceneError(f"wanted has '{name}', which is how a variant of "
                             f"'{variants[name]}' is called")  # fmt: skip


def label(name: str, what: str) -> str:
    """Return a name of a frame, body or load, which no code carries: any that can be read."""
    if not _IDENTIFIER.fullmatch(name) or len(name) > LONGEST_NAME:
        rule = f"letters, digits and single underscores, a letter first, at most {LONGEST_NAME}"
        raise SceneError(f"{what} has the name {name[:60]!r}; a name is {rule}")
    return name


def distinct(declared: list[tuple[str, str]]) -> None:
    """Refuse a name that is declared twice or that the emitted code uses itself.

    declared : (name, what it is) in order of declaration, derived rates included
    """
    seen: dict[str, str] = {}
    for name, meaning in declared:
        whole = name if name in GENERATED else _COMPONENT.sub("", name)
        if whole in GENERATED:
            raise SceneError(f"{meaning} has a name that is taken: {GENERATED[whole]}")
        if name in seen:
            raise SceneError(f"'{name}' is declared twice: {seen[name]} and {meaning}")
        seen[name] = meaning
