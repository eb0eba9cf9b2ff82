"""CasADi's external interface in C: all steps of a horizon in one call, with exact derivatives.

Steps do not meet but in their length and in parameters, and values stand step after step.
"""

from collections.abc import Iterable, Mapping, Sequence
from textwrap import wrap

from derive.emit.c.blocks import LONGEST, Sizes, first_entries, horizon_block, second_entries
from derive.emit.c.joined import joined
from derive.emit.c.scope import declared_in_c, require_free
from derive.emit.c.signature import CNames, prototype
from derive.emit.c.source import first_line
from derive.emit.c.text import function_body
from derive.emit.templates import TEMPLATES
from derive.library.external import (
    BY_LENGTH,
    BY_PARAMETERS,
    BY_STATE,
    CASADI,
    StepDerivatives,
    step_inputs,
    step_name,
)
from derive.library.library import Library
from derive.motion.along import ADJOINT, CHANGE
from derive.program.precision import F64
from derive.program.program import Measurement, Program, Quantity, placed

OPTION = f"--{CASADI}"
GIVEN = ("x", "u", "time_step", "parameters")
SHAPES = {"x": ("NX", "STEPS"), "u": ("NU", "STEPS"), "xn": ("NX", "STEPS")}
TAKEN = (*GIVEN, "out_xn", "adj_xn", *(f"out_adj_{q}" for q in GIVEN))
"""What CasADi gives to the derivative of the adjoint; to the others, the first of it."""
SHAPES |= {"time_step": ("1", "1"), "parameters": ("NP", "1")}


def external_name(scene: str) -> str:
    """Return what CasADi calls the function of a whole horizon."""
    return f"{scene}_steps"


def external_file(
    library: Library, of: StepDerivatives, figures: Sequence[Measurement]
) -> tuple[str, str]:
    """Return name and text of C that gives CasADi's interface beside the scene's own C."""
    names, scene, known = CNames(library.scene.name), library.scene.name, sizes(library)
    first, first_size = first_entries(of, known, own_names(library))
    second, second_size = second_entries(of, known)
    by = [q for q in GIVEN if q != "parameters" or known.parameters]
    slopes = [horizon_block(f"xn_{q}", first, "xn", q, known) for q in by]
    back = {(k, i): at for (i, k), at in first.items()}
    turned = [(_place(q, "xn"), horizon_block(f"{q}_adj", back, q, "xn", known)) for q in by]
    bends = [(_place(a, b), horizon_block(f"{a}_{b}", second, a, b, known)) for a in by for b in by]
    blocks = [*slopes, *(b for _, b in (*turned, *bends))]
    text = TEMPLATES.get_template("external.c.jinja").render(
        first_line=first_line(library, figures, (OPTION,)),
        title=library.scene.title,
        header=names.file(F64, "h"),
        name=external_name(scene),
        nx=known.states,
        nu=known.inputs,
        np=known.parameters,
        constants=f"{scene}_constants_f64" if library.constants else "",
        setup=f"{scene}_setup_f64",
        setup_inputs=[f"parameters[{k}]" for k in range(known.parameters)],
        step=_call(of.step, library, "xn"),
        kernels=[_kernel(program, names) for program in of.programs()],
        ways=[("firsts", *_first(of, library)), ("seconds", *_second(of, library))],
        first_size=first_size,
        second_size=second_size,
        slopes=slopes,
        bends=bends,
        turned=turned,
        blocks=blocks,
        given=_named(TAKEN),
        given_patterns=[_dense(q) for q in TAKEN],
        functions=_functions(external_name(scene), {b.name: b.pattern for b in blocks}),
    )  # fmt: skip
    return f"{scene}_external.c", text


def _place(row: str, column: str) -> int:
    """Return which output of jac_adj1 has the derivatives of one adjoint by something."""
    columns = (*GIVEN, "out_xn", "xn")
    return len(columns) * GIVEN.index(row) + columns.index(column)


def _kernel(program: Program, names: CNames) -> list[str]:
    lines = function_body(program, names.scene, F64)
    require_free(names.scene, program.name, [q.name for q in program.inputs], declared_in_c(lines))
    return [prototype(program, names, F64), *joined(lines)]


def described(library: Library) -> dict[str, object]:
    """Return what the module says of the compiled steps, and what it compiles."""
    names = CNames(library.scene.name)
    known = sizes(library)
    return {
        "name": external_name(names.scene),
        "steps": f"the step {step_name(library.scene)}",
        "sources": [names.file(F64, "h"), names.file(F64, "c"), f"{names.scene}_external.c"],
        "nx": known.states,
        "nu": known.inputs,
    }


def sizes(library: Library) -> Sizes:
    """Return the numbers of states, inputs and parameters of a step."""
    count = [sum(len(q.components) for q in each) for each in _quantities(library)]
    return Sizes(*count)


def _quantities(library: Library) -> tuple[tuple[Quantity, ...], ...]:
    parameters = library.setup.inputs if library.constants else ()
    return library.vocabulary.states, step_inputs(library), parameters


