"""A report states what is kept of a scene on cores, and says what is not known."""

import json
from functools import cache
from pathlib import Path

from derive.emit.c.source import sources_of
from derive.emit.on_target import Cost, path_of, to_text
from derive.report.files import report_files
from derive.report.found import FunctionFigures
from derive.report.machine import Machine
from derive.report.whole import SceneReport
from derive.report.wishes import wished
from tests.made import library_of

FORMS = ("fast", "accurate")
NAME = "propeller_3_blade"


@cache
def found() -> SceneReport:
    """Return a report of which nothing but the scene is known."""
    made = library_of(NAME)
    figures = tuple(
        FunctionFigures(p.name, form, precision, 1, 1.0, 2.0)
        for p in made.printed() for form in FORMS for precision in ("f32", "f64")
    )  # fmt: skip
    machine = Machine("a", "b", "c")
    return SceneReport(made, "", wished(made), None, figures, (), (), (), (), machine)


def costs() -> list[Cost]:
    """Return made-up costs of the scene's functions on two cores, core by core."""
    names = [p.name for p in library_of(NAME).emitted()]
    return [
        Cost(core, f"Cortex-{core}", "f32", name, (270 + n, 277), 1000 + n, 12, 104)
        for core in ("m0plus", "m4f")
        for n, name in enumerate(names)
    ]


def keep(folder: Path, change: str = "") -> None:
    """Keep the costs below a folder, of the present C or of another."""
    sources = {p: text + change for p, text in sources_of(library_of(NAME)).items()}
    file = path_of(folder, NAME)
    file.parent.mkdir()
    file.write_text(to_text(NAME, costs(), sources))


def test_every_kept_figure_stands_on_the_page_and_in_the_json(tmp_path: Path) -> None:
    keep(tmp_path)
    page, data = report_files(found(), tmp_path).values()
    _, _, section = page.partition('<section id="targets">')
    rows = [row for row in section.partition("</section>")[0].split("<tr>") if "tight" in row]
    assert len(rows) == len(costs())
    names = [p.name for p in library_of(NAME).emitted()]
    assert [f"<code>{name}</code>" in row for name, row in zip(names, rows[::2], strict=True)] == [
        True
    ] * len(names)
    assert ["Cortex-m0plus" in row for row in rows] == [True, False] * len(names)
    assert all(f">{270 + n} to 277<" in rows[2 * n] for n in range(len(names)))
    said = json.loads(data)
    assert [row["code"] for row in said["targets"]] == [c.code for c in costs()]
    assert not any("Cortex" in why for why in said["without"])


def test_figures_of_other_c_are_not_stated_but_named(tmp_path: Path) -> None:
    keep(tmp_path, "/* another */")
    page, data = report_files(found(), tmp_path).values()
    assert 'id="targets"' not in page
    assert f"m4f: what is kept is of other C; `derive check --target m4f --keep {NAME}`" in page
    assert json.loads(data)["targets"] == []


def test_a_scene_that_ran_on_no_core_says_so(tmp_path: Path) -> None:
    page, _ = report_files(found(), tmp_path).values()
    assert 'id="targets"' not in page
    assert (
        f"nothing of this scene was run on one; `derive check --target m4f --keep {NAME}`" in page
    )
