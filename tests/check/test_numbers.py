"""Every expected number of the data file comes out, in compiled C, in CasADi, and by solving."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from derive.check.compiler import find_compiler
from derive.check.emitted import Emitted, Files, loaded
from derive.emit.files import scene_files
from derive.solve.instrument import Instrument, opened
from derive.solve.motions import eigenvalues, frequencies, limits, roots
from derive.verify.sample import Sample
from tests.check.expected import (
    CASES,
    CONE,
    DATA,
    DISK,
    SLEEP,
    TOP,
    Case,
    Values,
)
from tests.made import library_of, thinned

DOUBLE, FLOAT = 1e-9, 2e-5  # the relative differences that are allowed
EARTH_UNIT = 1e38
"""8e37 kg m^2 times the splitter 4097 is beyond the largest float; only a ratio matters."""
ZERO = 1e-12  # an expected zero, beside terms of size one thousand


@cache
def instrument(name: str) -> Instrument:
    return opened(name)


@pytest.fixture(scope="module")
def emitted(tmp_path_factory: pytest.TempPathFactory) -> "Built":
    return Built(tmp_path_factory.mktemp("machines"))


class Built:
    """The C of scenes, compiled once."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.found = folder, dict[str, list[Emitted]]()

    def of(self, name: str) -> list[Emitted]:
        if name not in self.found:
            made = library_of(name)
            texts = {p.partition("/")[2]: t for p, t in scene_files(made, ()).items()}
            self.found[name] = list(loaded(made, Files(texts, ""), self.folder, find_compiler()))
        return self.found[name]


def c_answers(one: Emitted, function: str, values: Values) -> Values:
    known = one.library.mechanism
    words = known.vocabulary.given()
    held = {c: float(one.precision.dtype(values.get(c, 1.0))) for q in words for c in q.components}
    program = one.library[function]
    found = one.results(program, Sample(0, "data", held))
    return dict(zip([c for q in program.outputs for c in q.components], found, strict=True))


def close(found: float, expected: float, allowed: float) -> bool:
    return abs(found - expected) <= (allowed * abs(expected) or ZERO)


@pytest.mark.parametrize("case", thinned(CASES, 9), ids=lambda c: c.scene)
def test_casadi_gives_every_expected_number(case: Case) -> None:
    for answer in case.answers:
        values = case.values | dict(answer.extra)
        found = instrument(case.scene).answer(answer.function, values)[answer.component]
        assert close(answer.made(found), case.expected(answer.expected), DOUBLE), answer


@pytest.mark.parametrize("case", thinned(CASES, 9), ids=lambda c: c.scene)
def test_compiled_c_gives_every_expected_number(case: Case, emitted: Built) -> None:
    for one in emitted.of(case.scene):
        allowed = DOUBLE if one.precision.name == "f64" else FLOAT
        values = case.values
        if one.precision.name == "f32" and case.scene == "chandler_rigid_earth":
            values = values | {name: values[name] / EARTH_UNIT for name in "AC"}
        for answer in case.answers:
            found = c_answers(one, answer.function, values)[answer.component]
            assert close(answer.made(found), case.expected(answer.expected), allowed), answer


def test_every_expected_number_has_its_place() -> None:
    by_motion = {
        "rolling_cone": {"W_tip"},
        "eulers_disk": {"W"},
        "top_steady_precession": {"W_slow", "W_fast"},
        "sleeping_top": {"n_crit", "f_slow", "f_fast"},
    }
    for case in CASES:
        placed = {a.expected for a in case.answers} | by_motion.get(case.scene, set())
        assert placed == set(DATA[case.scene]["expected"])


ROOTS = ((TOP, ("W_slow", "W_fast")), (CONE, ("W_tip",)), (DISK, ("W",)))


@pytest.mark.parametrize(("case", "names"), ROOTS, ids=lambda c: getattr(c, "scene", ""))
def test_steady_motions_are_the_expected_roots(case: Case, names: tuple[str, ...]) -> None:
    values = {n: v for n, v in case.values.items() if n != "W"}
    found = [root["W"] for root in roots(instrument(case.scene), values)]
    assert len(found) == len(names)
    for root, name in zip(found, names, strict=True):
        assert close(root, case.expected(name), DOUBLE)


@pytest.mark.long
@pytest.mark.parametrize(("case", "names"), ROOTS, ids=lambda c: getattr(c, "scene", ""))
def test_compiled_c_vanishes_at_the_expected_roots(
    case: Case, names: tuple[str, ...], emitted: Built
) -> None:
    for one in emitted.of(case.scene):
        allowed = DOUBLE if one.precision.name == "f64" else FLOAT
        for name in names:
            ends = [
                c_answers(one, "steady", case.values | {"W": case.expected(name) * (1 + side)})
                for side in (-allowed, allowed)
            ]
            assert ends[0]["steady"] * ends[1]["steady"] < 0


@pytest.mark.long
def test_the_sleeping_top_wakes_at_the_expected_spin() -> None:
    values = {n: v for n, v in SLEEP.values.items() if n != "n"}
    (found,) = limits(instrument("sleeping_top"), values, "n")
    assert close(found, SLEEP.expected("n_crit"), DOUBLE)


@pytest.mark.long
def test_the_sleeping_top_wobbles_at_the_expected_frequencies(emitted: Built) -> None:
    expected = [SLEEP.expected(name) for name in ("f_slow", "f_fast")]
    assert np.allclose(frequencies(instrument("sleeping_top"), SLEEP.values), expected, DOUBLE)
    for one in emitted.of("sleeping_top"):
        found = eigenvalues(c_answers(one, "linearised", SLEEP.values)).imag
        allowed = DOUBLE if one.precision.name == "f64" else FLOAT
        assert np.allclose(sorted(found[found > 0]), expected, allowed, atol=0)
