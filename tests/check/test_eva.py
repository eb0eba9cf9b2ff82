"""Eva finds no run-time error in the C of scenes, and finds each that is put into it."""

import math
import re
from fractions import Fraction

import numpy as np
import pytest

from derive.check.eva import cut_into_parts, entered, shown_by_eva, with_bounds_of_sines
from derive.cli import main
from derive.emit.c.source import c_files
from derive.program.precision import F32, PRECISIONS, Precision
from derive.program.program import component_names
from derive.program.run import run
from derive.program.status import statuses
from derive.verify.operators import IN_BALLS
from derive.verify.proved.bounds import ends_in_floats
from derive.verify.proved.regular import Sector, sectors
from tests.made import library_of

NAME = "free_body_principal"
needs_eva = pytest.mark.target


def cut_of(
    name: str, function: str, precision: Precision = F32, **ends: tuple[float, float]
) -> list[Sector] | None:
    made = library_of(name)
    program = next(p for p in made.printed() if p.name == function)
    given = [q for q in (*made.setup.inputs, *program.inputs) if q.role != "constants"]
    box = {c: (float(q.ends[0]), float(q.ends[1])) for q in given for c in q.components}
    return sectors(made, program, [box | ends], precision)


@pytest.mark.parametrize("precision", PRECISIONS, ids=lambda p: p.name)
@pytest.mark.parametrize(("name", "function"), [
    (NAME, "acceleration"), ("heavy_top", "state_rate"), ("rigid_body", "state_rate")
])  # fmt: skip
def test_parts_have_every_input_and_what_set_up_makes_of_every_parameter(
    name: str, function: str, precision: Precision
) -> None:
    made, cut = library_of(name), cut_of(name, function, precision)
    assert cut
    names = component_names(made.setup)
    random = np.random.default_rng(1)
    ends = {n: [e for part in cut for e in part.inputs[n]] for n in cut[0].inputs}
    for _ in range(100):
        at = {n: min(e) + (max(e) - min(e)) * random.random() for n, e in ends.items()}
        components = [c for q in made.setup.inputs for c in q.components]
        at |= {c: float(precision.dtype(at[c])) for c in components}
        inside = [p for p in cut if all(a <= at[n] <= b for n, (a, b) in p.inputs.items())]
        balls = [IN_BALLS["number"](Fraction(at[c])) for c in components]
        constants = dict(zip(names, run(made.setup, IN_BALLS, balls), strict=True))
        for part in inside:
            for n, (low, high) in part.constants.items():
                assert low <= float(precision.dtype(float(constants[n].mid()))) <= high
        assert inside or statuses(made.setup, [np.array([at[c]]) for c in components], float)[0]


def test_what_can_vanish_is_not_cut_away() -> None:
    """A gyrocompass has no pole; a top at theta = 0 has one, which no part may hold."""
    assert cut_of("heavy_top", "state_rate")
    assert cut_of("heavy_top", "state_rate", theta=(-1.0, 1.0)) is None


def test_every_quaternion_of_nearly_unit_length_is_given() -> None:
    """Also one with four equal components, a little short, and a little long along an axis."""
    made = library_of("attitude")
    program = next(p for p in made.printed() if any(q.is_quaternion for q in p.inputs))
    q = next(q for q in program.inputs if q.is_quaternion)
    text = entered(made, program, F32, cut_into_parts(made, program, F32))
    row = rf"own_{q.name}\[(\d)\] = Frama_C_float_interval\((\S+), (\S+)\)"
    ends = np.array([[float.fromhex(x) for x in each] for _, *each in re.findall(row, text)])
    low, high = ends.reshape(-1, 4, 2).transpose(2, 0, 1)
    random = np.random.default_rng(2)
    for length in (0.9996, 1.0, 1.0004):
        hard = [np.full(4, 0.5), np.array([0.0, -1, 0, 0]), np.array([0.5, -0.5, -0.5, 0.5])]
        for at in (*hard, *random.standard_normal((50, 4))):
            point = at * length / np.linalg.norm(at)
            assert ((low <= point) & (point <= high)).all(axis=1).any()


def test_what_rounding_leaves_is_given_as_widely_as_it_may_be() -> None:
    """A remainder is up to half a unit in the last place of the largest state."""
    made = library_of("tumbling_body")
    program = next(p for p in made.printed() if any(q.role == "remainder" for q in p.inputs))
    quantities = {c: q for q in program.inputs for c in q.components if q.role != "constants"}
    for name in (c for c, q in quantities.items() if q.role == "remainder"):
        low, high = ends_in_floats(quantities, name, F32)
        most = max(map(abs, quantities[name.split("_", 1)[1]].ends))
        assert high == -low >= float(np.spacing(np.float32(most))) / 2


def test_bounds_of_sines_hold_and_are_near() -> None:
    text = c_files(library_of("heavy_top"), ())["heavy_top_f64.c"]
    bounded = with_bounds_of_sines(text)
    assert "fabs(angle)" in text
    assert "fabs(angle)" not in bounded
    number = r"Frama_C_double_interval\((\S+), (\S+)\)"
    pieces = rf"angle >= (\S+) && angle <= (\S+)\) {{\s+found.sine = {number};\s+"
    rows = re.findall(rf"{pieces}found.cosine = {number};", bounded)
    assert len(rows) == 224
    assert "found.sine = Frama_C_double_interval(-0x1.00000" in bounded
    for low, high, *ends in rows:
        a, b = float(low), float(high)
        s0, s1, c0, c1 = (float.fromhex(end) for end in ends)
        for angle in (a, b, (a + b) / 2, a + 0.3 * (b - a)):
            assert s0 <= math.sin(angle) <= s1
            assert c0 <= math.cos(angle) <= c1
        assert s1 - s0 < 2 * (b - a)
        assert c1 - c0 < 2 * (b - a)


@needs_eva
@pytest.mark.parametrize("name", [NAME, "heavy_top", "gyrocompass"])
def test_eva_finds_nothing_in_a_scene(name: str) -> None:
    found = [*shown_by_eva(library_of(name))]
    assert found
    assert {v.outcome for v in found} == {"holds"}


@needs_eva
@pytest.mark.parametrize(("old", "new", "says"), [
    ("omega_dot[2] = t11;", "omega_dot[3] = t11;", "omega_dot"),
    ("= t2 * constants->one_over_I_xx;", "= t2 / omega[0];", "is_finite"),
    ("= omega[1] * omega[2];", "= omega[1] * 1e38F;", "non-finite"),
    ("const float t3 = t2", "float t99;\n    const float t3 = t99 + t2", "initialized"),
])  # fmt: skip
def test_eva_finds_what_is_put_into_the_c(old: str, new: str, says: str) -> None:
    made = library_of(NAME)
    file, texts = f"{NAME}_f32.c", c_files(made, ())
    assert old in texts[file]
    texts[file] = texts[file].replace(old, new, 1)
    found = [v for v in shown_by_eva(made, texts) if v.precision == "f32"]
    (row,) = [v for v in found if v.outcome != "holds"]
    assert row.function == "acceleration"
    assert says in row.says


def test_without_frama_c_the_command_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "")
    assert main(["check", NAME, "--eva"]) == 2
    assert "check: --eva needs frama-c" in capsys.readouterr().err
    assert main(["check", NAME, "--eva", "--target", "m4f"]) == 2
    assert main(["check", NAME, "--eva", "--samples", "64"]) == 2
