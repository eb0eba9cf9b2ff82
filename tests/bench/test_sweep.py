"""What docs/sweep.md says of costs is what its bench prints, but for the figures."""

import re

from bench.sweep import PAGE, ExampleTaken, SweepFigures, examples, told

FIGURES = SweepFigures(
    (ExampleTaken("sleeping_top", 10**6, 120, 31.0, 23.0),
     ExampleTaken("pendulum.toml", 10**6, 8740, 80.0, 120.0),
     ExampleTaken("damped.toml", 26144, 2000, 6.0, 7.0)),
    3.8, ((10**5, 1, 4.0, 4.0, 330.0), (10**7, 2, 15.0, 23.0, 380.0)), 3e-3, 12e-3, 19e-3,
)  # fmt: skip
"""Made up."""


def without_figures(line: str) -> str:
    return re.sub(r"[0-9][0-9. ]*(e[0-9]+)?", "# ", line.replace("`", "")).replace("  ", " ")


def test_every_line_that_is_printed_stands_on_the_page() -> None:
    page = {without_figures(line) for line in PAGE.read_text(encoding="utf-8").splitlines()}
    missing = [line for line in told(FIGURES) if without_figures(line) not in page]
    assert missing == []


def test_a_line_of_another_form_is_missed_there() -> None:
    page = {without_figures(line) for line in PAGE.read_text(encoding="utf-8").splitlines()}
    assert without_figures("| 1e5 | 1 | 4.4 | 4.4 | 22 900 | 332 | 7 |") not in page


def test_the_commands_of_the_page_come_with_their_scenes() -> None:
    found = [(words[1], [*scenes]) for scenes, words in examples()]
    assert found == [("sleeping_top", []), ("pendulum.toml", ["pendulum.toml"]),
                     ("damped.toml", ["damped.toml"])]  # fmt: skip
