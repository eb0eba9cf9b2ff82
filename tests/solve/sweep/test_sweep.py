"""Sweeps: the same bits however they are cut, every member as `simulate` moves it, none lost."""

import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pandas as pd
import pytest
from pyarrow import parquet

import derive
from derive.check.compiler import HOW_TO_GET_ONE, CompilerError
from derive.solve.sweep import kit
from derive.solve.sweep.store import MANIFEST, parts_of
from tests.solve.sweep.swept_tops import HELD, KEPT, STOP, VARIED, swept_top

CLOSE = 1e-9
"""Of RK4 at a millisecond, whose steps end at marks here and at multiples of one length there."""


def columns(of: derive.Ensemble) -> dict[str, Any]:
    names = parquet.read_schema(next(iter(parts_of(of.folder).values()))).names
    return {name: of.column(name) for name in names}


def same(one: derive.Ensemble, other: derive.Ensemble) -> bool:
    """Tell whether two sweeps hold the same bits."""
    left, right = columns(one), columns(other)
    return left.keys() == right.keys() and all(
        np.array_equal(x, right[n]) if x.dtype == object else x.tobytes() == right[n].tobytes()
        for n, x in left.items()
    )


@pytest.fixture(scope="module")
def top(tmp_path_factory: pytest.TempPathFactory) -> derive.Ensemble:
    return swept_top(tmp_path_factory.mktemp("top") / "runs.parquet")


def test_chunks_and_processes_change_no_bit_and_another_seed_does(
    top: derive.Ensemble, tmp_path: Path
) -> None:
    assert same(top, swept_top(tmp_path / "whole", chunk=600))
    assert same(top, swept_top(tmp_path / "two", chunk=37, workers=2))
    assert not same(top, swept_top(tmp_path / "seed", seed=8))
    assert not same(top, swept_top(tmp_path / "length", step=2e-3))


def test_a_member_goes_as_simulate_moves_it(top: derive.Ensemble) -> None:
    scene, found = derive.load("sleeping_top"), columns(top)
    assert {*top.ended} == {"stop", "until"}
    assert sum(top.ended.values()) == 600
    for k in (0, 5, 599):
        values = HELD | {name: float(found[name][k]) for name in VARIED}
        motion = scene.simulate(values, 0.2, 1e-3, stop=STOP)
        assert found["ended_at"][k] == pytest.approx(motion.times[-1], abs=CLOSE)
        assert found["beta@min"][k] == pytest.approx(motion.states["beta"].min(), abs=CLOSE)
        assert found["alpha@max"][k] == pytest.approx(motion.states["alpha"].max(), abs=CLOSE)
        early = motion.times[-1] < 0.05
        assert np.isnan(found["beta@0.05"][k]) == early
        there = np.isfinite(found["alpha@course"][k])
        assert there.tolist() == [t <= motion.times[-1] for t in (0, 0.05, 0.1, 0.15, 0.2)]
        assert found["alpha@course"][k][0] == values["alpha"]


def test_a_sweep_that_was_cut_off_goes_on_and_does_nothing_twice(
    top: derive.Ensemble, tmp_path: Path
) -> None:
    class CutError(Exception):
        pass

    done: list[int] = []

    def cut(_says: str, count: int, _of: int) -> None:
        done.append(count)
        if count == 300:
            raise CutError

    with pytest.raises(CutError):
        swept_top(tmp_path / "runs", told=cut)
    before = {p: p.stat().st_mtime_ns for p in parts_of(tmp_path / "runs").values()}
    assert len(before) == 3
    done.clear()
    again = swept_top(tmp_path / "runs", told=lambda _, count, __: done.append(count))
    assert [x for x in done if x < 600] == [300, 400, 500]
    assert {p: p.stat().st_mtime_ns for p in before} == before
    assert same(again, top)


