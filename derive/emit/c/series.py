"""A Taylor step as C and as CasADi: loops over orders, everything computed before it is stored."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction

from derive.emit.c.text import body, places
from derive.emit.operators import literal
from derive.motion.taylor.series import INVERSE, ORDER, SHARE, Convolution, Series
from derive.program.arithmetic import rounded
from derive.program.precision import F64, Precision
from derive.program.program import Op, Operand

Text = Callable[[Operand], str]


def series_c(series: Series, precision: Precision) -> list[str]:
    """Return the lines between the braces of a step in C."""
    kind, last = precision.scalar, series.order
    text = _c_operand(series, precision)
    only = series.kept_only()
    return [
        *(f"{kind} {x}_terms[{last + 1}];" for x in series.rates),
        *(f"{kind} {name}_terms[{last}];" for name in only),
        *_c_lines(series, series.start, precision),
        *(f"{x}_terms[1] = time_step * {text(rate)};" for x, (rate, _) in series.rates.items()),
        f"for (int k = 1; k < {last}; ++k) {{",
        *_indented(_c_order(series, precision)),
        "}",
        *(f"{kind} {x}_sum = {x}_terms[{last}];" for x in series.rates),
        f"for (int k = {last - 1}; k > 0; --k) {{",
        *_indented([f"{x}_sum += {x}_terms[k];" for x in series.rates]),
        "}",
        *(f"const {kind} {name} = {term};" for name, term in _ends(series)),
        *body(replace(series.signature, ops=series.closing(precision.bits)), precision),
    ]


def _c_operand(series: Series, precision: Precision) -> Text:
    place = places(series.inputs)

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return literal(operand, precision)
        return place.get(operand, operand)

    return text


def _c_lines(series: Series, ops: Sequence[Op], precision: Precision) -> list[str]:
    part = replace(series.signature, outputs=(), ops=tuple(ops), results=())
    return body(part, precision)


def _c_order(series: Series, precision: Precision) -> list[str]:
    """Return the lines of the loop over k: terms of order k, those of the states of order k + 1."""
    kind, one = precision.scalar, literal(Fraction(1), precision)
    text = _c_operand(series, precision)
    given = {SHARE: f"time_step / ({kind})(k + 1)", ORDER: f"({kind})k"}
    given |= {INVERSE: f"{one} / ({kind})k"} | {f"{x}_k": f"{x}_terms[k]" for x in series.rates}
    read = series.read_at_k()
    return [
        *(f"const {kind} {name} = {value};" for name, value in given.items() if name in read),
        *_c_sums(series, precision),
        *_c_lines(series, series.each, precision),
        *(f"{name}_terms[k] = {name}_k;" for name in series.kept_only()),
        *(f"{x}_terms[k + 1] = {_share(rate, text)};" for x, (_, rate) in series.rates.items()),
    ]


def _share(rate: Operand, text: Text) -> str:
    return f"{SHARE} * {text(rate)}" if rate != 0 else text(rate)


def _ends(series: Series) -> list[tuple[str, str]]:
    """Return the names that the end of a step gives to single terms, and those terms."""
    read = {operand for op in series.close for operand in op.operands}
    ends = {"first": 1, "before": series.order - 1, "last": series.order}
    every = ((f"{x}_{end}", f"{x}_terms[{k}]") for x in series.rates for end, k in ends.items())
    return [(name, term) for name, term in every if name in read]


def _indented(lines: Sequence[str]) -> list[str]:
    return [f"    {line}" for line in lines]


def _c_sums(series: Series, precision: Precision) -> list[str]:
    zero = literal(Fraction(0), precision)
    every = (*series.products, *series.squares)
    found = [f"{precision.scalar} {c.result} = {zero};" for c in every]
    for sums, end in ((series.products, "k"), (series.squares, "m")):
        if sums:
            found.append(f"for (int j = 1, m = k - 1; j < {end}; ++j, --m) {{")
            found += [f"    {_added(c, 'j', 'm')};" for c in sums]
            found.append("}")
    if series.squares:
        found += [f"{c.result} += {c.result};" for c in series.squares]
        found += ["if (k % 2 == 0) {", "    const int m = k / 2;"]
        found += [f"    {_added(c, 'm', 'm')};" for c in series.squares]
        found.append("}")
    return found


def _added(c: Convolution, j: str, m: str) -> str:
    """Return the statement, C or Python, that adds the products of terms j and m."""
    plus, minus = (
        [f"{left}_terms[{j}] * {right}_terms[{m}]" for left, right in pairs]
        for pairs in (c.plus, c.minus)
    )
    if not plus:
        return f"{c.result} -= {' + '.join(minus)}"
    return f"{c.result} += {' - '.join([' + '.join(plus), *minus])}"


def series_casadi(series: Series, operation: Callable[[Op, Text], str]) -> list[str]:
    """Return the lines of Python that build a step in CasADi, operation by operation as the C.

    The inputs are there as SX by their names; results are read as ``casadi_results`` says.
    operation : how one operation is written, given how an operand is
    """
    text, last = _python_operand(series), series.order

    def lines(ops: Sequence[Op]) -> list[str]:
        return [f"{op.result} = {operation(op, text)}" for op in ops]

    rates = series.rates.items()
    inner = [
        f"{SHARE}, {ORDER}, {INVERSE} = time_step / (k + 1.0), float(k), 1.0 / k",
        *(f"{x}_k = {x}_terms[k]" for x in series.rates),
        *_python_sums(series),
        *lines(series.each),
        *(f"{name}_terms.append({name}_k)" for name in series.kept_only()),
        *(f"{x}_terms.append({_share(rate, text)})" for x, (_, rate) in rates),
    ]
    return [
        *lines(series.start),
        *(f"{x}_terms = [None, time_step * {text(rate)}]" for x, (rate, _) in rates),
        *(f"{name}_terms = [None]" for name in series.kept_only()),
        f"for k in range(1, {last}):",
        *_indented(inner),
        *(f"{x}_sum = {x}_terms[{last}]" for x in series.rates),
        f"for k in range({last - 1}, 0, -1):",
        *_indented([f"{x}_sum += {x}_terms[k]" for x in series.rates]),
        *(f"{name} = {term}" for name, term in _ends(series)),
        *lines(series.closing(F64.bits)),
    ]


def casadi_results(series: Series) -> list[str]:
    """Return how each output component is read after ``series_casadi``'s lines."""
    return [_python_operand(series)(result) for result in series.results]


def _python_operand(series: Series) -> Text:
    place = {c: f"{q.name}[{i}]" for q in series.inputs for i, c in enumerate(q.components)}

    def text(operand: Operand) -> str:
        if isinstance(operand, Fraction):
            return repr(float(rounded(operand, F64.dtype)))
        return place.get(operand, operand)

    return text


def _python_sums(series: Series) -> list[str]:
    found = [f"{c.result} = 0.0" for c in (*series.products, *series.squares)]
    for sums, end in ((series.products, "k"), (series.squares, "(k + 1) // 2")):
        if sums:
            found.append(f"for j, m in zip(range(1, {end}), range(k - 1, 0, -1)):")
            found += [f"    {_added(c, 'j', 'm')}" for c in sums]
    if series.squares:
        found += [f"{c.result} += {c.result}" for c in series.squares]
        found += ["if k % 2 == 0:", "    m = k // 2"]
        found += [f"    {_added(c, 'm', 'm')}" for c in series.squares]
    return found
