"""Every line of a sweep's page ends where its member did, to its last digits."""

import re
import shlex
from html import unescape
from pathlib import Path

import pytest

import derive
from derive.cli import main
from tests.solve.sweep.swept_tops import swept_top

LAST = 4e-15
"""A few units in the last place of numbers near 1: CasADi may fold what C computes."""


def lines(of: derive.Ensemble) -> list[tuple[str, float, list[str]]]:
    """Return of each member that a page tells of the column, its value, and the words to type."""
    page = unescape(of.page.read_text(encoding="utf-8"))
    found = re.findall(r"<h3>\w+ <code>(.*?)</code>.*?member (\d+)</h3>\s*<pre>(.*?)</pre>", page)
    members = of.column("member").tolist()
    return [(c, of.column(c)[members.index(int(k))], shlex.split(line)) for c, k, line in found]


def replayed(words: list[str]) -> derive.Simulation:
    """Return the motion of a line, with all its digits."""
    told = dict(zip(words[-2::-2], words[::-2], strict=False))
    start, _, rest = " ".join(words).partition(" --set ")
    values = dict(v.split("=") for v in rest.partition(" --")[0].split())
    assert start == f"derive solve {words[2]}"
    own = derive.load(words[2])
    step, until = float(told["--step"]), float(told["--until"])
    return own.simulate({n: float(x) for n, x in values.items()}, until, step,
                        stop=told.get("--stop"), by=told.get("--by", "step_rk4"))  # fmt: skip


def ends_apart(of: derive.Ensemble) -> list[float]:
    """Return by how much motions that lines move again end elsewhere than their members did."""
    found = []
    for column, value, words in lines(of):
        motion = replayed(words)
        name, _, how = column.partition("@")
        if name == "ended_at":
            found.append(abs(motion.times[-1] - value))
        elif how == "end":
            found.append(abs(motion.states[name][-1] - value))
    assert len(found) >= 4
    return found


@pytest.mark.parametrize("step", [1e-3, 0.0071])
def test_a_line_has_the_bits_of_its_member(step: float, tmp_path: Path) -> None:
    keep = ["alpha@end", "beta@end", "alpha@0.0123", "beta"]
    assert max(ends_apart(swept_top(tmp_path / "runs", keep=keep, step=step))) == 0.0


def test_lengths_that_differ_do_not_end_alike(tmp_path: Path) -> None:
    own = swept_top(tmp_path / "runs", keep=["alpha@end", "beta@end"], stop=None, step=7.1e-3)
    _, value, words = next(line for line in lines(own) if line[0] == "alpha@end")
    words[words.index("--step") + 1] = "0.002"
    assert abs(replayed(words).states["alpha"][-1] - value) > 1e-11


@pytest.mark.long
def test_a_line_is_by_the_step_of_the_sweep(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    held = {"I_xx": 1.44, "I_yy": 1.64, "I_zz": 1.84, "omega_x": 1, "omega_y": 1,
            "attitude_w": 1, "attitude_x": 0, "attitude_y": 0, "attitude_z": 0}  # fmt: skip
    own = derive.load("tumbling_body").sweep(
        {"omega_z": "uniform(0.5, 1)"}, tmp_path / "runs", 5.0, ["omega@end", "attitude@end"],
        held, 64, error=1e-9, workers=1,
    )  # fmt: skip
    assert "--by step_split6" in shlex.join(lines(own)[0][2])
    assert max(ends_apart(own)) <= LAST
    assert main(lines(own)[0][2][1:]) == 0
    assert "at 5 s" in capsys.readouterr().out


@pytest.mark.parametrize(("told", "says"), [
    (["--by", "step_rk4"], "a step moves in time and needs --until SECONDS"),
    (["--by", "step_split2", "--until", "1"], "by must be 'step_rk4', not 'step_split2'"),
])  # fmt: skip
def test_a_step_that_a_scene_has_not_is_refused(
    told: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    data = ["m=0.5", "r=0.05", "l=0.06", "g=9.81", "n=99", "alpha=0.1", "beta=0", "alpha_dot=0"]
    assert main(["solve", "sleeping_top", "--set", *data, "beta_dot=0", *told]) == 2
    assert says in " ".join(capsys.readouterr().err.split())
