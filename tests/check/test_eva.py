"""Eva finds no run-time error in the C of scenes, and finds each that is put into it."""

import math
import re
from fractions import Fraction

import numpy as np
import pytest

from derive.check.eva import cut_into_parts, entered, shown_by_eva
from derive.check.stand_in import AROUND, ends_in_c, with_bounds
from derive.cli import main
from derive.emit.c.source import c_files
from derive.program.arithmetic import extended
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


def test_a_sign_that_is_asked_for_is_told_of_each_part() -> None:
    """1 + |w| with the sign of w is nowhere 0: parts end a float below 0, and begin at it."""
    made = library_of("attitude")
    program = next(p for p in made.printed() if p.name == "quaternion_to_mrp")
    cut = cut_into_parts(made, program, F32)
    ends = [part.inputs["attitude_w"] for part in cut]
    least = float(np.nextafter(np.float32(0), np.float32(1)))
    assert all(high <= -least or low >= 0 for low, high in ends)
    assert {0.0, -least} <= {end for each in ends for end in each}


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
    bounded = with_bounds(text)
    assert "fabs(angle)" in text
    assert "fabs(angle)" not in bounded
    for name, wave in (("sine", math.sin), ("cosine", math.cos)):
        ends, least, most = table_of(bounded, f"found.{name}")
        assert len(least) == 225
        for k in range(225):
            a, b = k / 16 - ends, (k + 1) / 16 - ends
            at = (a - 1e-15, a, (a + b) / 2, a + 0.3 * (b - a), b, b + 1e-15)
            assert all(least[k] <= wave(x) <= most[k] for x in at)
            assert most[k] - least[k] < 2 * (b - a)
        assert f"found.{name} = Frama_C_double_interval(-0x1.00000" in bounded


def table_of(text: str, name: str) -> tuple[float, list[float], list[float]]:
    """Return up to which angle a sine has bounds by pieces, and these, as C says them."""
    number, row = r"Frama_C_double_interval\S+ \S+\);", r"\[\] = \{(.*)\};\n *"
    found = re.search(
        rf"{re.escape(name)} = {number}\n *if \(angle >= -(\S+) && angle < \1\) \{{\n"
        rf" *static const double least{row}static const double most{row}"
        rf"const int piece = \(int\)\(\(angle \+ \1\) \* 16\);\n"
        rf" */\*@ admit least\[piece\] <= {re.escape(name)} <= most\[piece\]; \*/",
        text,
    )
    assert found
    return float(found[1]), *([float.fromhex(x) for x in found[k].split(", ")] for k in (2, 3))


@pytest.mark.parametrize("precision", PRECISIONS, ids=lambda p: p.name)
def test_an_end_that_is_infinite_is_told_as_the_largest_number(precision: Precision) -> None:
    ends = ends_in_c(-np.inf, np.inf, precision)
    most = float(np.finfo(precision.dtype).max)
    assert [*map(float.fromhex, ends)] == [-most, most]


def test_bounds_of_operations_on_pairs_hold() -> None:
    """Pairs of random operands, of all sizes, lie between what is stated of their result."""
    by, dice = extended(np.float32), np.random.default_rng(3)
    for name, (made, near) in PAIR_OPERATIONS.items():
        shape = 20000
        high = dice.uniform(1, 2, (2, shape)) * np.exp2(dice.integers(-20, 20, (2, shape)))
        high = (high * dice.choice([-1, 1], high.shape)).astype(np.float32)
        if name == "sqrt":
            high = np.abs(high)
        low = (high * dice.uniform(-1, 1, high.shape) * 2.0**-25).astype(np.float32)
        pairs = [(high[k], low[k]) for k in range(2)]
        found = made(by, *pairs)
        value = near(*((h.astype(float), e.astype(float)) for h, e in pairs))
        off = np.abs(found[0].astype(float) - value)
        assert (off <= AROUND * 2.0**-24 * np.abs(value) + 2.0**-100).all(), name
        assert (np.abs(found[1]) <= 2.0**-23 * np.abs(found[0]) + 2.0**-100).all()


PAIR_OPERATIONS = {
    "add": (lambda by, a, b: by["add"](a, b), lambda a, b: (a[0] + b[0]) + (a[1] + b[1])),
    "mul": (lambda by, a, b: by["mul"](a, b), lambda a, b: a[0] * b[0]),
    "div": (lambda by, a, b: by["div"](a, b), lambda a, b: a[0] / b[0]),
    "sqrt": (lambda by, a, _: by["sqrt"](a), lambda a, _: np.sqrt(a[0])),
}
"""Each as a program does it, and as Eva is told of it."""


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
    ("= omega_y_in * omega_z_in;", "= omega_y_in * 1e38F;", "non-finite"),
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
