"""A scene of hundreds of coordinates is read in a time that grows with its length alone."""

from importlib import import_module

import pytest

from derive.scene import parse_scene
from derive.scene.unit import dimension


def chain(count: int) -> str:
    each = range(count)
    coordinates = "\n".join(f'q{k}x = {{ unit = "rad", range = [-1, 1] }}' for k in each)
    frames = "\n".join(
        f'f{k} = {{ parent = "{f"f{k - 1}" if k else "inertial"}", turned = ["y q{k}x"] }}'
        for k in each
    )
    bodies = "\n".join(f'b{k} = {{ frame = "f{k}", shape = "point", mass = 1 }}' for k in each)
    head = 'wanted = ["kinetic_energy"]\n[coordinates]\n'
    return f"{head}{coordinates}\n[frames]\n{frames}\n[bodies]\n{bodies}\n"


@pytest.mark.long
def test_units_are_read_in_proportion_to_the_coordinates(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    for count in (50, 200):
        calls = 0

        def counted(spelling: str) -> object:
            nonlocal calls
            calls += 1
            return dimension(spelling)

        for module in ("scalars", "results", "table"):
            monkeypatch.setattr(import_module(f"derive.scene.{module}"), "dimension", counted)
        parse_scene(chain(count), "chain")
        found.append(calls)
    assert found[0] > 50
    assert found[1] < 4.5 * found[0]
