"""What SymPy's Kane method says of a scene is what balances say, and a wrong scene is seen."""

from dataclasses import replace
from pathlib import Path

import pytest
from sympy import cse, symbols

from bench.kane import equations
from bench.links import asking, by_kane, counted, machines, machines_beside, same
from derive.mechanics.mechanism import Mechanism, mechanism

SCENES = {
    "acrobot": "derive/scene/catalogue",
    "rolling_disc": "derive/scene/catalogue",
    "segway": "bench/machines",
    "disc_of_body_speeds": "bench/machines",
    "satellite_with_arm": "bench/machines",
    "polar_arm": "bench/machines",
    "monorail": "tests/mechanics/scenes",
    "top_on_lift": "tests/mechanics/scenes",
    "spring_pendulums": "tests/mechanics/scenes",
    "gravity_gradient": "tests/mechanics/scenes",
}
LONG = ("satellite_with_arm", "gravity_gradient", "polar_arm", "monorail", "top_on_lift")


def told(name: str, old: str = "", new: str = "") -> Mechanism:
    """Return a machine asked for its accelerations, some of its text exchanged."""
    text = (Path(SCENES[name]) / f"{name}.toml").read_text(encoding="utf-8")
    assert old in text
    scene = asking(text.replace(old, new) if old else text, name)
    assert scene is not None
    return mechanism(scene)


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.long) if n in LONG else n for n in SCENES]
)
def test_a_scene_told_to_sympy_accelerates_as_its_balances_say(name: str) -> None:
    own = told(name)
    assert same(own, equations(own))


WRONG = {
    "acrobot": ('"0", "0", "l_1"', '"0", "0", "2*l_1"'),
    "rolling_disc": ('spin = "s"', 'spin = "2*s"'),
    "segway": ('"-T"', '"-2*T"'),
    "disc_of_body_speeds": ('"-g*sin(lean)"', '"g*sin(lean)"'),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_scene_that_is_told_otherwise_is_seen(name: str) -> None:
    found = equations(told(name, *WRONG[name]))
    right = told(name)
    assert same(right, equations(right))
    assert not same(right, found)
    wrong = replace(found, mass=2 * found.mass)
    assert not same(told(name, *WRONG[name]), wrong)


def test_what_is_not_free_has_no_peer() -> None:
    scene = Path("tests/mechanics/scenes/two_blade.toml").read_text(encoding="utf-8")
    assert asking(scene, "blade") is None


@pytest.mark.long
def test_a_machine_of_the_bench_is_not_dearer_than_sympy() -> None:
    found = {n: s for n, s in machines(["bench/machines"]).items() if n in ("segway", "gimbals")}
    assert len(found) == 2
    assert all("dearer" not in str(cell) for cell in machines_beside(found).columns[-1].cells)


def test_operations_are_counted_once_where_they_are_shared() -> None:
    x, y = symbols("x y")
    assert counted(*cse([x * y + 1, x * y - 1])) == 3
    assert by_kane(told("segway").scene).divisions == 4
