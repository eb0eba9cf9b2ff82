"""The page of a scene: what is given, what each function satisfies, costs and errs, and its C."""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from derive.emit.c.comment import cost, of_what
from derive.emit.c.source import first_line
from derive.emit.notation import name_mathml
from derive.emit.page.code import listing
from derive.emit.page.equation import Passage, letter, notes, passages, taken_names
from derive.emit.page.pattern import pattern
from derive.emit.page.prose import prose
from derive.emit.page.words import given
from derive.emit.templates import TEMPLATES
from derive.lecture.chapters import LECTURE
from derive.library.library import Library
from derive.program.program import Measurement, Program, Quantity
from derive.scene.wanted import JACOBIAN

_PRECISIONS = ("f32", "f64")


@dataclass(frozen=True)
class Argument:
    """One row of a table of arguments."""

    direction: str
    quantity: Quantity
    symbol: Markup
    unit: str
    declared: str
    bounds: str


@dataclass(frozen=True)
class Accuracy:
    """One row of a table of errors, in units of rounding of what the section names."""

    output: str
    cells: tuple[str, ...]
    samples: int


@dataclass(frozen=True)
class Section:
    """One function on the page."""

    program: Program
    equations_of: str
    passages: tuple[Passage, ...]
    arguments: tuple[Argument, ...]
    cost: str
    measure: str
    accuracy: tuple[Accuracy, ...]
    code: Markup
    pattern: Markup
    notes: list[str]


def scene_page(library: Library, figures: Sequence[Measurement]) -> str:
    """Return the text of ``<scene>.html``, complete in one file and without scripts."""
    scene = library.known.scene
    rests_on = {a for program in library.printed() for a in program.assumptions}
    return TEMPLATES.get_template("scene.html.jinja").render(
        first_line=first_line(library).replace("--", "- -"),
        scene=scene,
        prose=prose,
        given=given(scene),
        assumptions=[step for step in LECTURE.steps if step.name in rests_on],
        constants=library.constants,
        parameters=[_argument(library, q, "given") for q in library.known.words.parameters],
        setup_cost=library.setup.flops(),
        sections=_sections(library, figures),
        files=_files(scene.name),
    )


def _files(name: str) -> list[str]:
    sources = [f"{name}_{p}.{ending}" for p in reversed(_PRECISIONS) for ending in ("h", "c")]
    return [*sources, f"{name}_casadi.py", f"{name}.json"]


def _sections(library: Library, figures: Sequence[Measurement]) -> list[Section]:
    """Return the functions in order; equations stand where they are first needed."""
    owners: dict[str, str] = {}
    return [
        _section(library, program, owners.setdefault(_base(program), program.name), figures)
        for program in library.printed()
    ]


def _base(program: Program) -> str:
    return program.name.removesuffix(JACOBIAN)


def _section(
    library: Library, program: Program, owner: str, figures: Sequence[Measurement]
) -> Section:
    fact = library.truths.get(_base(program)) if program in library.functions else None
    equations = passages(library.known, _base(program)) if fact else ()
    links = {line.unknown: line.place for passage in equations for line in passage.lines}
    sparsity = (program.sparsity or {}).get("jacobian")
    says = f"pattern of the Jacobian of {_base(program)}"
    return Section(
        program,
        owner,
        equations if owner == program.name else (),
        _arguments(library, program),
        cost(program),
        of_what(program),
        _accuracy(program, figures),
        listing(program, library.known.scene.name, links),
        pattern(sparsity, says) if sparsity else Markup(""),
        notes(library.known, _base(program)) if fact else [],
    )


def _arguments(library: Library, program: Program) -> tuple[Argument, ...]:
    given_ = [_argument(library, q, "given") for q in program.inputs if q.role != "constants"]
    return (*given_, *(_argument(library, q, "returned") for q in program.outputs))


def _argument(library: Library, q: Quantity, direction: str) -> Argument:
    size = f"[{len(q.components)}]" if q.shape else ""
    scalars = not q.shape or not q.components[0].startswith(q.name)
    name = letter(q.name, taken_names(library.known))
    symbol = "" if scalars and q.shape else name_mathml(name, "vector" if q.shape else "scalar")
    bounds = direction == "given" and q.low is not None and q.high is not None
    return Argument(
        direction,
        q,
        Markup(symbol),  # noqa: S704 (MathML of a checked name)
        q.unit.replace("^2", "²"),
        q.name + size,
        f"{float(q.low or 0):g} … {float(q.high or 0):g}".replace("-", "−") if bounds else "",
    )


def _accuracy(program: Program, figures: Sequence[Measurement]) -> tuple[Accuracy, ...]:
    rows: dict[str, list[Measurement]] = {}
    for precision in _PRECISIONS:
        for m in figures:
            if (m.function, m.precision) == (program.name, precision):
                rows.setdefault(m.output, []).append(m)
    return tuple(
        Accuracy(
            output,
            tuple(f"{value:.2g}" for m in own for value in (m.median, m.worst)),
            max(m.samples for m in own),
        )
        for output, own in rows.items()
    )
