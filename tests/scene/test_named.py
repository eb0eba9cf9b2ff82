"""A named formula is what is written out in its place: same scene, same programs; or a sentence."""

import tomllib
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest

from derive.library.library import library
from derive.scene import Scene, SceneError, parse_scene
from derive.scene.scope import LARGEST_SIZE
from tests.scene.fuzzed import ODD, UNITS, fault
from tests.scene.mutated import written

ROOT = Path(__file__).parents[2]
NAMED = (ROOT / "tests/mechanics/scenes/contact_named.toml").read_text(encoding="utf-8")
BY_HAND = (
    ('couple = ["pressed*l"', 'couple = ["k*(l*(1 - cos(theta)))*l"'),
    ('"drag", "pressed"', '"u - k*(l*(1 - cos(theta)))", "k*(l*(1 - cos(theta)))"'),
    ('"N + pressed"', '"N + k*(l*(1 - cos(theta)))"'),
    ('"-g"', "-9.81"),
)
SHORT = """
wanted = ["state_rate"]
axes   = { attitude = "quaternion" }
body   = { kind = "principal", moments = ["A", "twice", 3] }
known  = { moment = ["-drag*omega_x", "0", "spun"] }
[parameters]
A = { unit = "kg m^2", range = [1.5, 2] }
b = { unit = "N m s", range = [0.1, 0.2] }
[formulas]
spun  = "-2*drag*omega_z"
twice = "1.1*A"
drag  = "b*(1 + attitude_w^2)"
"""
SHORT_BY_HAND = (
    ('"twice"', '"1.1*A"'),
    ('"-drag*omega_x"', '"-(b*(1 + attitude_w^2))*omega_x"'),
    ('"spun"', '"-2*(b*(1 + attitude_w^2))*omega_z"'),
)


def without_names(text: str, edits: tuple[tuple[str, str], ...]) -> str:
    head, _, tail = text.partition("[formulas]")
    _, bracket, rest = tail.partition("\n[")
    text = head + (bracket + rest).lstrip()
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return text


def programs(scene: Scene) -> list[Any]:
    made = library(scene)
    return [(p.name, p.ops, p.results, p.numbers) for p in (made.setup, *made.printed())]


@pytest.mark.parametrize(("text", "edits"), [(NAMED, BY_HAND), (SHORT, SHORT_BY_HAND)])
def test_a_named_formula_is_what_is_written_out(
    text: str, edits: tuple[tuple[str, str], ...]
) -> None:
    named, by_hand = (parse_scene(t, "contact") for t in (text, without_names(text, edits)))
    assert named.warnings == by_hand.warnings == ()
    assert (named.loads, named.results) == (by_hand.loads, by_hand.results) or not named.results
    assert programs(named) == programs(by_hand)


def test_a_scene_says_what_its_names_stand_for() -> None:
    told = parse_scene(NAMED, "contact").told
    assert "pressed, what the ground presses with, stands for k*depth." in told
    assert "drag stands for b*(1 + attitude_w^2)." in parse_scene(SHORT, "rotor").told


def test_names_may_stand_wherever_formulas_do() -> None:
    own = 'lean = "theta"\nlow = "-l"\nhalf = "1/2"\nslow = "half*W"'
    text = NAMED.replace("[formulas]", f"[formulas]\n{own}")
    text = text.replace('["x theta"]', '["z psi", "x lean"]').replace('"0","-l"]', '"0","low"]', 1)
    text = text.replace('["theta_ddot", ', '["linearised", "steady", ')
    text = text.replace(
        "[coordinates]",
        """[speeds]
W = { unit = "rad/s", range = [1, 2], rate = 0 }
[coordinates]
psi = { unit = "rad", range = [-1, 1], rate = "slow" }""",
    )
    text += '[linearised]\ntheta = "half*half"\n'
    text += '[steady]\nunknown = "theta"\nvanishes = "depth - half*l"\n'
    scene = parse_scene(text, "places")
    assert scene.warnings == ()
    assert str(scene.about["theta"]) == "1/2*(1/2)" or str(scene.about["theta"]) == "1/4"
    assert str(scene.steady["steady"].vanishes[0]) == "l*(1 - cos(theta)) - 1/2*l"
    assert str(scene.coordinates[0].rate) == "1/2*W"
    assert [t.coordinate for t in scene.frames[1].turned] == ["psi", "theta"]
    assert str(scene.bodies[0].centre[2]) == "-l"


