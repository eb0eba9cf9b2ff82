"""A page holds its own equations: every name in them is given, or stands on a left-hand side."""

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from derive.emit.notation import name_mathml
from derive.emit.page.equation import PageEquation, passages, written_names
from derive.mechanics.mechanism import Mechanism, mechanism
from derive.scene import SceneError, catalogue, parse_scene
from derive.scene.wanted import ATTITUDES, moves, without_ending
from tests.made import scene_of, thinned
from tests.scene.test_docs import ACCEPTED, EXAMPLE, MOTION

TRIALS = Path(__file__).parents[1] / "data" / "trials"
TAGS = re.compile(r"<math[^>]*>|</math>|</?div[^>]*>|&#8203;")
EQUALS = re.compile(r"<mo[^>]*>=</mo>")
LETTERS = re.compile(r"<mi>(?!(?:sin|cos|tan|exp|log|π)<)([^<]+)</mi>")
ROTOR = """
wanted = ["moment", "kinetic_energy", "angular_momentum_rate"]
[parameters]
m   = { unit = "kg", range = [5, 9] }
A   = { unit = "kg m^2", range = [2, 2.5] }
B   = { unit = "kg m^2", range = [1.2, 1.4] }
C   = { unit = "kg m^2", range = [1.5, 1.7] }
ecc = { unit = "m", range = [0.001, 0.01] }
[coordinates.gamma]
unit = "rad"
range = [-3.14, 3.14]
motion = "prescribed"
rate = { range = [50, 150] }
acceleration = { range = [-20, 20] }
[speeds]
W = { unit = "rad/s", range = [-0.4, 0.4], rate = { range = [-1, 1] } }
p = { unit = "rad/s", range = [-0.3, 0.3], rate = 0 }
[axes]
angular_velocity = ["p", "0", "W"]
[point]
kind = "fixed"
[body]
kind = "principal"
moments = ["B", "A", "C"]
mass = "m"
centre = ["ecc", "0", "0"]
turned = ["y gamma"]
"""
FLYWHEEL = """
wanted = ["state_rate", "angular_momentum_rate"]
[parameters]
m = { unit = "kg", range = [0.3, 0.6] }
r = { unit = "m", range = [0.05, 0.08] }
b = { unit = "m", range = [0.01, 0.03] }
l = { unit = "m", range = [0.06, 0.1] }
c = { unit = "N m", range = [0.0001, 0.001] }
g = { unit = "m/s^2", value = 9.81 }
[coordinates]
psi   = { unit = "rad", range = [-3.1, 3.1] }
theta = { unit = "rad", range = [0.2, 1.4] }
phi   = { unit = "rad", range = [-3.1, 3.1] }
[inputs]
shake = { unit = "m/s^2", range = [-4, 4] }
heave = { unit = "m/s^2", range = [-4, 4] }
[axes]
turned = ["z psi", "x theta"]
[point]
kind = "moving"
acceleration = [
    "shake*cos(psi)",
    "-shake*sin(psi)*cos(theta) + heave*sin(theta)",
    "shake*sin(psi)*sin(theta) + heave*cos(theta)",
]
[known]
moment = ["m*g*l*sin(theta)", "0", "c"]
[body]
shape  = "cylinder"
mass   = "m"
radius = "r"
length = "b"
axis   = "z"
centre = ["0", "0", "l"]
turned = ["z phi"]
"""
GYRO = """
wanted = ["H"]
[parameters]
D = { unit = "kg m^2", range = [0.1, 0.2] }
A = { unit = "kg m^2", range = [1, 2] }
B = { unit = "kg m^2", range = [1, 2] }
C = { unit = "kg m^2", range = [1, 2] }
[coordinates]
psi   = { unit = "rad", range = [-3, 3] }
theta = { unit = "rad", range = [0.3, 1] }
phi   = { unit = "rad", range = [-3, 3] }
[frames]
inner.turned = ["z psi", "x theta", "z phi"]
[bodies]
gyro = { frame = "inner", kind = "general", moments = ["A", "B", "C"], products = ["D", "D", "0"] }
[loads]
pivot = { on = "gyro", force = "?p" }
[results]
H = "angular_momentum_z"
"""
"""A result that is nothing but a named quantity: its line shows what that is made of."""
USERS = {"rotor": ROTOR, "flywheel": FLYWHEEL, "gyro": GYRO}
TEXTS = {f"docs_{k}": text for k, text in enumerate([*ACCEPTED, *EXAMPLE.findall(MOTION)])}
TEXTS |= {
    path.stem: path.read_text(encoding="utf-8")
    for path in sorted(TRIALS.glob("*.toml"))
    if not path.stem.startswith("meaning_")  # those are refused
}


@cache
def known_of(name: str) -> Mechanism:
    """Return the mechanism of a text above, or of a scene of the catalogue."""
    text = (USERS | TEXTS).get(name)
    return mechanism(scene_of(name) if text is None else parse_scene(text, name))


def functions(known: Mechanism) -> list[str]:
    """Return the functions of a scene that show equations."""
    bases = dict.fromkeys(map(without_ending, known.scene.wanted))
    return [name for name in bases if not moves(name) and name not in ATTITUDES]


def unsaid(known: Mechanism, lines: list[PageEquation]) -> Iterator[str]:
    """Yield what is read in these equations and is neither given nor on a left-hand side.

    A name is looked for as the page shows it, so that no algebra is shared with the page.
    """
    names, symbols = written_names(known), known.words.sheet.symbols
    written = sorted({_drawn(name) for name in names.values()}, key=len, reverse=True)
    name = re.compile("|".join(map(re.escape, written)))
    sides = [_sides(line) for line in lines]
    shown = {_drawn(names[symbols[c]]) for q in known.vocabulary.given() for c in q.components}
    shown |= {found for left, _ in sides for found in name.findall(left)}
    shown |= {_drawn(names[symbols[line.unknown]]) for line in lines}  # solved for together
    for _, right in sides:
        yield from (found for found in name.findall(right) if found not in shown)
        yield from LETTERS.findall(name.sub("", right))


def renamed(lines: list[PageEquation]) -> list[str]:
    """Return the right-hand sides that are nothing but the left-hand side of another equation."""
    sides = [[part.removeprefix("<mrow>") for part in _sides(line)] for line in lines]
    lefts = {left for left, _ in sides}
    return [right for _, right in sides if right.removesuffix("</mrow>") in lefts]


def _sides(line: PageEquation) -> list[str]:
    return EQUALS.split(TAGS.sub("", line.mathml), maxsplit=1)


def _drawn(name: str) -> str:
    return TAGS.sub("", name_mathml(name, "scalar"))


@pytest.mark.long
@pytest.mark.parametrize("name", [*USERS, *thinned([*TEXTS, *catalogue()], 8)])
def test_every_name_in_an_equation_is_given_or_stands_on_a_left_hand_side(name: str) -> None:
    known = known_of(name)
    for base in functions(known):
        try:
            lines = [line for passage in passages(known, base) for line in passage.lines]
        except SceneError as refusal:
            pytest.skip(f"no equations: {refusal}")
        assert (base, [*unsaid(known.posed(base), lines)]) == (base, [])
        assert (base, renamed(lines)) == (base, [])
