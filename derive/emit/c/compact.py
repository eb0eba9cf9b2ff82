"""A Runge-Kutta step in loops as C: one copy of the rates, tables of patterns, little code."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from derive.emit.c.text import body, table
from derive.emit.operators import literal
from derive.motion.runge_kutta.compact import SIXTH, WEIGHTS, Columns, Compact
from derive.program.precision import Precision
from derive.program.program import Program, Quantity


def compact_c(loops: Compact, program: Program, precision: Precision) -> list[str]:
    """Return the lines between the braces of ``program``, a step in loops."""
    kind, n = precision.scalar, len(loops.names)
    zero, half, sixth = (literal(q, precision) for q in (Fraction(0), Fraction(1, 2), SIXTH))
    weights = ", ".join(literal(Fraction(w), precision) for w in WEIGHTS)
    columns = loops.columns
    return [
        *_tables(columns),
        f"static const {kind} weights[4] = {{{weights}}};",
        f"const {kind} half = {half} * time_step;",
        f"const {kind} sixth = {sixth} * time_step;",
        f"const {kind} parts[4] = {{half, half, time_step, time_step}};",
        f"{kind} start[{n}], now[{n}], after[{n}], rates[{n}];",
        *([f"{kind} slopes[4][{len(columns.rates.row)}];"] if columns else []),
        *(f"start[{k}] = {place};" for k, place in enumerate(_places(program, loops.names))),
        f"for (int i = 0; i < {n}; ++i) {{",
        "    now[i] = start[i];",
        f"    after[i] = {zero};",
        "}",
        "for (int stage = 0; stage < 4; ++stage) {",
        *_indented(_rates(loops, program, precision)),
        f"    for (int i = 0; i < {n}; ++i) {{",
        "        after[i] += weights[stage] * rates[i];",
        "        now[i] = start[i] + parts[stage] * rates[i];",
        "    }",
        "}",
        f"for (int i = 0; i < {n}; ++i) {{",
        "    after[i] = start[i] + sixth * after[i];",
        "}",
        *_unit(loops.attitude, precision),
        *(_columns(loops, columns, precision) if columns else []),
        *_stores(program),
    ]


def _tables(columns: Columns | None) -> list[str]:
    """Return the patterns of the rates' Jacobian and of the step's, in compressed columns."""
    if columns is None:
        return []
    named = {
        "rates_colind": columns.rates.colind,
        "rates_row": columns.rates.row,
        "step_colind": columns.step.colind,
        "step_row": columns.step.row,
    }
    return [line for name, values in named.items() for line in table(name, values)]


def _places(program: Program, names: Sequence[str]) -> list[str]:
    found = {
        c: f"{q.name}[{i}]" if q.shape else q.name
        for q in program.inputs
        for i, c in enumerate(q.components)
    }
    return [found[name] for name in names]


def _rates(loops: Compact, program: Program, precision: Precision) -> list[str]:
    """Return the lines that work out the rates at ``now``, and their Jacobian."""
    n, own = len(loops.names), set(loops.names)
    state = _array("now", loops.names)
    given = tuple(q for q in program.inputs if not own & set(q.components))
    entries = len(loops.rate.results) - n
    outputs: tuple[Quantity, ...] = (_array("rates", [f"rate{k}" for k in range(n)]),)
    if loops.columns:
        outputs += (_array("slopes[stage]", [f"slope{k}" for k in range(entries)]),)
    return body(replace(loops.rate, inputs=(state, *given), outputs=outputs), precision)


def _array(name: str, components: Sequence[str]) -> Quantity:
    return Quantity(name, tuple(components), (len(components),), "", "", None, None, "")


def _unit(attitude: int | None, precision: Precision) -> list[str]:
    if attitude is None:
        return []
    kind = precision.scalar
    zero, one = (literal(Fraction(k), precision) for k in (0, 1))
    return [
        f"{kind} squared = {zero};",
        f"for (int i = {attitude}; i < {attitude + 4}; ++i) {{",
        "    squared += after[i] * after[i];",
        "}",
        f"const {kind} scale = {one} / {precision.functions['sqrt']}(squared);",
        f"for (int i = {attitude}; i < {attitude + 4}; ++i) {{",
        "    after[i] = after[i] * scale;",
        "}",
    ]


def _columns(loops: Compact, columns: Columns, precision: Precision) -> list[str]:
    """Return the loop over the columns of derivatives."""
    kind, n, every = precision.scalar, len(loops.names), len(columns.rates.columns)
    zero, one = (literal(Fraction(k), precision) for k in (0, 1))
    last = columns.first + len(columns.step.columns)
    place = f"column - {columns.first}" if columns.first else "column"
    return [
        f"for (int column = {columns.first}; column < {last}; ++column) {{",
        f"    {kind} moved[{every}], change[{n}], total[{n}];",
        f"    for (int i = 0; i < {every}; ++i) {{",
        f"        moved[i] = (i == column) ? {one} : {zero};",
        "    }",
        f"    for (int i = 0; i < {n}; ++i) {{",
        f"        total[i] = {zero};",
        "    }",
        "    for (int stage = 0; stage < 4; ++stage) {",
        f"        for (int i = 0; i < {n}; ++i) {{",
        f"            change[i] = {zero};",
        "        }",
        f"        for (int k = 0; k < {every}; ++k) {{",
        "            for (int entry = rates_colind[k]; entry < rates_colind[k + 1]; ++entry) {",
        "                change[rates_row[entry]] += slopes[stage][entry] * moved[k];",
        "            }",
        "        }",
        f"        for (int i = 0; i < {n}; ++i) {{",
        "            total[i] += weights[stage] * change[i];",
        f"            moved[i] = ((i == column) ? {one} : {zero}) + parts[stage] * change[i];",
        "        }",
        "    }",
        f"    for (int i = 0; i < {n}; ++i) {{",
        f"        total[i] = ((i == column) ? {one} : {zero}) + sixth * total[i];",
        "    }",
        *_indented(_on_the_sphere(loops.attitude, precision)),
        f"    for (int entry = step_colind[{place}]; entry < step_colind[{place} + 1]; ++entry) {{",
        "        jacobian[entry] = total[step_row[entry]];",
        "    }",
        "}",
    ]


def _on_the_sphere(attitude: int | None, precision: Precision) -> list[str]:
    """Return the lines that take from a column what would change the attitude's length."""
    if attitude is None:
        return []
    zero = literal(Fraction(0), precision)
    return [
        f"{precision.scalar} along = {zero};",
        f"for (int i = {attitude}; i < {attitude + 4}; ++i) {{",
        "    total[i] = total[i] * scale;",
        "    along += after[i] * total[i];",
        "}",
        f"for (int i = {attitude}; i < {attitude + 4}; ++i) {{",
        "    total[i] -= after[i] * along;",
        "}",
    ]


def _stores(program: Program) -> list[str]:
    slots = [
        f"{q.name}[{i}]" if q.shape else f"*{q.name}"
        for q in program.outputs
        if q.name != "jacobian"
        for i in range(len(q.components))
    ]
    return [f"{slot} = after[{k}];" for k, slot in enumerate(slots)]


def _indented(lines: Sequence[str]) -> list[str]:
    return [f"    {line}" for line in lines]
