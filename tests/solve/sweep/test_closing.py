"""Members of machines with constraints begin on them: what varies stays, the rest follows.

Where they begin is held against formulas by hand: of a blade, and of a crank with its rod.
"""

import shlex
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derive
from derive.check.compiler import HOW_TO_GET_ONE, CompilerError
from derive.solve.sweep import kit, lanes
from derive.solve.sweep.beginning import FAR_OFF
from derive.solve.sweep.course import WHY
from tests.motion.test_constrained import SLED, handle
from tests.solve.sweep.test_sweep import columns, same

ROUNDED = 4e-15
"""A few units in the last place of angles, lengths and rates near 1."""
CLOSE = 1e-9
"""Of RK4 at a hundredth of a second, whose steps end at marks here and at equal times there."""
MIDDLE = 1.2 * np.tan(0.5)
BLADE = SLED | {"psi_dot": 0.5, "x_dot": 1.2, "y_dot": MIDDLE}
TURNED = {"psi": "uniform(0.3, 0.7)"}
CRANK = {"m_1": 1.5, "m_2": 1.5, "m_3": 1.5, "tau": 0.5, "a": 1.5, "a_dot": 2}
ROD = {"b": -1.0891, "b_dot": -0.271}
LENGTHS = {"r": "uniform(0.1, 0.7)", "l": "uniform(0.44, 0.46)"}


def swept_sled(folder: Path, to: str = "runs", **more: Any) -> derive.Ensemble:
    told: dict[str, Any] = {
        "vary": TURNED, "folder": folder / to, "until": 0.5, "keep": ["psi@end", "y_dot"],
        "values": BLADE, "samples": 200, "step": 0.01, "instants": 2, "workers": 1, "chunk": 64,
    }  # fmt: skip
    return handle(folder, "sleigh", "step_rk4", "blade").sweep(**told | more)


@pytest.fixture(scope="module")
def sled(tmp_path_factory: pytest.TempPathFactory) -> derive.Ensemble:
    return swept_sled(tmp_path_factory.mktemp("sled"))


@pytest.fixture(scope="module")
def cranks(tmp_path_factory: pytest.TempPathFactory) -> derive.Ensemble:
    folder = tmp_path_factory.mktemp("cranks")
    return handle(folder, "slider_crank_guided", "step_rk4", "kinetic_energy").sweep(
        LENGTHS, folder / "runs", 0.2, ["a@end", "b"], CRANK | ROD, 500, step=0.01, workers=1,
        instants=2, near=1,
    )  # fmt: skip


@pytest.mark.long
def test_a_rate_that_does_not_vary_follows_from_those_that_do(sled: derive.Ensemble) -> None:
    found = columns(sled)
    assert sled.ended == {"until": 200}
    slip = found["y_dot@0"] * np.cos(found["psi"]) - found["x_dot@0"] * np.sin(found["psi"])
    assert np.abs(slip).max() < ROUNDED
    ahead = found["x_dot@0"] * np.cos(found["psi"]) + found["y_dot@0"] * np.sin(found["psi"])
    should = 1.2 * np.cos(found["psi"]) + MIDDLE * np.sin(found["psi"])
    assert np.abs(ahead - should).max() < ROUNDED  # the nearest of rates whose ranges are alike


@pytest.mark.long
def test_what_varies_stays_as_it_is_drawn(tmp_path: Path) -> None:
    vary = TURNED | {"x_dot": "normal(1.2, 0.1)"}
    held = {n: x for n, x in BLADE.items() if n != "x_dot"}
    found = columns(swept_sled(tmp_path, vary=vary, values=held))
    assert "x_dot@0" not in found
    assert np.abs(found["y_dot@0"] - found["x_dot"] * np.tan(found["psi"])).max() < ROUNDED


