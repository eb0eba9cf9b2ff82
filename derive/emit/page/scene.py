"""The page of a scene: what is given, what each function satisfies, costs and errs, and its C."""

from collections.abc import Sequence
from functools import partial

from markupsafe import Markup

from derive.emit.c.comment import SETUP_ERROR, cost_line, of_what
from derive.emit.c.source import first_line
from derive.emit.notation import name_mathml
from derive.emit.page.code import listing
from derive.emit.page.equation import letter, notes, passages, taken_names
from derive.emit.page.pattern import pattern_drawing
from derive.emit.page.prose import prose
from derive.emit.templates import TEMPLATES
from derive.lecture.chapters import LECTURE
from derive.library.library import Library
from derive.program.program import Measurement, Program, Quantity
from derive.scene.wanted import JACOBIAN

_PRECISIONS = ("f32", "f64")


def scene_page(library: Library, figures: Sequence[Measurement]) -> str:
    """Return the text of ``<scene>.html``, complete in one file and without scripts."""
    scene = library.scene
    rests_on = {a for program in library.printed() for a in program.assumptions}
    return TEMPLATES.get_template("scene.html.jinja").render(
        first_line=first_line(library, figures),
        scene=scene,
        prose=prose,
        given=scene.told,
        assumptions=[step for step in LECTURE.steps if step.name in rests_on],
        constants=library.constants,
        parameters=library.vocabulary.parameters,
        setup_cost=library.setup.flops(),
        setup_error=SETUP_ERROR,
        symbol=partial(_symbol, library),
        range_of=_range,
        cost=cost_line,
        of_what=of_what,
        sections=_sections(library, figures),
        files=_files(scene.name),
    )


def _files(name: str) -> list[str]:
    sources = [f"{name}_{p}.{ending}" for p in reversed(_PRECISIONS) for ending in ("h", "c")]
    return [*sources, f"{name}_casadi.py", f"{name}.json"]


def _sections(library: Library, figures: Sequence[Measurement]) -> list[dict[str, object]]:
    """Return the functions in order; equations stand where they are first needed."""
    owners: dict[str, str] = {}
    return [
        _section(library, program, owners.setdefault(_base(program), program.name))
        | {"errors": _errors(program, figures)}
        for program in library.printed()
    ]


def _base(program: Program) -> str:
    return program.name.removesuffix(JACOBIAN)


def _section(library: Library, program: Program, owner: str) -> dict[str, object]:
    posed = program in library.functions and _base(program) in library.problems
    equations = passages(library.mechanism, _base(program)) if posed else ()
    links = {line.unknown: line.place for passage in equations for line in passage.lines}
    sparsity = (program.sparsity or {}).get("jacobian")
    says = f"pattern of the Jacobian of {_base(program)}"
    return {
        "program": program,
        "equations_of": owner,
        "passages": equations if owner == program.name else (),
        "code": listing(program, library.scene.name, links),
        "pattern": pattern_drawing(sparsity, says) if sparsity else "",
        "notes": notes(library.mechanism, _base(program)) if posed else [],
    }


def _symbol(library: Library, q: Quantity) -> Markup:
    """Return the letter of a quantity; of one whose components have names of their own, none."""
    if q.shape and not q.components[0].startswith(q.name):
        return Markup("")
    name = letter(q.name, taken_names(library.mechanism))
    return Markup(name_mathml(name, "vector" if q.shape else "scalar"))  # noqa: S704 (MathML of a checked name)


def _range(q: Quantity) -> str:
    if q.low is None or q.high is None:
        return ""
    return f"{float(q.low):g} … {float(q.high):g}".replace("-", "−")


def _errors(program: Program, figures: Sequence[Measurement]) -> dict[str, list[Measurement]]:
    """Return what was measured of each output, in float before double."""
    own = [m for m in figures if m.function == program.name]
    found = {q.name: [m for m in own if m.output == q.name] for q in program.outputs}
    return {name: each for name, each in found.items() if each}
