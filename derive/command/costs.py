"""Tables of what functions cost, how wrong they are, and what machines were spared."""

from collections.abc import Sequence

from rich.table import Table

from derive.command.generation import Made
from derive.command.terminal import console
from derive.library.saving import Saving


def print_costs(results: Sequence[Made]) -> None:
    """Print the operations and errors of every function, then what was found not to matter."""
    columns = ("float: median", "largest", "double: median", "largest")
    table = Table("scene", "function", "+ - * /", "div", *columns, box=None)
    for row in (row for result in results for row in result.costs):
        table.add_row(row.scene, row.function, str(row.flops), str(row.divisions), *row.errors)
    console.print(table)
    console.print(
        "Errors in u (2^-24 float, 2^-53 double) of the largest product, sampled; of motions and"
        " attitudes, of the largest component, by rounding alone; of flow_exact, of kappa times it."
    )
    _print_savings([saving for result in results for saving in result.savings])


def _print_savings(savings: Sequence[Saving]) -> None:
    """Print what each answer of a machine was found not to need, and the operations it saves."""
    if not savings:
        return
    columns = ("unknowns left out", "cancels", "+ - * /", "body by body")
    table = Table("scene", "function", *columns, box=None)
    for s in savings:
        plain = "" if s.plain is None else str(s.plain)
        lists = [" ".join(names) for names in (s.unknowns, s.cancels)]
        table.add_row(s.scene, s.function, *lists, str(s.operations), plain)
    console.print(table)