@pytest.mark.long
def test_chunks_and_the_want_of_a_compiler_change_no_bit_of_a_start(
    sled: derive.Ensemble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert same(sled, swept_sled(tmp_path, chunk=37, workers=2))

    def none() -> None:
        raise CompilerError(HOW_TO_GET_ONE)

    monkeypatch.setattr(kit, "find_compiler", none)
    kit._ready.cache_clear()
    alone = swept_sled(tmp_path, "alone")
    kit._ready.cache_clear()
    assert same(sled, alone)


@pytest.mark.long
def test_a_start_that_is_not_brought_on_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def as_set(own: lanes.Lanes) -> Any:
        return np.ones(len(own), bool)

    monkeypatch.setattr(lanes.Lanes, "onto", as_set)
    found = columns(swept_sled(tmp_path))
    slip = found["y_dot@0"] * np.cos(found["psi"]) - found["x_dot@0"] * np.sin(found["psi"])
    assert np.abs(slip).max() > 0.01


@pytest.mark.long
def test_an_attitude_that_varies_by_components_begins_at_length_one(tmp_path: Path) -> None:
    own = derive.load("tumbling_body")
    held = {"I_xx": 1.44, "I_yy": 1.64, "I_zz": 1.84, "omega_x": 1, "omega_y": 1, "omega_z": 1,
            "attitude_w": 1, "attitude_y": 0, "attitude_z": 0}  # fmt: skip
    found = columns(own.sweep({"attitude_x": "uniform(-0.5, 0.5)"}, tmp_path / "runs", 0.5,
                              ["attitude_x@end"], held, 64, step=0.01, workers=1))  # fmt: skip
    whole = np.sqrt(1 + found["attitude_x"] ** 2)
    assert np.abs(found["attitude_w@0"] - 1 / whole).max() < ROUNDED
    assert np.abs(found["attitude_x@0"] - found["attitude_x"] / whole).max() < ROUNDED
    line = own.simulate(held | {c: found[f"{c}@0"][5] for c in ("attitude_w", "attitude_x")},
                        0.5, 0.01)  # fmt: skip
    assert line.states["attitude_x"][-1] == pytest.approx(found["attitude_x@end"][5], abs=CLOSE)


@pytest.mark.long
def test_a_step_is_found_for_what_is_held(tmp_path: Path) -> None:
    own = swept_sled(tmp_path, step=None, samples=64)
    assert own.says.startswith("step_rk4 at 41 ms keeps below 1e-06 over 0.5 s in the 64 members")
    assert own.halved["psi@end"] < 1e-6


@pytest.mark.long
def test_a_start_that_is_far_off_is_refused_and_the_page_tells_how_far_others_are(
    tmp_path: Path,
) -> None:
    turned = swept_sled(tmp_path, vary={"psi": "uniform(-1, 2)"}, near=0.25)
    found = columns(turned)
    wide = {"x_dot": 2.0, "y_dot": 2.0}
    off = [np.abs(found[f"{n}@0"] - BLADE[n]) / size for n, size in wide.items()]
    ended = found["ended"] != "until"
    assert {*found["ended"][ended]} == {f"refused: {WHY[FAR_OFF]}"}
    assert 20 < ended.sum() < 180
    assert np.nanmax(off) <= 0.25
    page = turned.page.read_text(encoding="utf-8")
    assert f"({100 * np.nanmax(off[1]):.2g} % of its range)" in page


@pytest.mark.long
def test_where_too_much_varies_all_of_it_is_moved_and_said(tmp_path: Path) -> None:
    vary = TURNED | {"x_dot": "normal(1.2, 0.1)", "y_dot": f"normal({MIDDLE:.17g}, 0.1)"}
    own = swept_sled(tmp_path, vary=vary, values=SLED | {"psi_dot": 0.5})
    assert [d for d in own.doubts if d.startswith("x_dot, y_dot vary, and too little is left")]
    found = columns(own)
    slip = found["y_dot@0"] * np.cos(found["psi"]) - found["x_dot@0"] * np.sin(found["psi"])
    assert np.abs(slip).max() < ROUNDED
    assert np.abs(found["x_dot@0"] - found["x_dot"]).max() > 0.01


@pytest.mark.long
def test_a_middle_that_is_far_off_is_refused_with_a_state_that_is_not(tmp_path: Path) -> None:
    with pytest.raises(derive.DeriveError) as refused:
        swept_sled(tmp_path, values=BLADE | {"y_dot": 0.2})
    assert "constraint 'blade' is 0" in str(refused.value)
    assert "a state nearby that fulfils all is" in str(refused.value)
    assert str(refused.value).endswith("in the middle of what varies, psi=0.5")
    assert not (tmp_path / "runs").exists()


@pytest.mark.long
def test_a_loop_is_closed_anew_with_the_lengths_of_each_member(cranks: derive.Ensemble) -> None:
    found = columns(cranks)
    reaches = found["r"] * np.sin(found["a@0"]) < found["l"]
    right = found["ended"] == "until"
    b = np.arcsin(-found["r"] * np.sin(found["a@0"]) / found["l"])
    assert np.abs((found["b@0"] - b)[right]).max() < ROUNDED
    slip = found["r"] * np.cos(found["a@0"]) * found["a_dot@0"]
    slip = slip + found["l"] * np.cos(found["b@0"]) * found["b_dot@0"]
    assert np.abs(slip[right]).max() < ROUNDED
    assert reaches[right].all()
    assert 400 < right.sum() <= 500


@pytest.mark.long
def test_who_is_beside_changes_no_bit_of_a_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Told to stop early, a start would be another one if it went on with its neighbours."""
    monkeypatch.setattr(lanes, "CLOSE", 1e-4)
    crank = handle(tmp_path, "slider_crank_guided", "step_rk4")
    one, other = (
        crank.sweep(LENGTHS, tmp_path / f"{chunk}", 0.02, ["b@end"], CRANK | ROD, 100, step=0.01,
                    workers=1, near=1, chunk=chunk)
        for chunk in (100, 7)
    )  # fmt: skip
    assert same(one, other)


@pytest.mark.long
def test_a_loop_that_does_not_close_is_counted_and_kept(tmp_path: Path) -> None:
    held = {n: x for n, x in CRANK.items() if n != "a"}
    own = handle(tmp_path, "slider_crank_guided", "step_rk4").sweep(
        LENGTHS | {"a": "uniform(1.4, 1.6)"}, tmp_path / "runs", 0.1, ["b@end"], held | ROD, 500,
        step=0.01, workers=1, near=1,
    )  # fmt: skip
    found = columns(own)
    lost = found["ended"] == "refused: no start nearby fulfils the constraints"
    open_ = found["r"] * np.sin(found["a"]) > found["l"]
    assert (lost >= open_).all()
    assert own.unfinished == lost.sum() == (lost & (found["r"] > 0.43)).sum() > 50
    page = own.page.read_text(encoding="utf-8")
    assert "no start nearby fulfils the constraints" in page
    assert "nan" not in page


@pytest.mark.long
def test_a_line_of_the_page_moves_its_member_again(
    cranks: derive.Ensemble, capsys: pytest.CaptureFixture[str]
) -> None:
    from derive.cli import main

    page = unescape(cranks.page.read_text(encoding="utf-8"))
    line = page.partition("largest <code>a@end</code>")[2].partition("<pre>")[2]
    words = shlex.split(line.partition("</pre>")[0])
    assert main(words[1:]) == 0
    row = next(r for r in capsys.readouterr().out.splitlines() if " a " in r)
    assert float(row.split()[4]) == pytest.approx(np.nanmax(cranks.column("a@end")), abs=CLOSE)
