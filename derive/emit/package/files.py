"""All files of a package, made in memory: the C, a test, examples, and what build tools read."""

from collections.abc import Mapping, Sequence

from derive.emit.c.columns import within_columns
from derive.emit.c.example import example, variable
from derive.emit.c.signature import CNames
from derive.emit.c.source import first_line
from derive.emit.package.kinds import BUILD_TOOLS, Contents, rendered
from derive.emit.package.single import single_header, single_name
from derive.emit.package.tested import tested
from derive.library.library import Library
from derive.program.arithmetic import LIBM, TURNS
from derive.program.precision import MATH, PRECISIONS, Precision
from derive.program.program import Measurement, Program

MOST = 9
"""Results that an example prints."""


def package_files(
    library: Library,
    texts: Mapping[str, str],
    figures: Sequence[Measurement],
    kinds: Sequence[str],
    precisions: Sequence[Precision],
) -> dict[str, str]:
    """Return path and text of every file of a package.

    texts   : the scene's C files by name        figures : what they state of errors
    kinds   : the build tools that it is for     precisions : in which it computes
    """
    of = _contents(library, figures, kinds, precisions)
    names, line = CNames(of.scene), of.first_line
    found = {f"src/{file}": texts[file] for ending in "hc" for file in of.files(ending)}
    for p in of.precisions:
        pair = (texts[names.file(p, "h")], texts[names.file(p, "c")])
        found[f"single/{single_name(of.scene, p)}"] = single_header(of.scene, p, *pair)
        found[f"test/{of.scene}_test_{p.name}.c"] = tested(library, p, line)
    found |= {
        f"test/{of.scene}_test.h": within_columns(rendered("test.h", of)),
        "test/main.c": within_columns(rendered("main.c", of)),
        "examples/example_main.c": _example("example_main.c", library, of),
        "README.md": rendered("README.md", of),
    }
    if "arduino" in kinds:
        found[f"examples/{of.scene}/{of.scene}.ino"] = _example("sketch.ino", library, of)
    return found | {name: text for kind in kinds for name, text in BUILD_TOOLS[kind](of).items()}


def _contents(
    library: Library,
    figures: Sequence[Measurement],
    kinds: Sequence[str],
    precisions: Sequence[Precision],
) -> Contents:
    every = {kind for program in library.in_c() for kind in program.count}
    called = {kind for p in library.printed() if p.arithmetic != "pairs" for kind in p.count}
    options = ["--package DIR"]
    options += [f"--precision {p.scalar}" for p in precisions if len(precisions) == 1]
    options += [f"--for {','.join(kinds)}"] if len(kinds) < len(BUILD_TOOLS) else []
    return Contents(
        library.scene.name,
        library.scene.title,
        tuple(p for p in PRECISIONS if p in precisions),
        first_line(library, figures, options),
        bool(every & {*MATH}),
        bool(called & (LIBM | TURNS)),
        tuple(kinds),
    )


def _example(template: str, library: Library, of: Contents) -> str:
    """Return a program that calls the first function, on boards in float if the package has it."""
    names = CNames(of.scene)
    precision = of.precisions[0 if template == "sketch.ino" else -1]
    text = rendered(
        template,
        of,
        header=names.file(precision, "h"),
        lines=example(library, names, precision),
        results=_results(library.printed()[0]),
        digits=precision.digits - 3,
    )
    return within_columns(text)


def _results(program: Program) -> list[dict[str, str]]:
    """Return the first results of a function, and what C calls them."""
    return [
        {"says": name, "value": variable(q) + (f"[{i}]" if q.shape else "")}
        for q in program.outputs
        for i, name in enumerate(q.components)
    ][:MOST]
