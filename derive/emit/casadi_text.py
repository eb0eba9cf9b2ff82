"""The scene's functions as CasADi: Python that builds them, operation by operation as the C."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from fractions import Fraction

import numpy as np

from derive.emit.c.comment import singular_clause
from derive.emit.c.external import OPTION, described
from derive.emit.c.scope import declared_in_python, require_free
from derive.emit.c.sines import numbers_of_sines, takes_sines
from derive.emit.c.source import first_line
from derive.emit.c.text import pair_functions
from derive.emit.lines import SIGNS, Language, operation_text, written
from derive.emit.operators import SINES, WRITTEN, patterns
from derive.emit.packed import Packed, packed, range_of, scale_of
from derive.emit.sines import TOGETHER, together
from derive.emit.templates import TEMPLATES
from derive.library.external import StepDerivatives
from derive.library.library import Library
from derive.program.arithmetic import pair_of, rounded
from derive.program.indexed import Arrays, Assign, Even, Index, Integers, Loop, Row
from derive.program.pair_sine import coefficients, quarter_turn
from derive.program.precision import F64
from derive.program.program import (
    Line,
    Measurement,
    Op,
    Operand,
    Program,
    Quantity,
    every_op,
    placed,
)
from derive.program.status import possible, tried

KEPT = "_kept("
BROKEN = {"finite": "_endless({})", "positive": "{} <= 0.0", "not negative": "{} < 0.0",
          "within": "ca.logic_not(ca.logic_and({1} <= {0}, {0} <= {2}))"}  # fmt: skip


def casadi_file(
    library: Library, figures: Sequence[Measurement] = (), of: StepDerivatives | None = None
) -> str:
    """Return the text of ``<scene>_casadi.py``.

    of : the derivatives of a step for which C lies beside it; the module then loads that C
    """
    name = library.scene.name
    has_setup = bool(library.constants)
    motion = packed(library)
    hidden = [motion.rate] if motion and motion.rate not in library.printed() else []
    in_pairs = [p for p in (*library.emitted(), *hidden) if p.arithmetic == "pairs"]
    functions = [_function(p, name) for p in (*library.printed(), *hidden)]
    sines = any(map(takes_sines, _every(library, hidden)))
    return TEMPLATES.get_template("casadi.py.jinja").render(
        first_line=first_line(library, figures, () if of is None else (OPTION,)),
        title=library.scene.title,
        scene=name,
        setup=_setup(library.setup, name) if has_setup else None,
        pairs=bool(in_pairs),
        kept=bool(in_pairs) or sines or any(KEPT in str(f["lines"]) for f in functions),
        sines=numbers_of_sines(F64.bits, _literal) if sines else None,
        turns=any(name in ("sin", "cos") for name in pair_functions(in_pairs)),
        odd=[tuple(map(float, pair_of(c, F64.dtype))) for c in coefficients(F64.bits, 1)],
        even=[tuple(map(float, pair_of(c, F64.dtype))) for c in coefficients(F64.bits, 0)],
        quarter=[float(part) for part in quarter_turn(lambda q: rounded(q, F64.dtype))],
        functions=functions,
        sloped=any(p.free or p.slopes for p in library.printed()),
        free=any(p.free for p in library.printed()),
        packed=None if motion is None else _of_solvers(motion),
        external=None if of is None else described(library),
    )


OWN = {name: row.casadi for name, row in WRITTEN.items() if row.casadi}
BOTH = {
    TOGETHER: f"_{TOGETHER}({{0}})",
    **{f"{name}_of": f"{{0}}[{place}]" for place, name in enumerate(SINES.values())},
}


def _every(library: Library, hidden: Sequence[Program]) -> Iterator[Program]:
    """Yield all programs that the module may have lines of."""
    for p in (*library.printed(), *hidden):
        yield p.unrolled or p
        if p.slopes is not None:
            yield p.slopes


def _pairs(program: Program, place: dict[str, str]) -> tuple[list[str], Callable[[Operand], str]]:
    """Return the lines of a program in pairs, and how to read a result rounded."""

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return repr(tuple(map(float, pair_of(operand, F64.dtype))))
        return f"({place[operand]}, 0.0)" if operand in place else operand

    def stored(operand: Operand) -> str:
        return (
            _literal(operand)
            if isinstance(operand, Fraction)
            else place.get(operand, f"{operand}[0]")
        )

    own = {name: OWN[name] for name in ("both", "either")}
    return written(_language(text, own, "_", ()), program.ops), stored


def _literal(q: Fraction) -> str:
    return repr(float(rounded(q, F64.dtype)))


def _language(
    text: Callable[[Operand], str], own: Mapping[str, str], before: str, kept: Collection[str]
) -> Language:
    """Return how Python builds CasADi; a loop is unrolled where it is built.

    before : what stands before the name of an operator that is called
    kept   : the results whose rounding is worked out
    """

    def line(op: Op, value: str) -> str:
        return f"{op.result} = {KEPT}{value})" if op.result in kept else f"{op.result} = {value}"

    def assign(line: Assign, value: str) -> str:
        return f"{line.target} {SIGNS[line.adds]} {value}"

    def called(operator: str) -> str:
        return f"{before}{operator}"

    same = "float({0} == {1})"
    return Language(
        text, own, called, line, _carried, _declared, assign, _head, (), "float({})".format, same
    )


def _carried(of: Language, loop: Loop) -> tuple[list[str], list[str]]:
    text, carried, done = of.text, ", ".join(loop.carried), f"done_{loop.carried[0]}"
    begin = [f"{carried} = {', '.join(map(text, loop.start))}"]
    then, end = [*map(text, loop.then)], []
    if loop.done is not None:
        begin.append(f"{done} = ca.SX(0)")
        then = [
            operation_text(of, "select", (done, c, t))
            for c, t in zip(loop.carried, then, strict=True)
        ]
        end = [f"{done} = {operation_text(of, 'either', (done, text(loop.done)))}"]
    return begin, [f"{carried} = {', '.join(then)}", *end]


def _declared(of: Language, line: Arrays | Integers | Row) -> list[str]:
    if isinstance(line, Arrays):
        return [f"{name} = {_list(sizes)}" for name, sizes in line.sizes]
    if isinstance(line, Integers):
        return [f"{line.name} = {list(line.values)}"]
    return [f"{line.name} = [{', '.join(map(of.text, line.values))}]"]


def _list(sizes: Sequence[int]) -> str:
    first, *rest = sizes
    return f"[{_list(rest)} for _ in range({first})]" if rest else f"[None] * {first}"


def _head(line: Loop | Even) -> list[str]:
    if isinstance(line, Even):
        return [f"if {line.counter} % 2 == 0:", f"    {line.half} = {line.counter} // 2"]
    i, m, first, last = line.counter or "_", line.mirror, line.first, line.last
    if not m:
        begin, step = "" if first == Index() else f"{first}, ", "" if line.step > 0 else ", -1"
        return [f"for {i} in range({begin}{last}{step}):"]
    below = Index(last.counter, last.plus - 1)
    end = f"({last} + 1) // 2" if line.meets else f"{last}"  # they meet there if first is 1
    return [f"for {i}, {m} in zip(range({first}, {end}), range({below}, 0, -1)):"]


def _setup(program: Program, scene: str) -> dict[str, object]:
    names = {c: f"parameters[{i}]" for i, c in enumerate(_components(program.inputs))}
    lines, stored = _pairs(program, names)
    return {
        "name": f"{scene}_setup",
        "parameters": _components(program.inputs),
        "constants": _components(program.outputs),
        "lines": lines,
        "results": [stored(r) for r in program.results],
        "says": possible(program),
        "status": list(_status(program, stored)),
        "largest": repr(float(np.finfo(F64.dtype).max)),
    }


def _status(program: Program, stored: Callable[[Operand], str]) -> Iterator[str]:
    """Yield the lines that find the status; the rule that counts most is tried last."""
    for number, kept in reversed(tried(program)):
        tests = (
            BROKEN[relation].format(stored(value), *map(stored, ends))
            for relation, value, ends in kept
        )
        yield f"status = _refused(status, {number}, {', '.join(tests)})"


def _of_solvers(motion: Packed) -> dict[str, object]:
    each = [(c, q) for q in motion.given() for c in q.components]
    whole = [q for q in motion.given() if q.components != (q.name,)]
    return {
        "states": _components(motion.states),
        "inputs": _components(motion.inputs),
        "units": {c: q.unit for c, q in each},
        "ranges": {c: list(range_of(q)) for c, q in each},
        "scales": {c: scale_of(q) for c, q in each},
        "parts": {q.name: list(q.components) for q in whole},
        "attitudes": motion.attitudes(),
        "rate": motion.rate.name,
        "step": motion.step.name if motion.step else None,
    }


def _components(quantities: tuple[Quantity, ...]) -> list[str]:
    return [c for q in quantities for c in q.components]


def plain_lines(
    program: Program, place: dict[str, str]
) -> tuple[list[str], Callable[[Operand], str]]:
    """Return the lines of a program in the working precision, and how to read a result."""

    known = place | {n: _literal(q[F64.bits]) for n, q in program.numbers.items()}

    def text(operand: Operand) -> str:
        return _literal(operand) if isinstance(operand, Fraction) else known.get(operand, operand)

    own = patterns(OWN | BOTH, _literal, F64.bits)
    lines = together(program.ops)
    return written(_language(text, own, "ca.", _to_keep(program.ops)), lines), text


def _to_keep(lines: Sequence[Line]) -> frozenset[str]:
    """Return the sums whose rounding is worked out: CasADi would make b of (a + b) - a."""
    made = {op.result: op for op in every_op(lines) if op.operator in ("add", "sub")}
    return frozenset(
        operand
        for op in made.values()
        for operand, other in (op.operands, op.operands[::-1])
        if isinstance(operand, str) and operand in made and other in made[operand].operands
    )


def _function(program: Program, scene: str) -> dict[str, object]:
    program = program.unrolled or program  # CasADi has no loops to save memory with
    place = {c: f"{q.name}[{i}]" for q in program.inputs for i, c in enumerate(q.components)}
    lines, text = (_pairs if program.arithmetic == "pairs" else plain_lines)(program, place)
    lines, ends = _ends(program, lines, text, place)
    given = [q.name for q in program.inputs]
    require_free(scene, program.name, given, declared_in_python(lines))
    return {
        "builder": program.name,
        "name": f"{scene}_{program.name}",
        "says": program.says,
        "singular": [singular_clause(s) for s in program.singular],
        "inputs": [{"name": q.name, "size": len(q.components)} for q in program.inputs],
        "needs_constants": any(q.role == "constants" for q in program.inputs),
        "lines": lines,
        "outputs": _outputs(program, ends),
    }


def _ends(
    program: Program, lines: list[str], text: Callable[[Operand], str], place: dict[str, str]
) -> tuple[list[str], list[str]]:
    """Return the lines with those that mend slopes, and how to read the results."""
    ends = [text(x) for x in program.results]
    if program.free:
        return [*lines, *_with_slope(program, text)], [f"ends[{k}]" for k in range(len(ends))]
    if program.slopes is not None:
        more, own = plain_lines(program.slopes, place)
        ends_too = ", ".join(own(x) for x in program.slopes.results)
        given = ", ".join(q.name for q in program.inputs if q.role != "constants")
        made = f"ends = _sloped(ca.vertcat({', '.join(ends)}), ca.vertcat({ends_too}), {given})"
        return [*lines, *more, made], [f"ends[{k}]" for k in range(len(ends))]
    return lines, ends


def _with_slope(program: Program, text: Callable[[Operand], str]) -> Iterator[str]:
    free, results = (", ".join(map(text, operands)) for operands in (program.free, program.results))
    yield f"free = [{free}]"
    given = ", ".join(q.name for q in program.inputs if q.role != "constants")
    yield f"ends = _with_slope(ca.vertcat({results}), free, {given})"


def _outputs(program: Program, ends: Sequence[str]) -> list[dict[str, object]]:
    outputs: list[dict[str, object]] = []
    for q, place in placed(program.outputs):
        pattern = (program.sparsity or {}).get(q.name)
        shape = None
        if pattern is not None:
            size = f"{len(pattern.rows)}, {len(pattern.columns)}"
            shape = f"{size}, {list(pattern.colind)}, {list(pattern.row)}"
        outputs.append({"name": q.name, "values": ends[place], "sparsity": shape})
    return outputs