def test_a_folder_takes_no_other_sweep_and_no_other_files(
    top: derive.Ensemble, tmp_path: Path
) -> None:
    with pytest.raises(derive.DeriveError, match="another sweep: its seed is '7', not '9'"):
        swept_top(top.folder, seed=9)
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(derive.DeriveError, match="holds files that are of no sweep"):
        swept_top(tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {"_lock", "notes.txt"}


def test_what_set_up_refuses_is_counted_and_kept_with_its_inputs(tmp_path: Path) -> None:
    vary = VARIED | {"m": "uniform(-0.1, 0.5)"}
    found = swept_top(tmp_path / "runs", vary=vary)
    lost = [how.startswith("refused: ") for how in found.column("ended")]
    assert found.unfinished == sum(lost) > 50
    assert (found.column("m")[lost] <= 0).all()
    assert (found.column("m")[~np.array(lost)] > 0).all()
    assert "refused: a mass is not positive" in found.page.read_text()


def test_what_becomes_no_number_is_counted(tmp_path: Path) -> None:
    vary = {"alpha_dot": "0..1e200:5"}
    values = HELD | {"alpha": 0.1, "m": 0.5, "n": 40}
    del values["alpha_dot"]
    found = swept_top(tmp_path / "runs", vary=vary, values=values, stop=None, samples=1)
    assert found.ended == {"not finite": 4, "until": 1}
    assert np.isfinite(found.column("ended_at")).tolist() == [True, False, False, False, False]


def test_pandas_and_duckdb_read_the_folder(top: derive.Ensemble) -> None:
    frame = pd.read_parquet(top.folder)
    assert sorted(frame["member"]) == list(range(600))
    table = duckdb.read_parquet(f"{top.folder}/*.parquet")
    ((count, most),) = table.aggregate('count(*), max("energy@end")').fetchall()
    assert (count, most) == (600, frame["energy@end"].max())
    assert parquet.read_schema(next(iter(parts_of(top.folder).values()))).metadata[b"derive"]
    assert '"seed": 7' in (top.folder / MANIFEST).read_text()


@pytest.mark.long
def test_without_a_compiler_casadi_gives_the_same_bits_and_is_named(
    top: derive.Ensemble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def none() -> None:
        raise CompilerError(HOW_TO_GET_ONE)

    monkeypatch.setattr(kit, "find_compiler", none)
    kit._ready.cache_clear()
    found = swept_top(tmp_path / "runs")
    kit._ready.cache_clear()
    assert same(found, top)
    assert [d for d in found.doubts if "CasADi" in d] != []


@pytest.mark.long
def test_threads_of_a_worker_compile_once(monkeypatch: pytest.MonkeyPatch) -> None:
    made, compiled = list[int](), kit.shared_members

    def counted(*told: Any) -> Any:
        made.append(1)
        time.sleep(0.2)
        return compiled(*told)

    monkeypatch.setattr(kit, "shared_members", counted)
    kit._ready.cache_clear()
    own = kit.kit_of(derive.load("sleeping_top").library, ["step_rk4"])
    with ThreadPoolExecutor(4) as threads:
        each = [*threads.map(kit.ready, [own] * 4)]
    assert (len(made), len({id(x) for x in each})) == (1, 1)


@pytest.mark.long
def test_a_disk_that_is_full_ends_a_sweep_that_then_goes_on(
    top: derive.Ensemble, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(file: int) -> None:
        if len(parts_of(tmp_path / "runs")) == 2:
            raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("derive.solve.sweep.store.os.fsync", full)
        with pytest.raises(derive.DeriveError, match="No space left on device"):
            swept_top(tmp_path / "runs")
    assert len(parts_of(tmp_path / "runs")) == 2
    assert [p for p in (tmp_path / "runs").iterdir() if p.name.endswith("unfinished")] == []
    assert same(swept_top(tmp_path / "runs"), top)


def test_the_page_has_a_line_that_solve_replays(
    top: derive.Ensemble, capsys: pytest.CaptureFixture[str]
) -> None:
    import shlex
    from html import unescape

    from derive.cli import main

    page = unescape(top.page.read_text())
    line = page.partition("largest <code>ended_at</code>")[2].partition("<pre>")[2]
    words = shlex.split(line.partition("</pre>")[0])
    assert words[:3] == ["derive", "solve", "sleeping_top"]
    assert main(words[1:]) == 0
    assert f"at {top.column('ended_at').max():.10g}"[:10] in capsys.readouterr().out
    assert KEPT[0] in page
    assert replace(top, ended={"not finite": 2}).unfinished == 2


def test_a_parameter_may_be_called_as_an_index_is(tmp_path: Path) -> None:
    each = {"m": {"unit": "kg", "range": [1, 2]}, "k": {"unit": "N/m", "range": [1, 2]}}
    load = {"on": "block", "force": ["-k*x", "?a", "?c"]}
    scene = derive.load({
        "wanted": ["step_rk4", "kinetic_energy"], "parameters": each,
        "coordinates": {"x": {"unit": "m", "range": [-1, 1]}},
        "frames": {"block": {"origin": ["x", "0", "0"]}},
        "bodies": {"block": {"frame": "block", "shape": "point", "mass": "m"}},
        "loads": {"spring": load},
    }, name="spring")  # fmt: skip
    start = {"m": 1.0, "x": 1.0, "x_dot": 0.0}
    found = scene.sweep({"k": "1..2:2"}, tmp_path / "runs", 1.0, ["x@end"], start, 1, step=0.01)
    assert sorted(columns(found)["x@end"]) == pytest.approx([np.cos(np.sqrt(2)), np.cos(1)])
