"""What a header says that a function returns in its scene is what the function returns."""

import re

import pytest
from sympy import Symbol

from derive.emit.c.relations import MOST, every_relation
from derive.emit.equations import section as sections
from derive.emit.equations.section import Paragraph, Section, section
from derive.emit.files import scene_files
from derive.emit.page.equation import written_equations
from derive.emit.page.glance import at_a_glance, short_forms
from derive.library.library import Library
from derive.program.precision import F64
from derive.program.program import Program
from derive.scene.formula import in_floats
from derive.scene.grammar import parse
from derive.verify.sample import samples
from tests.check.replayed import Replayed
from tests.made import library_of

SCENES = ("free_body_principal", "heavy_top", "edge_runner_flat", "gyrostat", "cart_pendulum")
NEAR = 1e-9
"""Of the largest value: equations and functions round differently, and terms may cancel."""


def values_of(library: Library, program: Program) -> dict[str, dict[str, float]]:
    """Return arguments and results of a function at a sample, by how C writes them."""
    sample = samples(library.mechanism, F64, 1, 0).each[0]
    results = Replayed(library, library).results(program, sample)
    names = [c for q in program.outputs for c in q.components]
    given = {c: float(x) for c, x in sample.values.items()}
    given |= dict(zip(names, results, strict=True))
    found = {}
    for q in (*library.setup.inputs, *program.inputs, *program.outputs):
        for place, c in enumerate(q.components if q.role != "constants" else ()):
            found[f"{q.name}[{place}]" if q.shape else q.name] = given[c]
    return {"values": found}


def evaluated(text: str, known: dict[str, float]) -> float:
    """Return the value of a side of an equation of a header."""
    places = {name: f"v{n}_" for n, name in enumerate(sorted(known, key=len, reverse=True))}
    for name, place in places.items():
        text = re.sub(rf"(?<![\w\]]){re.escape(name)}(?![\w\[])", place, text)
    values = {place: known[name] for name, place in places.items()}
    return float(in_floats(parse(text.replace("^", "**")), values))


def wrong(library: Library, told: dict[str, list[str]]) -> list[str]:
    """Return the equations that do not hold of what functions return."""
    found = []
    for name, equations in told.items():
        known = values_of(library, library[name])["values"] if equations else {}
        size = max([1.0, *map(abs, known.values())])
        for equation in equations:
            left, right = equation.split(" = ")
            value = evaluated(right, known)
            if abs(known.setdefault(left, value) - value) > NEAR * size:
                found.append(equation)
    return found


@pytest.mark.long
@pytest.mark.parametrize("name", SCENES)
def test_equations_of_a_header_hold_of_what_the_functions_return(name: str) -> None:
    library = library_of(name)
    told = {n: list(each) for n, each in every_relation(library).items()}
    assert any(told.values())
    assert all(len(each) <= MOST for each in told.values())
    assert wrong(library, told) == []


def test_a_wrong_equation_is_noticed() -> None:
    library = library_of("free_body_principal")
    told = {n: list(each) for n, each in every_relation(library).items()}
    turned = [text.replace("I_yy - I_zz", "I_zz - I_yy") for text in told["acceleration"]]
    assert len(wrong(library, {"acceleration": turned})) == 1


def test_they_stand_in_the_header_by_the_names_of_arguments() -> None:
    header = scene_files(library_of("free_body_principal"), ())[
        "free_body_principal/free_body_principal_f32.h"
    ]
    own = "omega_dot[0] = (moment[0] + (I_yy - I_zz)*omega[1]*omega[2])/I_xx"
    assert f" * In this scene: {own}\n" in header


def test_equations_that_stand_on_each_other_many_times_are_followed_once() -> None:
    x = [Symbol(f"x{n}") for n in range(60)]
    sides = tuple((x[n], x[n - 1] + 2 * x[n - 2]) for n in range(2, len(x)))
    one = Section(
        "f", "", (), (Paragraph("definition", (), sides),), {"x": x[-1]}, {}, {}, {}, {}, {}
    )
    assert short_forms(one, MOST) == []
    assert short_forms(one, len(x)) == [*sides]


def test_what_readers_are_told_of_a_function_is_made_once_a_machine() -> None:
    one = library_of("heavy_top")
    assert section(one, "state_rate") is section(one, "state_rate")
    plain = one.mechanism.body_by_body
    mine, other = (written_equations(m, "state_rate") for m in (one.mechanism, plain))
    assert mine is not other


def test_a_function_of_many_lines_states_the_sum_that_it_is_and_its_laws(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sections, "LONG", -1)
    library = library_of("cart_pendulum")
    assert not any(every_relation(library).values())
    (whole, *laws) = at_a_glance(library, "energy")
    assert laws
    assert all(f"<mi>{letter}</mi>" in whole for letter in "TV")
