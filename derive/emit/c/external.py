"""CasADi's external interface in C: all steps of a horizon in one call, with exact derivatives.

Steps do not meet, so all patterns are blocks on the diagonal, and values stand step after step.
By the length of the step and by parameters nothing is differentiated: what is asked is NaN.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap

from derive.emit.c.signature import CNames, prototype
from derive.emit.c.source import first_line
from derive.emit.c.text import function_body
from derive.emit.templates import TEMPLATES
from derive.library.external import CASADI, STEP, WITH_JACOBIAN
from derive.library.library import Library
from derive.program.precision import F64
from derive.program.program import Measurement, Program, Quantity, Sparsity, placed

MADE = re.compile(r"const double (\w+) = (.*);")
NAME = re.compile(r"\b[a-z]+\d+\b")
LONGEST = 92
OPTION = f"--{CASADI}"
GIVEN = ("x", "u", "time_step", "parameters")
SHAPES = {"x": ("NX", "STEPS"), "u": ("NU", "STEPS"), "xn": ("NX", "STEPS")}
SHAPES |= {"time_step": ("1", "1"), "parameters": ("NP", "1")}


@dataclass(frozen=True)
class StepEntries:
    """Entries of a matrix that every step has in its own block, in compressed-column order.

    takes : for each entry, its place among the kernel's nonzeros
    """

    name: str
    rows: int
    columns: int
    colind: tuple[int, ...]
    row: tuple[int, ...]
    takes: tuple[int, ...]


def external_name(scene: str) -> str:
    """Return what CasADi calls the function of a whole horizon."""
    return f"{scene}_steps"


def external_file(
    library: Library, second: Program, figures: Sequence[Measurement]
) -> tuple[str, str]:
    """Return name and text of C that gives CasADi's interface beside the scene's own C."""
    names, scene = CNames(library.scene.name), library.scene.name
    states, inputs = sizes(library)
    step, jacobian = library[STEP], library[WITH_JACOBIAN]
    blocks = [*_of_jacobian(jacobian, states, inputs), *_of_second(second, states, inputs)]
    text = TEMPLATES.get_template("external.c.jinja").render(
        first_line=first_line(library, figures, (OPTION,)),
        title=library.scene.title,
        header=names.file(F64, "h"),
        name=external_name(scene),
        nx=states,
        nu=inputs,
        np=sum(len(q.components) for q in library.setup.inputs) if library.constants else 0,
        constants=f"{scene}_constants_f64" if library.constants else "",
        setup=f"{scene}_setup_f64",
        setup_inputs=_setup_inputs(library),
        step=_call(step, names, library),
        jacobian=_call(jacobian, names, library),
        jacobian_size=len(jacobian.outputs[-1].components),
        second=_call(second, names, library),
        second_size=len(second.results),
        kernel=[prototype(second, names, F64), *joined(function_body(second, scene, F64))],
        blocks=[(b, _arrays(b)) for b in blocks],
        functions=_functions(external_name(scene)),
    )
    return f"{scene}_external.c", text


def described(library: Library) -> dict[str, object]:
    """Return what the module says of the compiled steps, and what it compiles."""
    (states, inputs), scene = sizes(library), library.scene.name
    own = [c for q in library.vocabulary.states for c in q.components]
    names = CNames(scene)
    return {
        "name": external_name(scene),
        "steps": f"the step {STEP}",
        "sources": [names.file(F64, "h"), names.file(F64, "c"), f"{scene}_external.c"],
        "nx": states,
        "nu": inputs,
        "states": ", ".join(own),
        "inputs": ", ".join(input_components(library)) or "nothing",
    }


def sizes(library: Library) -> tuple[int, int]:
    """Return the numbers of states and of inputs of a step."""
    states = library.vocabulary.states
    return sum(len(q.components) for q in states), len(input_components(library))


def input_components(library: Library) -> list[str]:
    """Return what ``u`` holds: what the step is given beside state, constants and length."""
    own = {"time_step", *(q.name for q in library.vocabulary.states)}
    given = (q for q in library["state_rate"].inputs if q.role != "constants")
    return [c for q in given if q.name not in own for c in q.components]


def _setup_inputs(library: Library) -> list[str]:
    places = enumerate(c for q in library.setup.inputs for c in q.components)
    return [f"parameters[{k}]" for k, _ in places]


def _call(program: Program, names: CNames, library: Library) -> str:
    """Return the call of a program for one step, from x, u, h into xn and what is behind it."""
    where = {q.name: f"x + {at.start}" for q, at in placed(library.vocabulary.states)}
    given = input_components(library)
    arguments = []
    for q in program.inputs:
        if q.role == "constants":
            arguments.append("&constants")
        elif q.name in where:
            arguments.append(where[q.name])
        elif q.name in ("time_step", "adjoint"):
            arguments.append({"time_step": "h", "adjoint": "adjoint"}[q.name])
        else:
            at = given.index(q.components[0])
            arguments.append(f"u + {at}" if q.shape else f"u[{at}]")
    arguments += [_result(q, place) for q, place in placed(program.outputs)]
    return f"{names.symbol(program.name, F64)}({', '.join(arguments)})"


def _result(q: Quantity, place: slice) -> str:
    if q.name in ("jacobian", "hessian"):
        return "entries"
    return f"xn + {place.start}"


def _of_jacobian(program: Program, states: int, inputs: int) -> list[StepEntries]:
    pattern = (program.sparsity or {})["jacobian"]
    entries = {place: at for at, place in enumerate(pattern.places())}
    x, u = range(states), range(states, states + inputs)
    turned = {(k, i): at for (i, k), at in entries.items()}
    return [
        _block("xn_x", entries, x, x),
        _block("xn_u", entries, x, u),
        _block("x_adj", turned, x, x),
        _block("u_adj", turned, u, x),
    ]


def _of_second(program: Program, states: int, inputs: int) -> list[StepEntries]:
    pattern: Sparsity = (program.sparsity or {})["hessian"]
    lower = {place: at for at, place in enumerate(pattern.places())}
    entries = lower | {(k, i): at for (i, k), at in lower.items()}
    x, u = range(states), range(states, states + inputs)
    return [
        _block(f"{a}_{b}", entries, rows, columns)
        for a, rows in (("x", x), ("u", u))
        for b, columns in (("x", x), ("u", u))
    ]


def _block(
    name: str, entries: dict[tuple[int, int], int], rows: range, columns: range
) -> StepEntries:
    colind, row, takes = [0], list[int](), list[int]()
    for k in columns:
        found = [(i, entries[i, k]) for i in rows if (i, k) in entries]
        row += [i - rows.start for i, _ in found]
        takes += [at for _, at in found]
        colind.append(len(row))
    return StepEntries(name, len(rows), len(columns), tuple(colind), tuple(row), tuple(takes))


def _arrays(block: StepEntries) -> list[str]:
    """Return a block's arrays as C; none is empty, as C has it."""
    each = (("colind", block.colind), ("row", block.row), ("takes", block.takes))
    found = list[str]()
    for name, values in each:
        numbers = wrap(", ".join(map(str, values or (0,))), LONGEST)
        found.append(f"static const int {block.name}_{name}[{len(values) or 1}] = {{")
        found += [*(f"    {line}" for line in numbers), "};"]
    return found


