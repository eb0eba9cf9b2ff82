"""``derive solve``: the answers of a scene, its limits and motions, from the command line."""

import argparse
import shlex
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet

from rich.table import Table

import derive
from derive.command.parsed import location, seconds, typed
from derive.command.terminal import complain, console, print_rows
from derive.solve.handle import STEP
from derive.solve.onto_constraints import held_example

Printed = tuple[str, str, str, str]
"""What, where from, its value and its unit."""
NOWHERE = "none in its range"
BY = "step_rk4"


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive solve``."""
    command.add_argument("scene", metavar="SCENE", help="catalogue name or path to a TOML file")
    command.add_argument(
        "--set",
        action="append",
        nargs="+",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter or input, in SI units, or as 3deg or 5000rpm",
    )
    command.add_argument(
        "--limit",
        action="append",
        default=[],
        metavar="NAME",
        help="find the values of NAME, in its range, at which stability changes",
    )
    command.add_argument(
        "--until", type=seconds, metavar="SECONDS", help="move in time by a step of the scene's"
    )
    command.add_argument(
        "--step",
        type=seconds,
        metavar="SECONDS",
        help=f"longest step, of which --until is a multiple ({STEP:g})",
    )
    command.add_argument("--by", metavar="NAME", help=f"that step ({BY})")
    command.add_argument(
        "--stop",
        metavar="EQUATION",
        help="end where this is met first, as 'theta = 0', of the state and answers (with --until)",
    )
    command.add_argument(
        "--plot", type=location, metavar="FILE", help="write the motion as SVG (with --until)"
    )
    command.set_defaults(run=solve)


def solve(given: argparse.Namespace) -> int:
    """Print the answers of a scene with their units; refuse at the end what has no values."""
    _require_one_question(given)
    scene = derive.load(given.scene)
    values = values_named([text for group in given.set for text in group])
    if given.until is not None or given.limit:
        ask = _limits if given.limit else _simulated
        rows, doubts = ask(scene, given, values)
        _print(rows, (*scene.doubts(values), *doubts))
        return 0
    found = scene.solve(values)
    if found.unanswered and not values:
        _print_quantities(scene, {c for own in found.unanswered.values() for c in own})
    rows = [(row.of, row.name, f"{row.value:.12g}", row.unit) for row in found.rows]
    _print(rows if rows or not found.unanswered else None, found.doubts)
    if found.unanswered and not values:
        names = ", ".join(f"'{name}'" for name in found.unanswered)
        need = "needs them" if len(found.unanswered) == 1 else "need them"
        raise derive.DeriveError(f"set values by --set, as the example does: {names} {need}")
    if found.unanswered:
        each = [f"'{name}' needs {', '.join(own)}" for name, own in found.unanswered.items()]
        raise derive.DeriveError(f"set values by --set: {'; '.join(each)}")
    return 0


def _print_quantities(scene: derive.Handle, needed: AbstractSet[str]) -> None:
    """Print what answers need, with ranges, and a command that sets all of it."""
    table = Table("name", "from", "to", "unit", "meaning", box=None)
    own = {c: q for q in scene.quantities for c in q.components}
    lasting = scene.scene.steady
    each = [lasting[name].unknown for name in scene.wanted if name in lasting]
    found = {n for unknown in each for n in unknown}
    values: dict[str, str] = {}
    for name in (name for name in own if name in needed | found):
        q = own[name]
        low, high = (0.0 if end is None else float(end) for end in (q.low, q.high))
        says = f"{q.meaning}; found if it is not set" if name in found else q.meaning
        table.add_row(name, f"{low:g}", f"{high:g}", "" if q.unit == "1" else q.unit, says)
        if not each or name not in each[0]:  # others that are sought, one of which rests on it
            values[name] = example(low, high, name if q.is_quaternion else "")
    print_rows(table)
    each_set = (f"{name}={x}" for name, x in held_example(scene.library, values).items())
    command = ["derive", "solve", scene.source, "--set", *each_set]
    console.print(f"\nfor example: {shlex.join(command)}", highlight=False, soft_wrap=True)


def example(low: float, high: float, part: str) -> str:
    """Return a short number in a range; of a quaternion's part, that of no turn."""
    if part:
        return "1" if part.endswith("_w") else "0"
    middle = (low + high) / 2
    short = (float(f"{middle:.{digits}g}") for digits in (2, 3, 6))
    found = next((x for x in short if low <= x <= high), middle) + 0.0  # no -0
    return repr(found).removesuffix(".0")


