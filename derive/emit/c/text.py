"""A program as C99 text: one line an operation, results stored where they are computed.

Inputs are read before anything is stored, for outputs may lie over them; long functions read where
they need, and store nothing early but entries of a Jacobian, which may not.
"""

from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

from derive.emit.c.sines import sines_type
from derive.emit.c.status import status
from derive.emit.lines import SIGNS, Language, written
from derive.emit.operators import SINES, WRITTEN, literal, patterns
from derive.emit.sines import TOGETHER, together
from derive.lower.order import with_values_read_soon
from derive.program.arithmetic import TRUTHS, pair_of
from derive.program.indexed import Arrays, Assign, Even, Index, Integers, Loop, Row
from derive.program.precision import Precision
from derive.program.program import (
    MATRIX,
    Op,
    Operand,
    Program,
    Quantity,
    every_op,
    operands_of,
    read_by,
)

UNSIGNED_CHAR = 255
LONG = 400  # operations: with so many, inputs that are read first are values too many at once
OWN = {name: row.c for name, row in WRITTEN.items() if row.c}


def function_body(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the lines between the braces of any function but set-up."""
    if program.arithmetic == "pairs":
        return pair_body(program, scene, precision)
    return float_body(program, scene, precision)


def places(quantities: tuple[Quantity, ...]) -> dict[str, str]:
    """Return where in C each component of ``quantities`` is found."""
    found: dict[str, str] = {}
    for q in quantities:
        for i, name in enumerate(q.components):
            if q.role == "constants":
                found[name] = f"constants->{name}"
            else:
                found[name] = f"{q.name}[{i}]" if q.shape else q.name
    return found


def float_body(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the lines between the braces of a hot function."""
    if _has_jacobian(program):  # entries are stored at once: values that live are what it costs
        program = with_values_read_soon(program)
    place = places(program.inputs)
    place |= {n: literal(q[precision.bits], precision) for n, q in program.numbers.items()}
    loads, loaded = _loads(program, place, precision)
    place |= loaded

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return literal(operand, precision)
        return place.get(operand, operand)

    makes = {TOGETHER: f"{scene}_{TOGETHER}_{precision.name}({{0}})"}
    makes |= {f"{part}_of": f"{{0}}.{part}" for part in SINES.values()}
    own = patterns(OWN | makes, partial(literal, precision=precision), precision.bits)
    of = _language(text, own, precision.functions.__getitem__, precision.scalar, precision)
    of = replace(of, line=partial(_line, sines_type(scene, precision), of.line))
    early, lines = _early(program), list[str]()
    for one in together(program.ops):
        made = one.result if isinstance(one, Op) else ""
        stores = [f"{slot} = {made};" for slot in early.get(made, ())]
        lines += [loads.pop(name) for name in tuple(loads) if name in operands_of([one])]
        lines += written(of, [one])
        if stores:
            lines += [*loads.values(), *stores]
            loads.clear()
    done = {slot for slots in early.values() for slot in slots}
    return [*lines, *loads.values(), *_stores(program, text, done)]


def is_long(program: Program) -> bool:
    """Tell whether a function's values are more than registers hold, and few live at once."""
    return _has_jacobian(program) and len(program.ops) >= LONG


def _has_jacobian(program: Program) -> bool:
    """Tell whether a function gives a Jacobian by operations in any order."""
    ordered = program.has_arrays or any(not isinstance(line, Op) for line in program.ops)
    return not ordered and any(q.name == MATRIX for q in program.outputs)


def _loads(
    program: Program, place: Mapping[str, str], precision: Precision
) -> tuple[dict[str, str], dict[str, str]]:
    """Return lines that read what is given in arrays, and names of what they read.

    That is all that is needed, or, where operations read arrays themselves, results alone.
    """
    arrays = {c for q in program.inputs if q.shape and q.role != "constants" for c in q.components}
    late = program.has_arrays or is_long(program)
    read = arrays & ({*program.results} if late else read_by(program))
    loaded = {name: f"{name}_in" for name in place if name in read}
    lines = {n: f"const {precision.scalar} {own} = {place[n]};" for n, own in loaded.items()}
    return lines, loaded


def _early(program: Program) -> dict[str, list[str]]:
    """Return the places of results that are stored where they are computed, by their values."""
    found = dict[str, list[str]]()
    made = {op.result for op in program.ops if isinstance(op, Op)}
    for slot, value in [] if program.has_arrays else _slotted(program):
        if value in made and (slot.startswith(f"{MATRIX}[") or not is_long(program)):
            found.setdefault(str(value), []).append(slot)
    return found


def _line(kind: str, otherwise: Callable[[Op, str], str], op: Op, value: str) -> str:
    if op.operator == TOGETHER:
        return f"const {kind} {op.result} = {value};"
    return otherwise(op, value)


def pair_body(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the lines of a program in pairs of floats: rounded once, at the end."""
    place = places(program.inputs)
    zero = literal(Fraction(0), precision)
    pair = f"{scene}_pair_{precision.name}"

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            high, low = (literal(part, precision) for part in pair_of(operand, precision.dtype))
            return f"({pair}){{{high}, {low}}}"
        if operand in place:
            return f"({pair}){{{place[operand]}, {zero}}}"
        return operand

    def stored(operand: Operand) -> str:
        if isinstance(operand, str) and operand not in place:
            return f"{operand}.high"
        return literal(operand, precision) if isinstance(operand, Fraction) else place[operand]

    def call(operator: str) -> str:
        return f"{scene}_{operator}_{precision.name}"

    # Of truths, or a choice between two structs.
    own = {n: row.c or row.sign for n, row in WRITTEN.items() if row.rests is None}
    of = _language(text, own, call, pair, precision)
    lines = written(of, program.ops) + _stores(program, stored)
    return [*lines, *(status(program, stored, zero) if program.makes("constants") else ())]


def _language(
    text: Callable[[Operand], str],
    own: Mapping[str, str],
    call: Callable[[str], str],
    kind: str,
    precision: Precision,
) -> Language:
    """Return how C is written; ``kind`` is the type of what operations give and loops carry."""
    scalar = precision.scalar

    def line(op: Op, value: str) -> str:
        return f"const {'_Bool' if op.operator in TRUTHS else kind} {op.result} = {value};"

    def assign(line: Assign, value: str) -> str:
        makes = {"": "", "constant": f"const {scalar} ", "variable": f"{scalar} "}[line.makes]
        return f"{makes}{line.target} {SIGNS[line.adds]} {value};"

    def whole(index: Index) -> str:
        return f"({scalar})({index})" if index.plus else f"({scalar}){index}"

    one, zero = (literal(Fraction(n), precision) for n in (1, 0))
    same = f"({{0}} == {{1}}) ? {one} : {zero}"
    carried, declared = partial(_carried, kind), partial(_declared, scalar)
    return Language(text, own, call, line, carried, declared, assign, _head, ("}",), whole, same)


def _carried(kind: str, of: Language, loop: Loop) -> tuple[list[str], list[str]]:
    begin = [f"{kind} {c} = {of.text(s)};" for c, s in zip(loop.carried, loop.start, strict=True)]
    kept = {c: f"{c}_then" for c in loop.carried if c in loop.then}
    after = [f"const {kind} {name} = {c};" for c, name in kept.items()]
    after += [
        f"{c} = {kept.get(t, of.text(t)) if isinstance(t, str) else of.text(t)};"
        for c, t in zip(loop.carried, loop.then, strict=True)
        if c != t
    ]
    end = [] if loop.done is None else [f"if ({of.text(loop.done)}) {{", "    break;", "}"]
    return begin, [*after, *end]


def _declared(scalar: str, of: Language, line: Arrays | Integers | Row) -> list[str]:
    if isinstance(line, Arrays):
        every = (f"{name}{''.join(f'[{n}]' for n in sizes)}" for name, sizes in line.sizes)
        return [f"{scalar} {', '.join(every)};"]
    if isinstance(line, Integers):
        return constant_array(line.name, line.values)
    fixed = "" if any(isinstance(v, str) for v in line.values) else "static "
    values = ", ".join(map(of.text, line.values))
    return [f"{fixed}const {scalar} {line.name}[{len(line.values)}] = {{{values}}};"]


def constant_array(name: str, values: Sequence[int]) -> list[str]:
    """Return the lines of a constant table, in the smallest type that holds its numbers."""
    kind = "unsigned char" if max(values) <= UNSIGNED_CHAR else "unsigned short"
    lines, line = [f"static const {kind} {name}[{len(values)}] = {{"], ""
    for value in values:
        if len(line) > 80:
            lines.append(f"    {line.rstrip()}")
            line = ""
        line += f"{value}, "
    return [*lines, f"    {line.rstrip(', ')}", "};"]


def _head(line: Loop | Even) -> list[str]:
    if isinstance(line, Even):
        i = line.counter
        return [f"if (({i} % 2) == 0) {{", f"    const int {line.half} = {i} / 2;"]
    i = line.counter or f"pass_{line.carried[0]}"
    sign, below = ("++", "<") if line.step > 0 else ("--", ">")
    if not line.mirror:
        return [f"for (int {i} = {line.first}; {i} {below} {line.last}; {sign}{i}) {{"]
    m, end = line.mirror, line.mirror if line.meets else line.last
    start = Index(line.last.counter, line.last.plus - 1)
    return [f"for (int {i} = {line.first}, {m} = {start}; {i} < {end}; ++{i}, --{m}) {{"]


def _stores(
    program: Program, text: Callable[[Operand], str], done: Container[str] = ()
) -> list[str]:
    """Return the stores at the end, of all places but those that are done."""
    held = [(slot, text(r)) for slot, r in _slotted(program) if slot not in done]
    return [f"{slot} = {value};" for slot, value in held if slot != value]


def _slotted(program: Program) -> list[tuple[str, Operand]]:
    """Return where in C each result is stored, with the result."""
    return list(zip(result_slots(program), program.results, strict=True))


def result_slots(program: Program) -> list[str]:
    """Return where in C each component of the outputs is stored."""
    return [slot for q in program.outputs for slot in _slots(q)]


def _slots(q: Quantity) -> list[str]:
    if q.role == "constants":
        return [f"constants->{name}" for name in q.components]
    return [f"{q.name}[{i}]" for i in range(len(q.components))] if q.shape else [f"*{q.name}"]


def pair_functions(programs: Iterable[Program]) -> list[str]:
    """Return the pair operations that programs in pairs need, each after those it rests on."""
    used = {op.operator for program in programs for op in every_op(program.ops)}
    wanted = used | {name for kind in used for name in WRITTEN[kind].rests or ()}
    return [name for name, row in WRITTEN.items() if name in wanted and row.rests is not None]