def own_names(library: Library) -> list[str]:
    """Return what ``x`` and ``u`` hold."""
    return [c for each in _quantities(library)[:2] for q in each for c in q.components]


def _call(program: Program, library: Library, into: str) -> str:
    """Return the call of a program for one step, from x, u, h into what it gives last."""
    states, inputs, parameters = _quantities(library)
    where = {"time_step": "h", ADJOINT: ADJOINT, CHANGE: CHANGE}
    for array, quantities in (("x", states), ("u", inputs), ("made->parameters", parameters)):
        for q, at in placed(quantities):
            where[q.name] = f"{array} + {at.start}" if q.shape else f"{array}[{at.start}]"
    given = ["&constants" if q.role == "constants" else where[q.name] for q in program.inputs]
    outputs = [(q, place.start) for q, place in placed(program.outputs)]
    results = [f"xn + {at}" for _, at in outputs[:-1]]
    last = f"xn + {outputs[-1][1]}" if into == "xn" else into
    symbol = CNames(library.scene.name).symbol(program.name, F64)
    return f"{symbol}({', '.join([*given, *results, last])})"


def _first(of: StepDerivatives, library: Library) -> tuple[str, list[dict[str, object]]]:
    """Return how C fills a step's first derivatives: what it calls at once, and along changes."""
    known = sizes(library)
    start = len((of.jacobian.sparsity or {})["jacobian"].row)
    parts = [_part(of.first[BY_LENGTH], library, "by_length", start, 1)]
    if known.parameters:
        start += known.states
        parts.append(
            _part(of.first[BY_PARAMETERS], library, BY_PARAMETERS, start, known.parameters)
        )
    return _call(of.jacobian, library, "entries"), parts


def _second(of: StepDerivatives, library: Library) -> tuple[str, list[dict[str, object]]]:
    known, once = sizes(library), ""
    if of.lower is not None:
        once, start = _call(of.lower, library, "entries"), len(of.lower.results)
        parts = [_part(of.second[BY_LENGTH], library, "by_length", start, 1)]
    else:
        start = known.own * (known.own - 1)
        asked = "by_state || by_length"
        whole = _part(of.second[BY_STATE], library, asked, 0, known.own)
        last = known.own - 1
        whole |= {"begin": f"(by_state ? 0 : {last})", "end": f"(by_length ? {known.own} : {last})"}
        parts = [whole]
    if known.parameters:
        program = of.second[BY_PARAMETERS]
        start += known.own
        parts.append(_part(program, library, BY_PARAMETERS, start, known.parameters))
    return once, parts


def _part(
    program: Program, library: Library, asked: str, start: int, changes: int
) -> dict[str, object]:
    return {
        "asked": asked,
        "call": _call(program, library, "column"),
        "start": start,
        "rows": len(program.results),
        "changes": changes if changes > 1 else 0,
        "begin": "0",
        "end": str(changes),
    }


def _functions(name: str, blocks: Mapping[str, str]) -> list[dict[str, object]]:
    """Return what CasADi asks of each function: how much goes in, what comes out."""
    back = TAKEN[: len(GIVEN) + 2]
    adjoint = [f"adj_{q}" for q in GIVEN]
    return [
        _function(name, GIVEN, {"xn": _dense("xn")}),
        _function(f"jac_{name}", TAKEN[: len(GIVEN) + 1], _blocks(["xn"], GIVEN, blocks)),
        _function(f"adj1_{name}", back, {q: _dense(q) for q in adjoint}),
        _function(f"jac_adj1_{name}", TAKEN, _blocks(adjoint, back, blocks)),
    ]


def _function(name: str, given: Sequence[str], found: Mapping[str, str]) -> dict[str, object]:
    patterns = list(found.values())
    return {"name": name, "takes": len(given), "names": _named(found), "patterns": patterns}


def _named(names: Iterable[str]) -> list[str]:
    return wrap(", ".join(f'"{n}"' for n in names), LONGEST)


def _shape(name: str) -> tuple[str, str]:
    return SHAPES[name.removeprefix("out_").removeprefix("adj_")]


def _dense(name: str) -> str:
    """Return a pattern without gaps, or without entries of what holds an output's place."""
    rows, columns = _shape(name)
    if name.startswith("out_"):
        return _empty(rows, columns)
    return f"{{ static const casadi_int made[] = {{{rows}, {columns}, 1}}; return made; }}"


def _empty(rows: str, columns: str) -> str:
    size = f"3 + {columns}"
    return f"{{ static const casadi_int made[{size}] = {{{rows}, {columns}}}; return made; }}"


def _blocks(
    rows: Sequence[str], columns: Sequence[str], blocks: Mapping[str, str]
) -> dict[str, str]:
    """Return the patterns of the derivatives of each of some results by each input."""
    found = dict[str, str]()
    for row in rows:
        for column in columns:
            size = [" * ".join(x for x in _shape(q) if x != "1") or "1" for q in (row, column)]
            by = "adj" if column == "adj_xn" else column
            own = f"{row.removeprefix('adj_')}_{by}"
            found[f"jac_{row}_{column}"] = blocks.get(own) or _empty(*size)
    return found
