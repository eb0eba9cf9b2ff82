"""The C files of a scene's functions over many members: what they declare, and what they hold."""

from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from typing import Any

from derive.emit.c.aside import put_aside
from derive.emit.c.batch import is_prepared
from derive.emit.c.columns import within_columns
from derive.emit.c.comment import wrapped
from derive.emit.c.members import (
    IN_COMMON,
    MEMBERS_KEPT,
    OverMembers,
    Sets,
    is_in_vectors,
    lane,
    members_definition,
    members_prototype,
    members_symbol,
)
from derive.emit.c.members_setup import setup_definition, setup_prototype
from derive.emit.c.scope import require_no_symbol
from derive.emit.c.signature import CNames
from derive.emit.c.sines import numbers_of_sines, sines_type, takes_sines
from derive.emit.c.source import first_line
from derive.emit.operators import literal
from derive.emit.sines import TOGETHER
from derive.emit.templates import TEMPLATES
from derive.library.library import Library
from derive.program.precision import MATH, PRECISIONS, Precision
from derive.program.program import Measurement, Program

OVER_MEMBERS = "batch"
"""The option of ``derive generate`` that prints them."""
VECTOR_OPTIONS = ("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math")
"""By which compilers make vectors of them; no option changes a bit."""


def members_files(library: Library, figures: Sequence[Measurement]) -> dict[str, str]:
    """Return name and text of the C files over members, both precisions."""
    files: dict[str, str] = {}
    for precision in PRECISIONS:
        names = CNames(f"{library.scene.name}_{OVER_MEMBERS}")
        header, source = _header(library, precision, figures), _source(library, precision, figures)
        every = [q for p in (library.setup, *library.printed()) for q in (*p.inputs, *p.outputs)]
        require_no_symbol(library.scene.name, [q.name for q in every], header + source)
        files |= {names.file(precision, "h"): header, names.file(precision, "c"): source}
    return files


def members_of(library: Library, program: Program, precision: Precision) -> list[OverMembers]:
    """Return a function with one set of constants for all, and with one for every member."""
    return [
        OverMembers(program, library.scene.name, precision, s) for s in sets_of(library, program)
    ]


def sets_of(library: Library, program: Program) -> tuple[Sets, ...]:
    """Return in which ways members may have constants."""
    own = is_prepared(program) and not library.fixed
    return ("shared", "each") if own else ("shared",)


def batch_described(library: Library) -> dict[str, Any]:
    """Return what the JSON says of functions over members: all that a caller must know."""
    names, scene = CNames(f"{library.scene.name}_{OVER_MEMBERS}"), library.scene.name
    files = {p.name: {"header": names.file(p, "h"), "source": names.file(p, "c")}
             for p in PRECISIONS}  # fmt: skip
    found = [_described(library, p) for p in library.printed()]
    if library.setup in library.in_c():
        given = ["members", "stride", *(q.name for q in library.setup.inputs)]
        symbols = {p.name: members_symbol(scene, "setup", p) for p in PRECISIONS}
        found.insert(0, {
            "name": "setup", "symbols": symbols, "arguments": [*given, "constants", "status"],
            "returns": "ptrdiff_t: the number of members that set-up refuses",
        })  # fmt: skip
    layout = "component c of member k at [c * stride + k]; constants of members in that way too"
    return {
        "files": files,
        "layout": layout,
        "common": list(IN_COMMON),
        "options": list(VECTOR_OPTIONS),
        "functions": found,
    }


def _described(library: Library, program: Program) -> dict[str, Any]:
    names = [q.name for q in (*program.inputs, *program.outputs)]
    symbols = {
        s: {p.name: members_symbol(library.scene.name, program.name, p, s) for p in PRECISIONS}
        for s in sets_of(library, program)
    }
    return {
        "name": program.name,
        "symbols": symbols["shared"],
        "each": symbols.get("each"),
        "arguments": ["members", "stride", *names],
        "vectors": is_in_vectors(program),
    }


def _header(library: Library, precision: Precision, figures: Sequence[Measurement]) -> str:
    scene = library.scene
    names, batch = CNames(scene.name), CNames(f"{scene.name}_{OVER_MEMBERS}")
    found = []
    if library.setup in library.in_c():
        says = "Make the constants of every member; return how many set-up refuses, and say which."
        found.append((says, setup_prototype(library.setup, scene.name, precision)))
    for program in library.printed():
        says = program.says
        if not is_in_vectors(program):
            says += " One member after another."
        for n, of in enumerate(members_of(library, program, precision)):
            found.append(("The same, every member with constants of its own." if n else says,
                          members_prototype(of)))  # fmt: skip
    return within_columns(
        TEMPLATES.get_template("members.h.jinja").render(
            first_line=f"/* {first_line(library, figures, (f'--{OVER_MEMBERS}',))}",
            title=scene.title,
            header=names.file(precision, "h"),
            own=batch.file(precision, "h"),
            guard=batch.file(precision, "h").upper().replace(".", "_"),
            constants=bool(library.constants) and not library.fixed,
            aside=put_aside(library.emitted()),
            struct=f"{scene.name}_constants_{precision.name}",
            scalar=precision.scalar,
            functions=[(wrapped(says), prototype) for says, prototype in found],
        )
    )


def _source(library: Library, precision: Precision, figures: Sequence[Measurement]) -> str:
    scene, batch = library.scene.name, CNames(f"{library.scene.name}_{OVER_MEMBERS}")
    texts = []
    if library.setup in library.in_c():
        texts.append(setup_definition(library.setup, scene, precision))
    for program in library.printed():
        both = members_of(library, program, precision)
        if is_in_vectors(program):
            texts.append(lane(both[0]))
        texts += map(members_definition, both)
    vectors = [p for p in library.printed() if is_in_vectors(p)]
    sines = any(map(takes_sines, vectors))
    return within_columns(
        TEMPLATES.get_template("members.c.jinja").render(
            first_line=f"/* {first_line(library, figures, (f'--{OVER_MEMBERS}',))}",
            header=batch.file(precision, "h"),
            uses_math=sines or any(kind in MATH for p in vectors for kind in p.count),
            aside=put_aside(library.emitted()),
            sines=_sines(library, precision) if sines else "",
            vectors=bool(vectors),
            functions=texts,
        )
    )


def _sines(library: Library, precision: Precision) -> str:
    scene, text = f"{library.scene.name}_{OVER_MEMBERS}", partial(literal, precision=precision)
    return (
        TEMPLATES.get_template("members_sine_cosine.c.jinja")
        .render(
            header=CNames(library.scene.name).file(precision, "c"),
            symbol=f"{scene}_{TOGETHER}_{precision.name}",
            kind=sines_type(scene, precision),
            scalar=precision.scalar,
            zero=text(Fraction(0)),
            many=MEMBERS_KEPT,
            **numbers_of_sines(precision.bits, text),
            **precision.functions,
        )
        .rstrip()
    )
