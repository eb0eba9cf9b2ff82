"""Bodies with wheels askew, and how far their Jacobians are from what is left of their terms.

The rates of such a body are of the second degree in its own velocities v, so each entry of their
Jacobian is linear in these: sum of c_k v_k, where c_k is the entry at v_k = 1 and all others zero.
The largest |c_k v_k| is what truly remains of its terms, however a program finds it.
"""

from collections.abc import Mapping, Sequence
from math import inf
from random import Random

import numpy as np
from flint import arb, ctx

from derive.library.library import Library
from derive.program.precision import F64
from derive.verify.columns import arithmetics, found_and_true, planned
from derive.verify.draw import Dice, Sampled, complete, drawn
from derive.verify.reference import reference

AXES = (
    *(("0", "3/5", "4/5"), ("3/5", "0", "4/5"), ("4/5", "-3/5", "0"), ("1/3", "2/3", "2/3")),
    *(("2/7", "-3/7", "6/7"), ("1", "0", "0"), ("0", "-5/13", "12/13"), ("12/13", "3/13", "4/13")),
    *(("1/sqrt(3)", "1/sqrt(3)", "1/sqrt(3)"), ("0", "1/sqrt(2)", "1/sqrt(2)")),
)
PRODUCTS = ((), ("D", "0", "0"), ("0", "0", "D"), ("D", "E", "0"), ("D", "E", "G"))
RATES, VELOCITIES = ("omega_dot_", "s_"), ("omega_", "s_")
STATES, SMALLEST = 40, 30
"""Of so many states, velocities of their own sizes down to 2^-30 of their ranges."""


def satellite(seed: int, wanted: str) -> str:
    """Return a scene: wheels along any axes, products of inertia, a place and a force or none."""
    dice = Random(seed)
    products, wheels = dice.choice(PRODUCTS), dice.choice((1, 1, 2, 2, 3))
    places, force = dice.random() < 0.5, dice.random() < 0.7
    letters = {"A": (8, 9), "B": (11, 12), "C": (14, 15), "K": (0.005, 0.02), "m": (80, 120)}
    letters |= {p: (-0.5, 0.5) for p in products if p != "0"}
    units = {"m": "kg"}
    parameters = "".join(
        f'{name} = {{ unit = "{units.get(name, "kg m^2")}", range = [{low}, {high}] }}\n'
        for name, (low, high) in letters.items()
        if name != "m" or places
    )
    text = f"wanted = {wanted}\n"
    text += 'axes = { attitude = "quaternion" }\n' if places else ""
    text += f'[parameters]\n{parameters}[body]\nmoments = ["A", "B", "C"]\n'
    text += f'kind = "{"general" if products else "principal"}"\n'
    text += f"products = {listed(products)}\n" if products else ""
    if places:
        text = text.replace("[body]", '[inputs]\nF = { unit = "N", range = [0, 1] }\n[body]')
        text += 'mass = "m"\n[position]\nposition = { range = [-9, 9] }\n'
        text += "velocity = { range = [-1, 1] }\n"
    text += "[known]\nangular_velocity = { range = [-0.2, 0.2] }\n"
    text += 'force = ["F", "0", "0"]\n' if places and force else ""
    for name, axis in zip("abc", dice.sample(AXES, wheels), strict=False):
        text += f'[[wheels]]\nname = "{name}"\naxis = {listed(axis)}\naxial = "K"\n'
        text += "speed_range = [-600, 600]\ntorque_range = [-0.1, 0.1]\n"
    return text


def listed(words: tuple[str, ...]) -> str:
    return "[" + ", ".join(f'"{word}"' for word in words) + "]"


def largest_error(library: Library, seed: str) -> tuple[float, str]:
    """Return the largest error of an entry in u of the largest term that it has, and its name."""
    program = library["state_rate_jacobian"]
    of, names = Sampled(library, F64), program.outputs[-1].components
    rows = states(of, seed)
    found = found_and_true(planned(program), complete(of, rows), arithmetics(F64.dtype))
    each = slopes_at_units(of, program.sparsity["jacobian"].columns, rows[:, 0])
    worst = (0.0, "")
    for name, (column, _) in zip(names, found[-len(names) :], strict=True):
        row, by = name[2:-1].split(")/d(")
        if row.startswith(RATES) and by.startswith(VELOCITIES):
            slopes = [(c.get((row, by), arb(0)), rows[of.names.index(v)]) for v, c in each.items()]
            errors = (off(value, k, slopes) for k, value in enumerate(column))
            worst = max(worst, (max(errors), name))
    return worst


def off(value: float, k: int, slopes: Sequence[tuple[arb, np.ndarray]]) -> float:
    """Return how far an entry at sample ``k`` is from its sum, in u of the largest term."""
    with ctx.workprec(300):
        terms = [c * arb(float(own[k])) for c, own in slopes]
        size = max(abs(float(t)) for t in terms)
        error = abs(float(arb(float(value)) - sum(terms, arb(0))))
    if not size:
        return inf if error else 0.0
    return error / size / F64.unit_roundoff


def states(of: Sampled, seed: str) -> np.ndarray:
    """Return samples of one body, (names, samples), with velocities of all sizes."""
    dice = Dice(seed)
    rows = drawn(of, dice, STATES)
    small = 2.0 ** -(SMALLEST * dice.uniform(*rows.shape) * (dice.uniform(*rows.shape) < 0.5))
    own = np.array([name.startswith(VELOCITIES) for name in of.names])
    rows = np.where(own[:, None], rows * small, rows)
    fixed = {c for q in of.library.vocabulary.parameters for c in q.components}
    one = np.array([name in fixed for name in of.names])
    return np.where(one[:, None], rows[:, :1], rows)


def slopes_at_units(
    of: Sampled, columns: tuple[str, ...], sample: np.ndarray
) -> dict[str, Mapping[tuple[str, str], arb]]:
    """Return the lecture's entries by row and column, each velocity alone being one."""
    rest = dict(zip(of.names, sample.tolist(), strict=True))
    own = [name for name in rest if name.startswith(VELOCITIES)]
    found = {}
    for unit in own:
        given = rest | {name: float(name == unit) for name in own}
        solved = reference(of.equations["state_rate"], given, columns)
        found[unit] = {(row, c): slope for row, of_row in solved.items()
                       for c, (slope, _) in of_row.slopes.items()}  # fmt: skip
    return found
