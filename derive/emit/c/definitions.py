"""The C of functions from head to brace, whole matrices among them."""

from collections.abc import Sequence
from fractions import Fraction

from derive.emit.c.scope import declared_in_c, require_free
from derive.emit.c.signature import CNames, dense, dense_size, prototype
from derive.emit.c.text import constant_array, function_body, is_long
from derive.emit.operators import literal
from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import MATRIX, Program


def definitions(library: Library, names: CNames, precision: Precision) -> list[dict[str, str]]:
    """Return the functions of a scene in order, dense ones among them, for the template of C."""
    found = []
    for program in library.printed():
        found.append(_definition(program, names, precision))
        if program.sparsity:
            whole = _scattered if program.has_arrays else _dense_definition
            found.append({**whole(program, names, precision), "says": f"{program.says} Dense."})
    return found


def _definition(program: Program, names: CNames, precision: Precision) -> dict[str, str]:
    return _defined(program, names, precision, function_body(program, names.scene, precision))


def _dense_definition(program: Program, names: CNames, precision: Precision) -> dict[str, str]:
    return _definition(dense(program), names, precision)


def _defined(
    program: Program, names: CNames, precision: Precision, written: Sequence[str]
) -> dict[str, str]:
    """Return what a function is for, with its lines between head and brace."""
    arguments = [q.name for q in (*program.inputs, *program.outputs)]
    require_free(names.scene, program.name, arguments, declared_in_c(written))
    lines = "\n".join(f"    {line}" for line in written)
    text = f"{prototype(program, names, precision)}\n{{\n{lines}\n}}"
    in_order = "yes" if is_long(program) else ""
    return {"says": program.says, "definition": text, "in_order": in_order}


def _scattered(program: Program, names: CNames, precision: Precision) -> dict[str, str]:
    """Return the dense function of one whose loops fill the nonzeros: it calls that one."""
    pattern = next(iter((program.sparsity or {}).values()))
    spots = [c * len(pattern.rows) + r for r, c in pattern.places()]
    passed = [q.name for q in (*program.inputs, *program.outputs[:-1])] + ["nonzeros"]
    lines = [
        *constant_array("places", spots),
        f"{precision.scalar} nonzeros[{len(spots)}];",
        "int entry;",
        f"{names.symbol(program.name, precision)}({', '.join(passed)});",
        f"for (entry = 0; entry < {dense_size(program)}; ++entry) {{",
        f"    {MATRIX}[entry] = {literal(Fraction(0), precision)};",
        "}",
        f"for (entry = 0; entry < {len(spots)}; ++entry) {{",
        f"    {MATRIX}[places[entry]] = nonzeros[entry];",
        "}",
    ]
    return _defined(dense(program), names, precision, lines)
