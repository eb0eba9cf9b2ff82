"""The command line: derive lecture | generate | check | report | bench | scenes.

Exit code 0: done. 1: something differs or fails its check. 2: the input is bad, and one sentence
says what, by which rule, and what was found.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from pathlib import Path

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

from derive import __version__
from derive.check import check as checks
from derive.check.compiler import CompilerError
from derive.files import OutputError, differences, require_writable, write
from derive.generation import Made, all_made, gallery_of, lecture_made
from derive.lecture import LECTURE
from derive.notation import expression_text
from derive.prove import ProofError
from derive.saving import Saving
from derive.scene import SceneError, catalogue, load
from derive.solve.command import options as solve_options
from derive.solve.command import solved
from derive.step import first_fall, verify

OUT = Path("generated")
STOPPED = 130  # what a shell expects after an interrupt
WIDE = 150  # columns of a table that goes to a file or a pipe
console = Console(width=None if sys.stdout.isatty() else WIDE)
errors = Console(stderr=True, width=None if sys.stderr.isatty() else WIDE)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    options = parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = options.run
    try:
        return command(options)
    except (SceneError, OutputError, ProofError, CompilerError) as error:
        errors.print(f"derive: {error}", style="red", highlight=False, markup=False)
        return 2
    except KeyboardInterrupt:
        errors.print("derive: stopped; nothing was half-written")
        return STOPPED


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    top = argparse.ArgumentParser(
        prog="derive",
        description="Equations of rotating rigid bodies: derived from particles, printed as"
        " checked C and CasADi.",
        epilog="A SCENE is a name from `derive scenes` or a path to a TOML file; none means the"
        " whole catalogue.",
    )
    top.add_argument("--version", action="version", version=f"derive {__version__}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    _lecture_options(commands.add_parser("lecture", help="verify the derivation step by step"))
    _generate_options(
        commands.add_parser("generate", help="write the C, CasADi, JSON and HTML of scenes")
    )
    _check_options(
        commands.add_parser(
            "check", help="compile what was emitted and compare it with ball arithmetic"
        )
    )
    _report_options(
        commands.add_parser("report", help="show what every function costs and how wrong it is")
    )
    _bench_options(
        commands.add_parser("bench", help="compare cost and error with peers, in one run")
    )
    answers = commands.add_parser("solve", help="evaluate the answers of a scene, roots included")
    solve_options(answers)
    answers.set_defaults(run=solve)
    scenes = commands.add_parser("scenes", help="list the catalogue")
    scenes.set_defaults(run=list_scenes)
    return top


def _lecture_options(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--without",
        metavar="REASON",
        help="drop one assumption; show the first step that falls and what is left over",
    )
    command.set_defaults(run=lecture)


def _generate_options(command: argparse.ArgumentParser) -> None:
    _scene_argument(command)
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
    command.set_defaults(run=generate)


def _check_options(command: argparse.ArgumentParser) -> None:
    _scene_argument(command)
    command.set_defaults(run=check)


def _report_options(command: argparse.ArgumentParser) -> None:
    _scene_argument(command)
    command.add_argument("--full", action="store_true", help="finer steps and longer runs")
    command.add_argument(
        "--only",
        nargs="+",
        default=[],
        metavar="NAME",
        help="run one case or section, print its figures and write nothing",
    )
    command.set_defaults(run=report)


def _bench_options(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--out", type=Path, default=None, metavar="FILE", help="also write the figures as JSON"
    )
    command.set_defaults(run=bench)


def _scene_argument(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "scenes", nargs="*", metavar="SCENE", help="catalogue name or path to a TOML file"
    )


def list_scenes(_: argparse.Namespace) -> int:
    """Print the catalogue: name, title, wanted functions."""
    table = Table("scene", "what it is", "functions", box=None)
    for name in catalogue():
        scene = load(name)
        table.add_row(name, scene.title, ", ".join(scene.wanted))
    console.print(table)
    return 0


def solve(options: argparse.Namespace) -> int:
    """Print the answers of a scene with their units."""
    table = Table("function", "answer", "value", "unit", box=None)
    for row in solved(options):
        table.add_row(*row)
    console.print(table)
    return 0


def progress() -> Progress:
    """Return a progress line that vanishes when it is done."""
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    return Progress(*columns, console=errors, transient=True)


def generate(options: argparse.Namespace) -> int:
    """Write, or with --check compare, the files of scenes."""
    results = _made(options.scenes, () if options.scenes else (lecture_made,))
    texts = {name: text for result in results for name, text in result.texts.items()}
    if not options.scenes:
        texts |= gallery_of(results)
    if options.check:
        return _compare(options, texts)
    write(options.out, texts)
    _print_costs(results)
    console.print(f"{len(texts)} files in {options.out}/")
    return 0


def report(options: argparse.Namespace) -> int:
    """Write the speed-against-error report; of scenes, only print what their functions cost."""
    if options.scenes:
        _print_costs(_made(options.scenes, ()))
        return 0
    from derive.report import command  # matplotlib and the peers are an extra

    try:
        return command.report(
            OUT, "full" if options.full else "small", options.only, console, progress()
        )
    except ImportError as absent:
        errors.print(f"derive: {absent}", style="red", highlight=False, markup=False)
        return 2


def _made(scenes: Sequence[str], also: Sequence[Callable[[], Made]]) -> list[Made]:
    sources = [str(source) for source in scenes or catalogue()]
    _distinct(sources)
    found: dict[int, Made] = {}
    with progress() as shown:
        task = shown.add_task("deriving, proving and measuring")
        for place, result in all_made(sources, also):
            found[place] = result
            done = f"{len(found)} of {len(sources) + len(also)} done"
            shown.update(task, description=f"deriving, proving and measuring: {done}")
    results = [found[place] for place in sorted(found)]
    for warning in (w for result in results for w in result.warnings):
        errors.print(f"derive: warning: {warning}", style="yellow", highlight=False, markup=False)
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


def _print_costs(results: Sequence[Made]) -> None:
    columns = ("float: median", "largest", "double: median", "largest")
    table = Table("scene", "function", "+ - * /", "div", *columns, box=None)
    for row in (row for result in results for row in result.costs):
        table.add_row(row.scene, row.function, str(row.flops), str(row.divisions), *row.errors)
    console.print(table)
    console.print("Errors in u (2^-24 float, 2^-53 double) of the largest term, sampled.")
    _print_savings([saving for result in results for saving in result.savings])


def _print_savings(savings: Sequence[Saving]) -> None:
    """Print what each answer of a machine was found not to need, and the operations it saves."""
    if not savings:
        return
    columns = ("unknowns left out", "cancels", "never enters", "+ - * /", "body by body")
    table = Table("scene", "function", *columns, box=None)
    for s in savings:
        plain = "" if s.plain is None else str(s.plain)
        lists = [" ".join(names) for names in (s.unknowns, s.cancels, s.absent)]
        table.add_row(s.scene, s.function, *lists, str(s.operations), plain)
    console.print(table)


def _compare(options: argparse.Namespace, texts: dict[str, str]) -> int:
    found = list(differences(options.out, texts))
    if not found:
        console.print(f"{len(texts)} files in {options.out}/ are what `derive generate` makes")
        return 0
    for difference in found:
        sys.stdout.write(difference.diff)
    command = " ".join(["derive generate", *options.scenes])
    if options.out != OUT:
        command += f" --out {options.out}"
    errors.print(
        f"derive: {len(found)} files differ from what would be generated; mend: {command}",
        style="red",
    )
    return 1


def lecture(options: argparse.Namespace) -> int:
    """Verify every step and print the table; or drop one assumption and show what falls."""
    if options.without is not None:
        return _without(options.without)
    with progress() as shown:
        shown.add_task("verifying the lecture")
        rows = verify(LECTURE)
    table = Table("step", "kind", "because of", "checked", box=None)
    for row in rows:
        verdict = "holds" if row.holds else f"FAILS: {row.fault}"
        table.add_row(row.name, row.kind, ", ".join(row.reasons), verdict)
    console.print(table)
    fallen = sum(not row.holds for row in rows)
    deduced = sum(row.kind == "deduce" for row in rows)
    seconds = sum(row.seconds for row in rows)
    console.print(f"{len(rows)} steps, {deduced} deduced, {fallen} failed, {seconds:.1f} s")
    return 1 if fallen else 0


def _without(reason: str) -> int:
    known = [step.name for step in LECTURE.steps if step.kind == "assume"]
    if reason not in known:
        near = get_close_matches(reason, known, n=1)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        raise SceneError(f"--without needs an assumption of the lecture, not '{reason}'{hint}")
    fall = first_fall(LECTURE, reason)
    if fall is None:
        console.print(f"Nothing in the lecture falls without '{reason}'.")
        return 0
    step, leftover = fall
    console.print(f"Without '{reason}' the first step that falls is '{step.name}': {step.says}")
    console.print(f"What is left over: {expression_text(leftover)}", highlight=False, markup=False)
    return 0


def check(options: argparse.Namespace) -> int:
    """Compile the emitted files and compare them with ball arithmetic and with each other."""
    table = Table("scene", "function", "in", "check", "verdict", "found", box=None)
    found: list[str] = []
    with progress() as shown:
        task = shown.add_task("finding a compiler")
        verdicts = checks(options.scenes or catalogue(), OUT)
        for count, v in enumerate(verdicts, 1):
            shown.update(task, description=f"{v.scene}: {v.function} ({count} checks)")
            found.append(v.outcome)
            table.add_row(v.scene, v.function, v.precision, v.check, v.outcome, v.says)
    console.print(table)
    failed, skipped = found.count("FAILS"), found.count("skipped")
    console.print(f"{found.count('holds')} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


def bench(options: argparse.Namespace) -> int:
    """Compare cost and error with the best hand-written forms and with peers, in one run."""
    from derive.bench import show  # the peers are an extra: nothing else needs them

    if options.out is not None:
        require_writable(options.out)
    return show.bench(OUT, options.out, console, progress())
