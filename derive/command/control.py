"""``derive control``: inputs that bring a scene where it is to go, at the least cost."""

import argparse
from collections.abc import Iterator
from typing import Any

from rich.table import Table

import derive
from derive.command.parsed import location, seconds, whole
from derive.command.solve import values_named
from derive.command.terminal import complain, console, print_rows, progress
from derive.control.direct import SOLVERS, TRANSCRIPTIONS
from derive.control.steering import COARSE, FINEST, MOST_STARTS, STARTS, STEPS
from derive.control.task import costs_of


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive control``."""
    command.add_argument("scene", metavar="SCENE", help="catalogue name or path to a TOML file")
    several: dict[str, Any] = {
        "action": "extend",
        "nargs": "+",
        "default": [],
        "metavar": "NAME=VALUE",
    }
    command.add_argument(
        "--set",
        help="parameters, inputs that are held, states at the start (others are 0), in SI units",
        **several,
    )
    command.add_argument(
        "--turn",
        default="",
        metavar="'AXIS ANGLE'",
        help="to rest, turned about an axis of the body at the start: 'z 180deg', '1,2,2 2'",
    )
    command.add_argument("--end", help="states at the end, those that matter", **several)
    command.add_argument(
        "--limit",
        help="of inputs, states, and what functions tell of them, as angular_momentum: moment=0.4 "
        "is -0.4 to 0.4, u=0..2 what it says (inputs without one keep to their declared ranges, if "
        "the cost is time alone)",
        **several,
    )
    command.add_argument(
        "--avoid",
        action="append",
        default=[],
        metavar="'AXIS DIRECTION ANGLE'",
        help="keep an axis of the body off a direction of the inertial frame: 'x 0,0,1 30deg'",
    )
    command.add_argument(
        "--cost",
        help="weights: time=1 (default), energy=1 is the integral of the inputs' squares",
        **several,
    )
    command.add_argument(
        "--until",
        type=seconds,
        metavar="SECONDS",
        help="the time at the end, or where the cost counts it the first guess of it",
    )
    for name, kept, most, says in (
        ("steps", STEPS, FINEST, "steps of the grid, at least"),
        ("starts", STARTS, MOST_STARTS, "first guesses: a straight one, and others perturbed"),
    ):
        says = f"{says} (default: {kept})"
        command.add_argument(f"--{name}", type=whole(most), default=kept, metavar="N", help=says)
    for name, words in (("method", TRANSCRIPTIONS), ("solver", tuple(SOLVERS))):
        says = f"{' or '.join(words)} (default: {words[0]})"
        command.add_argument(f"--{name}", default=words[0], metavar="WORD", help=says)
    command.add_argument(
        "--out",
        type=location,
        metavar="DIR",
        help="folder for the trajectory: a table (CSV), and a plot",
    )
    command.set_defaults(run=control)


def control(given: argparse.Namespace) -> int:
    """Print what was found; write the trajectory, if a folder is named."""
    scene = derive.load(given.scene)
    values = values_named(given.set)
    cost = costs_of(values_named(given.cost, "--cost", "energy=1")) or None
    with progress() as shown:
        task = shown.add_task(scene.name)
        trajectory = derive.steer(
            scene, values, given.turn, values_named(given.end, "--end", "theta=0"),
            values_named(given.limit, "--limit", "moment=0.4"), given.avoid, cost, given.until,
            given.steps, given.starts, given.method, given.solver, given.out,
            lambda says: shown.update(task, description=f"{scene.name}: {says}"),
        )  # fmt: skip
    for doubt in trajectory.doubts:
        complain(f"derive: warning: {doubt}", "yellow")
    table = Table("what", "value", "", box=None)
    for row in _rows(trajectory):
        table.add_row(*row)
    print_rows(table)
    for name in trajectory.files() if given.out is not None else ():
        console.print(f"  {given.out / name}", highlight=False, soft_wrap=True)
    return 0


def _rows(trajectory: derive.Trajectory) -> Iterator[tuple[str, str, str]]:
    many = len(trajectory.found)
    yield "time at the end", f"{trajectory.until:.10g}", "s"
    yield "cost", f"{trajectory.cost:.10g}", ""
    for cost, count in trajectory.minima:
        yield "a local minimum", f"{cost:.6g}", f"from {count} of {many} starts, {COARSE} steps"
    if trajectory.found[0] is not None:
        yield "the straight start", f"{trajectory.found[0]:.6g}", "where the first guess led"
    if lost := trajectory.found.count(None):
        yield "no end", "", f"from {lost} of {many} starts"
    yield "on the grid", f"{trajectory.grid.cost:.10g}", f"{trajectory.grid.u.shape[1]} steps"
    yield "misses the end by", f"{trajectory.missed:.1e}", "its inputs flown from the start"
    if trajectory.conditions is None:
        yield "not refined", "", trajectory.unrefined
        return
    says = "how far it varies, a part of the running cost"
    yield "Hamiltonian", f"{trajectory.conditions.hamiltonian:.1e}", says
    says = "the largest slope of the Hamiltonian of a wrong sign, a part of the largest"
    yield "switching", f"{trajectory.conditions.against:.1e}", says
    for at, name, where in trajectory.switches:
        yield name, f"{at:.9f}", f"s: {where}"
