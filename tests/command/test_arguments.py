"""Arguments that a command does not know, misses or cannot read: one sentence, exit code 2."""

import pytest

from derive.cli import main

BALL = '[body]\nkind = "spherical"\nmoment = "1"\n'
REFUSED = {
    "": "a command is missing (known: new, generate,",
    "slove": "there is no command 'slove' (did you mean 'solve'?)",
    "solve": "solve: SCENE is missing",
    "--bogus": "'--bogus' is no option (known: --version)",
    "sweep ball.toml": "sweep: --until, --out are missing",
    "lecture --without nosuch": "--without needs an assumption of the lecture, not 'nosuch'; its",
    "solve ball.toml --set m": "--set takes NAME=VALUE, as m=1200, not 'm'",
    "solve ball.toml --set =2": "--set takes NAME=VALUE, as m=1200, not '=2'",
    "solve ball.toml --set omega_x=20cm": "omega_x=20cm: a value is a finite number in SI units"
    " (here rad/s), as 0.5, an angle also 3deg, not '20cm'",
    "solve ball.toml --untli=3": "solve: '--untli' is no option (did you mean '--until'?)",
    "solve ball.toml --until x": "solve: argument --until: must be a number of seconds, as 0.5",
    "control ball.toml --steps 1.5": "control: argument --steps: must be a whole number above zero,"
    " up to 800, not '1.5'",
    "control ball.toml --starts=-2": "control: argument --starts: must be a whole number above",
    "solve ball.toml --until=1 --plot=": "solve: argument --plot: must be a path, not ''",
    "report ball.toml --out=": "report: argument --out: must be a path, not ''",
    "solve ball.toml --until 1e400": "solve: argument --until: must be a number of seconds, as 0.5,"
    " not '1e400'",
    "report ball.toml --keep": "report: '--keep' is no option of it (but of check, sweep)",
    "report ball.toml --kee=3": "report: '--kee' is no option of it (but of check, sweep)",
    "report ball.toml --zzz": "report: '--zzz' is no option (known: --until, --out)",
    "scenes --keepp": "scenes: '--keepp' is no option",
    "scenes --": "scenes: '--'",
    "check ball.toml --keep": "check: --keep needs --target, m0plus or m3",
    "check ball.toml --target m5": "check: argument --target: must be one of m0plus, m3, m4f, m7,",
    "report ball.toml --until": "report: argument --until: expected one argument",
    "generate ball.toml --out=": "generate: argument --out: must be a path, not ''",
    "generate ball.toml --samples -3": "generate: argument --samples: must be a whole number above",
    "equations ball.toml other": "equations: 'other' is one argument too many",
    "equations ball.toml --text --latex": "equations: argument --latex: not allowed with",
    "new thing x": "new: argument what: must be one of body, machine, not 'thing'",
    "completion fish": "completion: argument shell: must be one of bash, zsh, tcsh, not 'fish'",
}


@pytest.mark.parametrize("typed", REFUSED)
def test_bad_arguments_are_refused_by_one_sentence(typed, tmp_path, monkeypatch, capsys) -> None:
    (tmp_path / "ball.toml").write_text(f'wanted = ["moment"]\n{BALL}')
    monkeypatch.chdir(tmp_path)
    assert main(typed.split()) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    sentence, *more = shown.err.splitlines()
    assert more == []
    assert sentence.startswith(f"derive: {REFUSED[typed]}")
    assert [file.name for file in tmp_path.iterdir()] == ["ball.toml"]