def _functions(name: str) -> list[dict[str, object]]:
    """Return what CasADi asks of each function: names and patterns of what goes in and out."""
    back = [*GIVEN, "out_xn", "adj_xn"]
    adjoint = [f"adj_{q}" for q in GIVEN]
    return [
        {"name": name, "given": _matrices(GIVEN), "found": _matrices(["xn"])},
        {
            "name": f"jac_{name}",
            "given": _matrices([*GIVEN, "out_xn"]),
            "found": _blocks(["xn"], GIVEN),
        },
        {"name": f"adj1_{name}", "given": _matrices(back), "found": _matrices(adjoint)},
        {
            "name": f"jac_adj1_{name}",
            "given": _matrices([*back, *(f"out_{q}" for q in adjoint)]),
            "found": _blocks(adjoint, back),
        },
    ]


def _shape(name: str) -> tuple[str, str]:
    return SHAPES[name.removeprefix("out_").removeprefix("adj_")]


def _matrices(names: Sequence[str]) -> list[tuple[str, str]]:
    """Return names with their patterns: dense, or without entries what holds an output's place."""
    return [(n, _empty(*_shape(n)) if n.startswith("out_") else _dense(*_shape(n))) for n in names]


def _dense(rows: str, columns: str) -> str:
    return f"{{ static const casadi_int made[] = {{{rows}, {columns}, 1}}; return made; }}"


def _empty(rows: str, columns: str) -> str:
    size = f"3 + {columns}"
    return f"{{ static const casadi_int made[{size}] = {{{rows}, {columns}}}; return made; }}"


DIAGONAL = {
    ("xn", "x"): "xn_x", ("xn", "u"): "xn_u",
    ("adj_x", "x"): "x_x", ("adj_x", "u"): "x_u", ("adj_x", "adj_xn"): "x_adj",
    ("adj_u", "x"): "u_x", ("adj_u", "u"): "u_u", ("adj_u", "adj_xn"): "u_adj",
}  # fmt: skip


def _blocks(rows: Sequence[str], columns: Sequence[str]) -> list[tuple[str, str]]:
    """Return the derivatives of each of some results by each input, with their patterns."""
    found = []
    for row in rows:
        for column in columns:
            size = [" * ".join(x for x in _shape(q) if x != "1") or "1" for q in (row, column)]
            own = DIAGONAL.get((row, column))
            pattern = f"return diagonal_{own}();" if own else _dense(*size)
            found.append((f"jac_{row}_{column}", _empty(*size) if column == "out_xn" else pattern))
    return found


def joined(lines: Sequence[str]) -> list[str]:
    """Return lines of constants with each that is read once put where it is read, if it fits."""
    uses: dict[str, int] = {}
    for line in lines:
        for name in NAME.findall(line):
            uses[name] = uses.get(name, 0) + 1
    waiting, found = dict[str, str](), list[str]()
    for line in lines:
        whole = NAME.sub(lambda m: waiting.get(m[0], m[0]), line)
        if len(whole) > LONGEST:
            early = [n for n in NAME.findall(line) if n in waiting]
            keep = max(early, key=lambda n: len(waiting[n]))
            found.append(f"const double {keep} = {waiting.pop(keep)[1:-1]};")
            whole = NAME.sub(lambda m: waiting.get(m[0], m[0]), line)
            for name in [n for n in early if n in waiting and len(whole) > LONGEST]:
                found.append(f"const double {name} = {waiting.pop(name)[1:-1]};")
                whole = NAME.sub(lambda m: waiting.get(m[0], m[0]), line)
        for name in NAME.findall(line):
            waiting.pop(name, None)
        made = MADE.fullmatch(whole)
        if made and uses[made[1]] == 2:
            waiting[made[1]] = f"({made[2]})"
        else:
            found.append(whole)
    return found
