"""The page of a scene: what is given, what each function satisfies, costs and errs, and its C."""

from collections.abc import Sequence
from functools import partial

from markupsafe import Markup, escape

from derive.emit.c.comment import BOUND_OF_WHAT, SETUP_ERROR, cost_line, of_what
from derive.emit.c.source import first_line
from derive.emit.drawing.drawing import drawing
from derive.emit.notation import name_mathml
from derive.emit.notation.glyph import glyph, slanted
from derive.emit.notation.layout import name as layout_of
from derive.emit.notation.lines import width
from derive.emit.on_target import OnTarget
from derive.emit.page.answer import answer_lines
from derive.emit.page.code import listing
from derive.emit.page.equation import letter, notes, passages, taken_names, written_names
from derive.emit.page.links import neighbours
from derive.emit.page.pattern import pattern_drawing
from derive.emit.page.principal import principal_lines
from derive.emit.page.prose import prose
from derive.emit.reported import NOTHING_BESIDE, Beside
from derive.emit.templates import TEMPLATES
from derive.lecture.chapters import LECTURE
from derive.library.library import Library
from derive.program.program import Measurement, Program, Quantity
from derive.scene.wanted import JACOBIAN

WIDEST_SYMBOL = 10.0  # em
LONGEST_SYMBOL = 12
_PRECISIONS = ("f32", "f64")


def scene_page(
    library: Library, figures: Sequence[Measurement], by: Beside = NOTHING_BESIDE
) -> str:
    """Return the text of ``<scene>.html``, complete in one file and without scripts.

    by : what the page can lead to: the scene's report and its sentence, the report of many cases
    """
    scene = library.scene
    rests_on = {a for program in library.printed() for a in program.assumptions}
    return TEMPLATES.get_template("scene.html.jinja").render(
        first_line=first_line(library, figures),
        scene=scene,
        by=by,
        prose=prose,
        given=library.mechanism.said,
        signs=library.mechanism.signs,
        around=neighbours(scene),
        drawing=Markup(drawing(scene)),  # noqa: S704 (numbers and checked names)
        answers=answer_lines(library),
        moves=library.motions,
        assumptions=[step for step in LECTURE.steps if step.name in rests_on],
        constants=library.constants,
        parameters=library.vocabulary.parameters,
        principal=list(principal_lines(scene)),
        setup_cost=library.setup.flops(),
        setup_error=SETUP_ERROR,
        symbol=partial(_symbol, library),
        range_of=_range,
        cost=cost_line,
        of_what=of_what,
        bound_of_what=f"proved, {BOUND_OF_WHAT}",
        sections=_sections(library, figures, by.on_target),
        files=_files(scene.name),
    )


def _files(name: str) -> list[str]:
    sources = [f"{name}_{p}.{ending}" for p in reversed(_PRECISIONS) for ending in ("h", "c")]
    return [*sources, f"{name}_casadi.py", f"{name}.json"]


def _sections(
    library: Library, figures: Sequence[Measurement], costs: OnTarget
) -> list[dict[str, object]]:
    """Return the functions in order; equations stand where they are first needed."""
    owners: dict[str, str] = {}
    return [
        _section(library, program, owners.setdefault(_base(program), program.name))
        | {"errors": _errors(program, figures), "costs": costs.of(program.name)}
        | {"bounds": _bounds(program, figures)}
        for program in library.printed()
    ]


def _base(program: Program) -> str:
    return program.name.removesuffix(JACOBIAN)


def _section(library: Library, program: Program, owner: str) -> dict[str, object]:
    posed = program in library.functions and _base(program) in library.problems
    equations = passages(library.mechanism, _base(program)) if posed else ()
    links = {line.unknown: line.place for passage in equations for line in passage.lines}
    sparsity = (program.sparsity or {}).get("jacobian")
    own = notes(library.mechanism, _base(program)) if posed else []
    says = f"pattern of the Jacobian of {_base(program)}"
    return {
        "program": program,
        "equations_of": owner,
        "passages": equations if owner == program.name else (),
        "code": listing(program, library.scene.name, links),
        "pattern": pattern_drawing(sparsity, says) if sparsity else "",
        "notes": [_noted(library, note) for note in own],
        "ways": library.ways.get(program.name, {}),
    }


def _noted(library: Library, note: str) -> Markup:
    """Return a note with the names that it lists as equations write them; balances stay words."""
    says, _, listed = note.removesuffix(".").partition(": ")
    known, symbols = written_names(library.mechanism), library.mechanism.words.sheet.symbols
    taken = taken_names(library.mechanism)
    if says == "Balances":
        return escape(note)
    names = [known[symbols[n]] if n in symbols else letter(n, taken) for n in listed.split(", ")]
    drawn = [name_mathml(n, "scalar") if n.isidentifier() else escape(n) for n in names]
    return escape(says) + Markup(": ") + Markup(", ".join(drawn)) + Markup(".")  # noqa: S704 (MathML of checked names)


def _symbol(library: Library, q: Quantity) -> Markup:
    """Return the letter of a quantity; none of a long word, or with long words for indices.

    There is none for one whose components have names of their own.
    """
    if q.shape and not q.components[0].startswith(q.name):
        return Markup("")
    name = letter(q.name, taken_names(library.mechanism))
    if len(name) > LONGEST_SYMBOL and name == q.name and not slanted(glyph(name).base):
        return Markup("")
    if width(layout_of(name, "scalar")) > WIDEST_SYMBOL:
        return Markup("")
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


def _bounds(program: Program, figures: Sequence[Measurement]) -> dict[str, object]:
    """Return what is proved of each output, and what it assumes or why there is nothing."""
    own = [m.bound for m in figures if m.function == program.name and m.bound is not None]
    rows = {b.output: [x for x in own if x.output == b.output] for b in own}
    assumed = dict.fromkeys(words for b in own for words in b.assumed)
    says = [f"Proved assuming {'; '.join(assumed)}."] if assumed else []
    says += [f"Not proved: {why}." for why in dict.fromkeys(b.why for b in own) if why]
    return {"rows": rows, "says": " ".join(says)}