@pytest.mark.parametrize(
    ("formulas", "says"),
    [
        ('a = "b"\nb = "c"\nc = "a"', "formulas use each other in a circle: a, b, c, a"),
        ('z = "b"\nb = "2*c"\nc = "b"', "formulas use each other in a circle: b, c, b"),
        ('a = "2*a"', "formula 'a' uses itself, '2*a'"),
        ('m = "2*l"', "'m' is declared twice: parameter 'm' and formula 'm'"),
        ('theta_dot = "2*l"', "'theta_dot' is declared twice: the rate 'theta_dot' and formula"),
        ('N = "2*l"', "'N' is declared twice: formula 'N' and the unknown 'N'"),
        ('total = "2*l"', "'total' is declared twice: formula 'total' and the result 'total'"),
        ('energy = "2*l"', "formula 'energy' has a name that is taken: the energy"),
        ('int = "2*l"', "a formula has the name 'int', which is a word of C"),
        ('"a b" = "2*l"', "a formula has the name 'a b'; a name is letters"),
        ('a = "m + l"', "formula 'a': 'm + l' joins 'm' in kg and 'l' in m"),
        ('a = { formula = "l", unit = "kg" }', "formula 'a' = 'l' is in m, not kg"),
        ('a = { formula = "l", unit = "furlong" }', "formula 'a': unit 'furlong' has an unknown"),
        ('a = "q"', "formula 'a' uses 'q', which the scene does not declare"),
        ('a = "2*b"\nb = "q"', "formula 'b' uses 'q', which the scene does not declare"),
        ('a = "theta_ddot"', "formula 'a' uses 'theta_ddot', an acceleration that is found"),
        ('a = "?N"', "formula 'a' = '?N': at 1: '?' is no part of a formula"),
        ('a = ""', "formula 'a' = '': at 1: expected a number, a symbol or '(', found the end"),
        ('a = "exec(l)"', "at 1: expected one of sin, cos, tan, sqrt before '('"),
        ("a = []", "formula 'a' must be a number, not a list of 0, []"),
        ("a = { }", "formula 'a' needs 'formula'"),
        ('a = { formula = "l", units = "m" }', "formula 'a' has an unknown key 'units'"),
        ('a = 0\nb = "l/a"', "formula 'b' = 'l/a': written out it divides by zero"),
    ],
)
def test_what_is_no_named_formula_is_refused_by_one_sentence(formulas: str, says: str) -> None:
    with pytest.raises(SceneError) as refused:
        parse_scene(NAMED.replace("[formulas]", f"[formulas]\n{formulas}"), "contact")
    assert str(refused.value).startswith("scene 'contact': ")
    assert says in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('"-g"', '"-pressed"', "load 'weight'.gravity.z = '-pressed' is in N, not m/s^2"),
        ('mass = "m"', 'mass = "m*depth/l"',
         "body 'bob'.mass uses 'depth', a formula of 'theta', a coordinate; only parameters"),
        ('["x theta"]', '["x drag"]',
         "frame 'arm'.turned uses 'drag', a formula of 'u', an input; only parameters and"),
        ("[results]", '[linearised]\ntheta = "depth/l"\n[results]',
         "linearised.theta uses 'depth', a formula of 'theta', free, and not known; only what is"),
        ("[results]", '[steady]\nunknown = "depth"\n[results]',
         "steady.unknown must be one of m, l, k, theta, theta_dot, u, not 'depth'"),
        ('"drag", "pressed"]', '"drag", "presed"]', "(did you mean 'pressed'?)"),
    ],
)  # fmt: skip
def test_a_name_is_refused_where_what_it_is_made_of_may_not_stand(
    old: str, new: str, says: str
) -> None:
    assert old in NAMED
    with pytest.raises(SceneError) as refused:
        parse_scene(NAMED.replace(old, new), "contact")
    assert says in str(refused.value)


def test_a_formula_that_nobody_uses_is_doubted() -> None:
    text = NAMED.replace("[formulas]", '[formulas]\nidle = "2*l"')
    assert parse_scene(text, "contact").warnings == ("formula 'idle' is not used",)
    short = SHORT.replace("[formulas]", '[formulas]\nidle = "2*A"')
    assert parse_scene(short, "rotor").warnings == ("formula 'idle' is not used",)


def test_names_that_double_each_other_end_in_a_sentence_at_once() -> None:
    doubling = "\n".join(f'd{n} = "d{n + 1}*d{n + 1} + l*d{n + 1}"' for n in range(90))
    text = NAMED.replace("[formulas]", f'[formulas]\n{doubling}\nd90 = "l"')
    says = fault(text, "contact", str)
    assert says == ""
    with pytest.raises(SceneError, match=f"operands; {LARGEST_SIZE} is the most"):
        parse_scene(text, "contact")
    tall = "\n".join(f'd{n} = "sqrt(1 + d{n + 1}^2)"' for n in range(90))
    with pytest.raises(SceneError, match="joins more than 100 terms in one chain"):
        parse_scene(NAMED.replace("[formulas]", f'[formulas]\n{tall}\nd90 = "theta"'), "contact")


@pytest.mark.long
@pytest.mark.parametrize("text", [NAMED, SHORT])
def test_odd_formulas_are_read_or_refused_in_one_sentence(text: str) -> None:
    document = tomllib.loads(text, parse_float=Decimal)
    for name in document["formulas"]:
        tables = [*({"formula": odd} for odd in ODD), *({"formula": "A", "unit": u} for u in UNITS)]
        for odd in (*ODD, *tables):
            changed = document | {"formulas": document["formulas"] | {name: odd}}
            assert fault(written(changed), "odd", str) == ""
