"""``derive report``: how fast and how wrong a scene's steps and functions are, as page and JSON."""

import argparse

from rich.progress import Progress, TaskID

import derive
from derive.command.parsed import location, seconds
from derive.command.scenes import scene_argument
from derive.command.terminal import OUT, console, progress
from derive.solve.several import require_posed


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive report``."""
    scene_argument(command)
    command.add_argument(
        "--until",
        type=seconds,
        metavar="SECONDS",
        help="the end at which errors of motion are taken (default: the scene's horizon, or else "
        "about ten turns)",
    )
    command.add_argument(
        "--out",
        type=location,
        default=OUT,
        metavar="DIR",
        help="folder to write to (default: generated)",
    )
    command.set_defaults(run=report)


def report(given: argparse.Namespace) -> int:
    """Write the reports of scenes, one after the other, so that nothing disturbs what is timed."""
    scenes = [derive.load(source) for source in given.scenes or derive.catalogue()]
    require_posed(scenes if given.scenes else [])
    for scene in scenes:
        with progress() as shown:
            task = shown.add_task(f"{scene.name}: deriving")

            def told(says: str, task: TaskID = task, shown: Progress = shown) -> None:
                shown.update(task, description=f"{scene.name}: {says}")  # noqa: B023 - called here

            found = scene.report(given.out, given.until, told)
        console.print(f"{scene.name}: {found.sentence}", highlight=False, soft_wrap=True)
        place = given.out / scene.name / scene.name
        console.print(f"  {place}_report.html, .json", highlight=False, soft_wrap=True)
    return 0
