"""The C of a package's test: reference vectors of each function as bits, and their comparison."""

from collections.abc import Mapping, Sequence
from math import prod
from typing import Any

import numpy as np

from derive.emit.c.columns import within_columns
from derive.emit.c.fixed import fixed_symbol
from derive.emit.c.signature import CNames
from derive.emit.package.vectors import SMALL, BitsOf, bits, bits_at, by_vector
from derive.emit.templates import TEMPLATES
from derive.library.library import Library
from derive.program.precision import F64, Precision
from derive.program.program import Program, Quantity

DIGITS = {"f32": 12, "f64": 26}
"""Bits to which what calls the C library's arctangent must agree: half of a number's."""

ACROSS = {"f32": 8, "f64": 4}
"""Numbers of a vector on a line."""


def tested(library: Library, precision: Precision, first_line: str) -> str:
    """Return the C of the test of one precision."""
    names, found = CNames(library.scene.name), bits_at(library, precision)
    small = np.array(SMALL) if precision is F64 else np.array([])
    text = TEMPLATES.get_template("package/test.c.jinja").render(
        first_line=first_line,
        scene=library.scene.name,
        precision=precision,
        header=names.file(precision, "h"),
        whole=f"uint{8 * precision.dtype().itemsize}_t",
        count=len(next(iter(found.returned.values()))),
        across=ACROSS[precision.name],
        digits=DIGITS[precision.name],
        differences=list(zip(bits(small, precision), bits(1 - small, precision), strict=True)),
        constants=bool(library.constants),
        fixed=fixed_symbol(library, precision),
        functions=[
            {"place": place, **_function(p, names, precision, found)}
            for place, p in enumerate(library.in_c(), 1)
        ],
        every_exact=all(p.name in found.exact for p in library.in_c()),
    )
    return within_columns(text)


def _function(
    program: Program, names: CNames, precision: Precision, found: BitsOf
) -> Mapping[str, Any]:
    """Return what the template says of a function: its vectors, its arguments, its call."""
    inputs = [q for q in program.inputs if q.role != "constants"]
    wanted = found.returned[program.name]
    return {
        "name": program.name,
        "symbol": names.symbol(program.name, precision),
        "makes": program.makes("constants"),
        "given": by_vector([found.given[c] for q in inputs for c in q.components]),
        "takes": sum(len(q.components) for q in inputs),
        "wanted": wanted,
        "gives": len(wanted[0]),
        "arguments": _places(inputs),
        "results": _places(program.outputs),
        "passed": ", ".join(_passed(program)),
        "exact": program.name in found.exact,
    }


def _places(quantities: Sequence[Quantity]) -> list[tuple[str, int, int]]:
    """Return name and size of quantities, and where in a row each begins."""
    found, start = [], 0
    for q in quantities:
        size = len(q.components) or prod(q.shape)
        found.append((q.name, size, start))
        start += size
    return found


def _passed(program: Program) -> list[str]:
    outputs = {q.name for q in program.outputs}
    return [
        "&constants" if q.role == "constants"
        else f"own_{q.name}" if q.shape or q.name in outputs
        else f"own_{q.name}[0]"
        for q in (*program.inputs, *program.outputs)
    ]  # fmt: skip
