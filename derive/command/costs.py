"""The table of what functions cost and how wrong they are, and its words explained below it."""

from collections.abc import Callable, Iterable, Mapping, Sequence

from rich.padding import Padding
from rich.table import Table

from derive.command.terminal import console, print_rows
from derive.library.saving import Saving
from derive.solve.generation import CostRow, Made

WIDTH = 100
"""Columns of the table, also where more are free: a page or half a screen has them."""
MOST_NAMES = 3
View = Callable[[Sequence[Made]], tuple[Table, Mapping[str, str]]]
"""How results are shown: a table, and the words in it with their meaning."""

COSTS = {
    "+ - * /": "operations of one call; signs are free, and so is what depends on parameters only,"
    " which set-up computes once",
    "/": "the divisions among them",
    "float, double": "the error that rounding makes in the C of that type, counted in u",
    "u": "what rounding does to one number at most, as a part of it: 2^-24 in float, 2^-53 in"
    " double; here a part ",
}
ON_RANGES = {
    "median": "of all samples of the declared ranges: half of them err by less",
    "largest": "at any sample of the declared ranges, or found by a search from the worst of them",
}
SPARED = {
    "hard": "the largest at bodies and motions that are hard to compute too: nearly a sphere, a"
    " thin rod, a hundred times faster; most of them lie outside the declared ranges",
    "left out": "unknown forces and moments that the balances found for a function do not hold",
    "cancels": "what stands in these balances, and yet the answer does not change with it",
    "body by body": "operations of the same answer by the balances of every body for itself",
}


def print_costs(results: Sequence[Made], view: View) -> None:
    """Print what every function costs and how wrong it is, then what the words mean."""
    table, words = view(results)
    width = min(WIDTH, console.width)
    print_rows(table, width)
    console.print()
    said = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    for word, meaning in words.items():
        said.add_row(word, meaning)
    print_rows(said, width)


def print_stale(results: Sequence[Made]) -> None:
    """Say of which scenes figures of cores are no longer stated, and how to measure them anew."""
    for result in results:
        for core in result.stale:
            scene = result.costs[0].scene
            console.print(
                f"{scene}: what is kept of {core} is of other C and not stated;"
                f" `derive check --target {core} --keep {scene}` measures it anew",
                highlight=False,
                soft_wrap=True,
            )


def usual(results: Sequence[Made]) -> tuple[Table, Mapping[str, str]]:
    """Return operations and errors on the declared ranges."""
    table = _columns("median", "largest")
    rows = [row for result in results for row in result.costs]
    for row in _headed(table, rows):
        numbers = [number for each in row.errors for number in each[:2]]
        table.add_row(f"  {row.function}", *_cells(row, numbers))
    return table, _counted(rows) | ON_RANGES


def full(results: Sequence[Made]) -> tuple[Table, Mapping[str, str]]:
    """Return errors at hard samples too, and what each answer was found not to need."""
    table = _columns("median", "largest", "hard")
    rows = [row for result in results for row in result.costs]
    spared = {(s.scene, s.function): s for result in results for s in result.savings}
    for row in _headed(table, rows):
        numbers = [number for each in row.errors for number in each]
        table.add_row(f"  {row.function}", *_cells(row, numbers))
        for line in _spared(spared.get((row.scene, row.function))):
            table.add_row(Padding(line, (0, 0, 0, 4)))
    return table, _counted(rows) | ON_RANGES | SPARED


def _columns(*errors: str) -> Table:
    table = Table(box=None, padding=(0, 1), collapse_padding=True)
    table.add_column("function", overflow="fold")
    for name in ("+ - * /", "/"):
        table.add_column(name, justify="right", no_wrap=True)
    for precision in ("float:", "double:"):
        for place, name in enumerate(errors):
            over = "" if place else precision
            table.add_column(f"{over}\n{name}", justify="right", no_wrap=True)
    return table


def _headed(table: Table, rows: Sequence[CostRow]) -> Iterable[CostRow]:
    """Yield the rows, each scene's name in a line before them."""
    scene = ""
    for row in rows:
        if row.scene != scene:
            scene = row.scene
            table.add_row(scene, style="bold")
        yield row


def _cells(row: CostRow, errors: Sequence[float]) -> list[str]:
    return [str(row.flops), str(row.divisions), *(f"{number:.2g}" for number in errors)]


def _spared(saving: Saving | None) -> list[str]:
    if saving is None:
        return []
    lists = {"left out": saving.unknowns, "cancels": saving.cancels}
    lines = [f"{word}: {' '.join(names)}" for word, names in lists.items() if names]
    return lines if saving.plain is None else [*lines, f"body by body: {saving.plain}"]


def _counted(rows: Sequence[CostRow]) -> dict[str, str]:
    """Return the words on costs, with what a u is a part of for each kind of function shown."""
    named: dict[str, dict[str, None]] = {}
    for row in rows:
        named.setdefault(row.of, {})[row.function] = None
    of = "; ".join(f"{what} ({_few([*names])})" for what, names in named.items())
    return COSTS | {"u": COSTS["u"] + of}


def _few(names: Sequence[str]) -> str:
    more = ", ..." if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more
