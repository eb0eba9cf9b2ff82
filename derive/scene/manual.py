"""docs/entries.md: every table of a scene file and its entries, from the rows that readers follow.

``python -m derive.scene.manual > docs/entries.md`` writes the page anew.
"""

from collections.abc import Iterable, Mapping

from derive.scene import entries
from derive.scene.entry import REQUIRED, Entry
from derive.scene.shape import ROUND, SHAPES

HEAD = """\
# Every entry of a scene file

Made from the rows that the reader follows, by `python -m derive.scene.manual`; what they mean
together is told in [scenes.md](scenes.md). Formulas are of
*constants* (parameters), *places* (and coordinates), *motions* (and their rates and speeds), what
is *known* (and inputs, given accelerations), or *loads* (and the state). What has no default may be
left out, unless it is required.
"""
COLUMNS = "| entry | holds | unit | default | meaning |\n|---|---|---|---|---|"


def _shape(shape: str) -> str:
    """Return what the table of a shape is called."""
    whose = "a body" if shape in SHAPES else "a body of a machine, not of a single one"
    return f'`shape = "{shape}"` of {whose}'


TABLES: Mapping[str, tuple[Entry, ...]] = {
    "The file, above its first table": entries.FILE,
    "`[parameters]` NAME": entries.PARAMETER,
    "`[coordinates]` NAME": entries.COORDINATE,
    "`[speeds]` NAME": entries.SPEED,
    "`[inputs]` NAME": entries.INPUT,
    "`[formulas]` NAME, a formula or": entries.FORMULA,
    "`[frames.NAME]`": entries.FRAME,
    "`rolls` of a frame": entries.ROLLS,
    "`[bodies.NAME]`, besides a kind or a shape": entries.MEMBER,
    **{f'`kind = "{kind}"` of a body': rows for kind, rows in entries.KINDS.items()},
    **{_shape(shape): entries.shape_entries(shape) for shape in (*ROUND, *entries.SAID)},
    "`[loads.NAME]`, force and couple": entries.FORCE,
    "`[loads.NAME]`, weight": entries.WEIGHT,
    "`[loads.NAME]`, spring and damper": entries.SPRING,
    "`[loads.NAME]`, gravity gradient": entries.GRADIENT,
    "`gravity_gradient`, a formula or": entries.CENTRE_OF_FIELD,
    "`[constraints.NAME]`": entries.CONSTRAINT,
    "`[results]` NAME, a formula or": entries.RESULT,
    "`[angular_momentum]`": entries.MOMENTUM,
    "`[steady]`, or `[steady.NAME]` each": entries.STEADY,
    "`[motion]`": (entries.TIME_STEP, entries.TIME, entries.COLUMN),
    "`[axes]` of a single body": entries.AXES_OF_ONE,
    "`[body]`, besides a kind or a shape": entries.BODY,
    "`[point]` of a single body": entries.POINT,
    "`[known]` of a single body": entries.KNOWN,
    "`[[wheels]]` of a single body, about its mass centre or a fixed point": entries.WHEEL,
    "`[position]` of a single body": entries.POSITION,
}


def page() -> str:
    """Return the text of docs/entries.md."""
    return "\n".join([HEAD, *(_section(title, rows) for title, rows in TABLES.items())])


def words() -> set[str]:
    """Return every entry and every word that a scene file may hold."""
    rows = [row for each in TABLES.values() for row in each]
    return {word for row in rows for word in (row.key, *row.words)}


def _section(title: str, rows: Iterable[Entry]) -> str:
    return "\n".join([f"## {title}", "", COLUMNS, *map(_line, rows), ""])


def _line(row: Entry) -> str:
    formulas = "formula" in row.kind or row.kind == "vector"
    holds = " or ".join(f'`"{w}"`' for w in row.words) or row.kind.replace("any", "")
    scope = f" of {row.scope}" if formulas or row.kind == "turns" else ""
    cells = (f"`{row.key}`", holds + scope, row.unit if formulas else "", _default(row))
    return f"| {' | '.join((*cells, row.meaning))} |"


def _default(row: Entry) -> str:
    if row.default is REQUIRED:
        return "required"
    if isinstance(row.default, dict):
        ends = ", ".join(str(end) for end in row.default["range"])
        return f"`{{ range = [{ends}] }}`"
    return "" if row.default is None else f"`{row.default}`"


if __name__ == "__main__":
    print(page(), end="")
