"""A stated error is what wide sampling and a search found, and a smaller figure is noticed."""

from dataclasses import replace

import numpy as np
import pytest

from derive.check.fresh import fresh
from derive.program.arithmetic import working
from derive.program.largest import largest
from derive.program.precision import F32, F64, Precision
from derive.verify.columns import arithmetics
from derive.verify.draw import Dice, Sampled, complete, drawn
from derive.verify.kept import Measuring, figures_of, stated_figures
from derive.verify.measure import replayed
from derive.verify.sample import Sample
from derive.verify.search import Sampling, errors_at, worst
from derive.verify.stated import at_rows, at_samples, figures
from tests.made import library_of, thinned

FEW = Sampling(samples=8192, rounds=8, batch=1024, balls=4, corners=1)
SCENE = "heavy_top"


def told(_: str) -> None:
    """Say nothing."""


@pytest.fixture(scope="module")
def measured():
    return figures(library_of(SCENE), FEW)


@pytest.mark.long
def test_fresh_samples_keep_the_stated_errors(measured):
    rows = list(fresh(library_of(SCENE), measured, 256, told))
    assert {row.outcome for row in rows} == {"holds"}


@pytest.mark.long
def test_a_figure_below_two_thirds_of_what_samples_find_is_noticed(measured):
    seen = worst(Sampled(library_of(SCENE), F32), replace(FEW, samples=4096, rounds=0))
    found = max(w.errors[0] for w in seen if w.function == "kinetic_energy")
    lowered = [replace(m, within=0.65 * found) if m.function == "kinetic_energy" else m
               for m in measured]  # fmt: skip
    failed = {
        (row.function, row.precision)
        for row in fresh(library_of(SCENE), lowered, 4096, told)
        if row.outcome == "FAILS"
    }
    assert ("kinetic_energy", "f32") in failed
    assert {function for function, _ in failed} == {"kinetic_energy"}


def test_a_figure_that_is_missing_or_absurd_fails(measured):
    absurd = [replace(m, within=9e15) if m.function == "kinetic_energy" else m for m in measured]
    one = [row for row in fresh(library_of(SCENE), absurd, 64, told) if row.outcome == "FAILS"]
    assert {row.function for row in one} == {"kinetic_energy"}
    assert all("it must be below 1e+06 u" in row.says for row in one)
    rows = list(fresh(library_of(SCENE), (), 64, told))
    assert {row.outcome for row in rows} == {"FAILS"}
    assert all("no figure is stated" in row.says for row in rows)


@pytest.mark.parametrize("precision", [F32, F64], ids=lambda p: p.name)
@pytest.mark.parametrize(
    "scene", thinned(["free_body", "tumbling_disc", "attitude", "sleeping_top"], 2)
)
def test_pairs_of_doubles_find_the_errors_that_balls_do(scene: str, precision: Precision) -> None:
    of = Sampled(library_of(scene), precision)
    rows = drawn(of, Dice("beside balls"), 6)
    at = complete(of, rows)
    each = at_rows(of, [rows], 0)
    for plan in of.plans:
        in_balls = at_samples(of, plan.program, each)
        for columns, found in zip(errors_at(of, plan, at), in_balls, strict=True):
            # float: double leaves 2^-29 of a u, times what a flow magnifies; double: pairs, less
            assert columns.max(axis=0) == pytest.approx(found.largest(), rel=1e-3, abs=1e-3)


def test_the_search_finds_more_than_samples_do():
    by = replace(FEW, samples=512)
    plain = worst(Sampled(library_of(SCENE), F64), replace(by, rounds=0))
    far = worst(Sampled(library_of(SCENE), F64), by)
    assert sum(w.errors[0] for w in far) > 1.2 * sum(w.errors[0] for w in plain)


def test_samples_are_of_bodies_within_the_ranges():
    of = Sampled(library_of("free_body"), F32)
    rows = drawn(of, Dice("within"), 300)
    assert rows.shape == (len(of.names), 300)
    assert np.all(rows >= of.lows[:, None])
    assert np.all(rows <= of.highs[:, None])
    at = complete(of, rows)
    xx, yy, zz = (at.wide[f"I_{axis}{axis}"] for axis in "xyz")
    assert np.all(xx + yy >= zz * (1 - 1e-6))  # floats of a body drawn in double


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_functions_of_columns_are_rounded_correctly(dtype: type) -> None:
    from derive.program.arithmetic import working

    wide = 20 * Dice("atan2").uniform(2, 400) - 10
    wide[:, :40] *= 10.0 ** np.arange(-38, 2)  # down to where a sine is its angle
    wide[0, 40:44], wide[1, 44:46] = 0.0, 0.0
    given = wide.astype(dtype)
    found = arithmetics(dtype).own["atan2"](*given)
    assert found.tolist() == working(dtype)["atan2"](*given).tolist()


@pytest.mark.long
def test_figures_are_kept_while_nothing_changes_and_measured_when_something_does(tmp_path):
    import json

    from derive.emit.files import scene_files, write

    library, by = library_of(SCENE), replace(FEW, samples=64, rounds=1, batch=16)
    first = figures_of(library, Measuring(by, tmp_path))
    texts = scene_files(library, first.each, first.digest)
    write(tmp_path, texts)
    assert stated_figures(json.loads(texts[f"{SCENE}/{SCENE}.json"])) == first.each
    again = figures_of(library, Measuring(by, tmp_path))
    assert scene_files(library, again.each, again.digest) == texts
    file = tmp_path / SCENE / f"{SCENE}.json"
    file.write_text(file.read_text().replace('"largest_ulp": ', '"largest_ulp": 9'))
    assert figures_of(library, Measuring(by, tmp_path)) != first  # believed: the digest is true
    assert figures_of(library, Measuring(by, None)) == first
    assert figures_of(library, Measuring(replace(by, kept=7), tmp_path)).digest != first.digest
    assert largest(m.worst for m in figures_of(library, Measuring(by, tmp_path)).each) > 90


def test_an_angle_next_to_half_a_turn_may_come_out_at_either_end():
    """Quaternions whose first angle is half a turn but for rounding: its sign is rounding too."""
    library, rows = library_of("attitude"), []
    dice = Dice("half a turn")
    w, x, z = dice.uniform(3, 64)
    turned = np.array([w, -x, z * x / w, z])
    turned = (turned / np.sqrt((turned**2).sum(axis=0))).astype(np.float32).tolist()
    names = ("attitude_w", "attitude_x", "attitude_y", "attitude_z")
    for n, values in enumerate(zip(*turned, strict=True)):
        rows.append(Sample(n, "found", dict(zip(names, values, strict=True))))
    (program,) = (f for f in library.printed() if f.name == "quaternion_to_euler_zxz")
    (found,) = at_samples(Sampled(library, F32), program, rows)
    assert largest(found.largest()) < 8
    only = replace(library, functions=(), motions=(program,))
    first = replayed(only, rows, F32, working(np.float32))[program.name][0]
    assert {bool(x > 3) for x in first} == {True, False} == {bool(x < -3) for x in first}
