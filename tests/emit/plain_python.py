"""A scene's functions as plain Python: a language as anyone may add one, a file and a template.

Nothing of the package knows it. It shows what a printer is told, and what it has to say itself.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path

from derive.emit.lines import SIGNS, Language, written
from derive.emit.operators import patterns
from derive.emit.templates import templates_of
from derive.program.arithmetic import pair_of
from derive.program.indexed import Arrays, Assign, Even, Index, Integers, Loop, Row
from derive.program.pair_sine import coefficients, quarter_turn
from derive.program.precision import F64
from derive.program.program import Op, Operand, Program, component_names

OWN = {
    "both": "({0} and {1})",
    "either": "({0} or {1})",
    "select": "({1} if {0} else {2})",
}


def python_file(programs: Sequence[Program], own: Mapping[str, str]) -> str:
    """Return the text of a module with a function a program; each takes and returns a dictionary.

    own : the operators that are no call and have no sign
    """
    return (
        templates_of(Path(__file__).parent)
        .get_template("plain_python.py.jinja")
        .render(
            functions=[_function(program, own) for program in programs],
            odd=[_pair(q) for q in coefficients(F64.bits, 1)],
            even=[_pair(q) for q in coefficients(F64.bits, 0)],
            quarter=[float(q) for q in quarter_turn(lambda q: Fraction(float(q)))],
        )
    )


def _function(program: Program, own: Mapping[str, str]) -> dict[str, object]:
    place = {c: f"given[{c!r}]" for q in program.inputs for c in q.components}
    place |= {name: repr(float(q[F64.bits])) for name, q in program.numbers.items()}
    pairs = program.arithmetic == "pairs"

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return str(_pair(operand)) if pairs else repr(float(operand))
        return (
            place.get(operand, operand)
            if not pairs or operand not in place
            else (f"({place[operand]}, 0.0)")
        )

    def call(operator: str) -> str:
        return f"_{operator}" if pairs else f"math.{F64.functions[operator]}"

    known = own if pairs else patterns(own, lambda q: repr(float(q)), F64.bits)
    of = Language(text, known, call, _line, _carried, _declared, _assign, _head, (),
                  "float({})".format, "float({0} == {1})")  # fmt: skip
    components = component_names(program)
    arrays = [f"{q.name} = [{', '.join(place[c] for c in q.components)}]" for q in program.inputs]
    arrays += [f"{q.name} = [0.0] * {len(q.components)}" for q in program.outputs if q.shape]
    results = [f"{text(r)}[0]" if pairs else text(r) for r in program.results]
    return {
        "name": program.name,
        "lines": (arrays if program.has_arrays else []) + written(of, program.ops),
        "results": dict(zip(components, results, strict=True)),
    }


def _pair(q: Fraction) -> tuple[float, float]:
    high, low = pair_of(q, F64.dtype)
    return float(high), float(low)


def _line(op: Op, value: str) -> str:
    return f"{op.result} = {value}"


def _carried(of: Language, loop: Loop) -> tuple[list[str], list[str]]:
    carried, start, then = (
        ", ".join(map(of.text, each)) for each in (loop.carried, loop.start, loop.then)
    )
    done = [] if loop.done is None else [f"if {of.text(loop.done)}:", "    break"]
    return [f"{carried} = {start}"], [f"{carried} = {then}", *done]


def _declared(of: Language, line: Arrays | Integers | Row) -> list[str]:
    if isinstance(line, Arrays):
        return [f"{name} = np.empty({sizes}).tolist()" for name, sizes in line.sizes]
    values = map(str, line.values) if isinstance(line, Integers) else map(of.text, line.values)
    return [f"{line.name} = [{', '.join(values)}]"]


def _assign(line: Assign, value: str) -> str:
    return f"{line.target} {SIGNS[line.adds]} {value}"


def _head(line: Loop | Even) -> list[str]:
    i, j = line.counter or "_", line.half if isinstance(line, Even) else line.mirror
    if isinstance(line, Even):
        return [f"if {i} % 2 == 0:", f"    {j} = {i} // 2"]
    down = Index(line.last.counter, line.last.plus - 1)
    head = [f"for {i} in range({line.first}, {line.last}, {line.step}):"]
    head += [f"    {j} = {down} - ({i} - ({line.first}))"] * bool(j)
    return [*head, *[f"    if {i} >= {j}: break"] * line.meets]
