"""``derive generate``: the files of scenes, written or compared with what lies there."""

import argparse
import shlex
import sys
from collections.abc import Callable, Sequence

from rich.progress import Progress

import derive
from derive.command import packaged
from derive.command.costs import full, print_costs, print_stale, usual
from derive.command.parsed import location
from derive.command.scenes import samples_argument, scene_argument
from derive.command.solve import values_named
from derive.command.terminal import OUT, complain, console, error_console, progress
from derive.scene.escape import visible
from derive.solve.fixed import fix, try_ranges
from derive.solve.generation import CASADI, OVER_MEMBERS, STATED, extent_of
from derive.solve.handle import Handle

VIEWS = {"costs": usual, "savings": full}
MEASURING = "deriving, proving and measuring"


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive generate``."""
    scene_argument(command)
    command.add_argument(
        "--out",
        type=location,
        default=OUT,
        metavar="DIR",
        help="folder to write to (default: generated)",
    )
    command.add_argument(
        "--check",
        action="store_true",
        help="write nothing; exit 1 with a diff if the files are not what would be written",
    )
    command.add_argument(
        "--anew",
        action="store_const",
        dest="figures",
        const="anew",
        default="kept",
        help="measure all errors anew, also those that are kept because nothing has changed",
    )
    command.add_argument(
        "-v",
        "--verbose",
        action="store_const",
        dest="tell",
        const="savings",
        default="costs",
        help="show errors at hard samples too, and what each answer was found not to need",
    )
    command.add_argument(
        f"--{CASADI}",
        action="append_const",
        dest="parts",
        const=CASADI,
        default=[],
        help="write C, too, by which CasADi takes all steps of a horizon in one call",
    )
    command.add_argument(
        f"--{OVER_MEMBERS}",
        action="append_const",
        dest="parts",
        const=OVER_MEMBERS,
        help="write C, too, of every function over many members, which compilers make vectors of",
    )
    samples_argument(command, STATED, "samples that each stated error is looked for at")
    command.add_argument(
        "--check-ranges",
        action="store_const",
        dest="ranges",
        const="tried",
        default="told",
        help="set-up also refuses parameters outside of their declared ranges, of scenes named",
    )
    command.add_argument(
        "--fixed",
        action="append",
        default=[],
        metavar="NAME=VALUE,...",
        help="values of all parameters of one scene: its C has a table of constants and no set-up",
    )
    packaged.options(command)
    command.set_defaults(run=generate)


def generate(given: argparse.Namespace) -> int:
    """Write, or with --check compare, the files of scenes; with --package a package of one."""
    packaged.require_sense(given)
    if given.check:
        return _compare(given)
    scenes = _scenes(given)
    with progress() as shown:
        told = telling(shown)
        made = (
            packaged.made(scenes[0], given, told)
            if given.package
            else derive.generate(
                scenes,
                given.out,
                given.samples,
                given.figures,
                given.tell,
                told,
                extent_of(given.parts),
            )
        )
    warn(made.warnings)
    if made.stopped:
        complain(mended(made), "yellow")
    print_costs(made.made, VIEWS[given.tell])
    if given.tell == "savings":
        print_stale(made.made)
    console.print(f"{len(made.files)} files in {made.folder}/")
    return 0


def _scenes(given: argparse.Namespace) -> list[Handle]:
    """Return the scenes that were named, one of them with fixed parameters if any are."""
    scenes = [derive.load(source) for source in given.scenes]
    if given.ranges == "tried":
        if not scenes:
            raise derive.DeriveError("generate: --check-ranges takes scenes, but none was named")
        scenes = [try_ranges(scene) for scene in scenes]
    if not given.fixed:
        return scenes
    if len(scenes) != 1:
        said = f"{len(scenes)} were named" if scenes else "none was named"
        raise derive.DeriveError(f"generate: --fixed takes one scene, but {said}")
    texts = [text for several in given.fixed for text in several.split(",")]
    return [fix(scenes[0], values_named(texts, "--fixed", "m=2,d=0.06"))]


def telling(shown: Progress) -> Callable[[str], None]:
    """Return what shows how far scenes are."""
    task = shown.add_task(MEASURING)
    return lambda says: shown.update(task, description=f"{MEASURING}: {says}")


def warn(warnings: Sequence[str]) -> None:
    """Print what readers of scenes should be told."""
    for warning in warnings:
        complain(f"derive: warning: {warning}", "yellow")


def mended(made: derive.Generation) -> str:
    """Return what is to be said of files that a run before this one was replacing."""
    says = f"derive: a run before this one was stopped while it replaced {len(made.stopped)} files"
    owners = ", ".join(dict.fromkeys(name.partition("/")[0] for name in made.left))
    still = f"{len(made.left)} are still to be made: generate again {owners}"
    more = still if made.left else "all are new now"
    return f"{says}; {more}"


def _compare(given: argparse.Namespace) -> int:
    """Print how the files differ from what scenes become, and the commands that mend it."""
    scenes = _scenes(given)
    with progress() as shown:
        made = derive.compare(
            scenes, given.out, given.samples, given.figures, telling(shown), extent_of(given.parts)
        )
    warn(made.warnings)
    if not made.differences:
        console.print(f"{made.files} files in {given.out}/ are what `derive generate` makes")
        return 0
    for difference in made.differences:
        sys.stdout.write(difference.diff)
    count = len(made.differences)
    files = "1 file differs" if count == 1 else f"{count} files differ"
    error_console.print(f"derive: {files} from what would be generated; mend:", style="red")
    for command in _mending(given, made.differences):
        error_console.print(visible(command), style="red", highlight=False, soft_wrap=True)
    return 1


def _mending(given: argparse.Namespace, found: Sequence[derive.Difference]) -> list[str]:
    """Return what makes files again that differ, and deletes those that no scene makes."""
    commands = []
    if not all(difference.left_over for difference in found):
        out = [] if given.out == OUT else ["--out", str(given.out)]
        few = given.samples != STATED
        samples = ["--samples", str(given.samples)] if few else []
        wider = [f"--{part}" for part in dict.fromkeys(given.parts)]
        tried = ["--check-ranges"] if given.ranges == "tried" else []
        more = [*samples, *tried, *(f"--fixed={text}" for text in given.fixed), *out, *wider]
        commands.append(shlex.join(["derive", "generate", *given.scenes, *more]))
    left = [str(given.out / difference.name) for difference in found if difference.left_over]
    return [*commands, *([shlex.join(["rm", *left])] if left else [])]
