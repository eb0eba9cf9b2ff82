"""``derive generate``: the files of scenes, written or compared with what lies there."""

import argparse
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

from derive.command.costs import print_costs
from derive.command.generation import (
    Made,
    all_made,
    gallery_of,
    lecture_made,
    made,
    made_with_savings,
    require_posed,
)
from derive.command.scenes import samples_argument, scene_argument
from derive.command.terminal import OUT, complain, console, error_console, progress
from derive.emit.files import (
    Difference,
    differences,
    folders_left_over,
    require_folder,
    unfinished,
    write,
)
from derive.scene import SceneError, catalogue
from derive.scene.escape import visible
from derive.verify.kept import Measuring
from derive.verify.search import SAMPLING, sampled_at


def options(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``derive generate``."""
    scene_argument(command)
    command.add_argument(
        "--out",
        type=Path,
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
        action="store_true",
        help="measure all errors anew, also those that are kept because nothing has changed",
    )
    samples_argument(command, SAMPLING.samples, "samples that each stated error is looked for at")
    command.set_defaults(run=generate)


def generate(given: argparse.Namespace) -> int:
    """Write, or with --check compare, the files of scenes."""
    require_folder(given.out)
    by = Measuring(sampled_at(given.samples), None if given.anew else given.out)
    making = partial(made if given.check else made_with_savings, measuring=by)
    results = made_of(given.scenes, () if given.scenes else (lecture_made,), making)
    texts = {name: text for result in results for name, text in result.texts.items()}
    if not given.scenes:
        texts |= gallery_of(results)
    if given.check:
        return _compare(given, texts)
    stopped = unfinished(given.out)
    write(given.out, texts)
    if stopped:
        complain(_mended(given.out, stopped), "yellow")
    print_costs(results)
    console.print(f"{len(texts)} files in {given.out}/")
    return 0


def _mended(folder: Path, stopped: Sequence[str]) -> str:
    """Return what is to be said of files that a run before this one was replacing."""
    says = f"derive: a run before this one was stopped while it replaced {len(stopped)} files"
    left = unfinished(folder)
    owners = ", ".join(dict.fromkeys(name.partition("/")[0] for name in left))
    still = f"{len(left)} are still to be made: generate again {owners}"
    more = still if left else "all are new now"
    return f"{says}; {more}"


def made_of(
    scenes: Sequence[str], also: Sequence[Callable[[], Made]], making: Callable[[str], Made]
) -> list[Made]:
    """Return what scenes become, none meaning all, and what is made also; print the warnings."""
    sources = [str(source) for source in scenes or catalogue()]
    _distinct(sources)
    require_posed(scenes)
    tasks: list[Callable[[], Made]] = [*(partial(making, source) for source in sources), *also]
    found: dict[int, Made] = {}
    with progress() as shown:
        task = shown.add_task("deriving, proving and measuring")
        for place, result in all_made(tasks):
            found[place] = result
            done = f"{len(found)} of {len(tasks)} done"
            shown.update(task, description=f"deriving, proving and measuring: {done}")
    results = [found[place] for place in sorted(found)]
    for warning in (w for result in results for w in result.warnings):
        complain(f"derive: warning: {warning}", "yellow")
    return results


def _distinct(sources: Sequence[str]) -> None:
    """Refuse two scenes of one name: their files would lie over each other."""
    named: dict[str, str] = {}
    for source in sources:
        name = Path(source).stem
        if name in named:
            raise SceneError(
                f"scenes must have names of their own, but '{named[name]}' and '{source}' "
                f"are both '{name}'"
            )
        named[name] = source


def _compare(given: argparse.Namespace, texts: Mapping[str, str]) -> int:
    """Print how the files differ from ``texts``, and the commands that mend it."""
    found = list(differences(given.out, texts))
    if not given.scenes:
        found += folders_left_over(given.out, texts)
    if not found:
        console.print(f"{len(texts)} files in {given.out}/ are what `derive generate` makes")
        return 0
    for difference in found:
        sys.stdout.write(difference.diff)
    count = "1 file differs" if len(found) == 1 else f"{len(found)} files differ"
    error_console.print(f"derive: {count} from what would be generated; mend:", style="red")
    for command in _mending(given, found):
        error_console.print(visible(command), style="red", highlight=False, soft_wrap=True)
    return 1


def _mending(given: argparse.Namespace, found: Sequence[Difference]) -> list[str]:
    """Return what makes files again that differ, and deletes those that no scene makes."""
    commands = []
    if not all(difference.left_over for difference in found):
        out = [] if given.out == OUT else ["--out", str(given.out)]
        few = given.samples != SAMPLING.samples
        samples = ["--samples", str(given.samples)] if few else []
        commands.append(shlex.join(["derive", "generate", *given.scenes, *samples, *out]))
    left = [str(given.out / difference.name) for difference in found if difference.left_over]
    return [*commands, *([shlex.join(["rm", *left])] if left else [])]