def _print(rows: Sequence[Printed] | None, doubts: Sequence[str]) -> None:
    """Print warnings, then a table of rows, None for none."""
    for doubt in doubts:
        complain(f"derive: warning: {doubt}", "yellow")
    if rows is not None:
        table = Table("function", "answer", "value", "unit", box=None)
        for of, name, value, unit in rows:
            table.add_row(of, name, value, "" if unit == "1" else unit)
        print_rows(table)


def values_named(
    texts: Sequence[str], option: str = "--set", example: str = "m=1200"
) -> dict[str, str]:
    """Return the texts of values by name, of a list such as ``m=1200 skew=3deg``.

    Raises DeriveError for what is not of this form, and for a name that is set twice.
    """
    values: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not (equals and name.strip()):
            raise derive.DeriveError(f"{option} takes NAME=VALUE, as {example}, not {typed(text)}")
        if name.strip() in values:
            raise derive.DeriveError(f"{option} {text[:60]}: '{name.strip()}' is set twice")
        values[name.strip()] = value
    return values


def _require_one_question(given: argparse.Namespace) -> None:
    if given.plot is not None and given.until is None:
        rule = "a plot shows a motion and needs --until SECONDS"
        raise derive.DeriveError(f"--plot {given.plot}: {rule}")
    if given.step is not None and given.until is None:
        rule = "a step is of a motion and needs --until SECONDS"
        raise derive.DeriveError(f"--step {given.step:g}: {rule}")
    if given.by is not None and given.until is None:
        rule = "a step moves in time and needs --until SECONDS"
        raise derive.DeriveError(f"--by {typed(given.by)}: {rule}")
    if given.stop is not None and given.until is None:
        rule = "an event ends a motion and needs --until SECONDS"
        raise derive.DeriveError(f"--stop {typed(given.stop)}: {rule}")
    if given.limit and given.until is not None:
        rule = f"limits of stability are no motion; leave out --until {given.until:g}"
        raise derive.DeriveError(f"--limit {given.limit[0]}: {rule}")


def _simulated(
    scene: derive.Handle, given: argparse.Namespace, values: Mapping[str, str]
) -> tuple[list[Printed], tuple[str, ...]]:
    """Return the state at the end of a motion, and warnings; write its plot to a named file."""
    step = STEP if given.step is None else given.step
    by = BY if given.by is None else given.by
    motion = scene.simulate(values, given.until, step, given.plot, given.stop, by)
    digits = 6 if given.stop is None else 12
    at = f"at {motion.times[-1]:.{digits}g} s"
    rows = [(at, n, f"{v[-1]:z.12g}", motion.units[n]) for n, v in motion.states.items()]
    rows += [("largest on the way", name, f"{off:.2g}", "") for name, off in motion.left]
    return rows, motion.doubts


def _limits(
    scene: derive.Handle, given: argparse.Namespace, values: Mapping[str, str]
) -> tuple[list[Printed], tuple[str, ...]]:
    unit = {c: q.unit for q in scene.quantities for c in q.components}
    rows: list[Printed] = []
    for name in given.limit:
        each = [f"{v:z.12g}" for v in scene.limits(values, name)]
        rows += [("limit of stability", name, v, unit.get(name, "")) for v in each or [NOWHERE]]
    return rows, ()
