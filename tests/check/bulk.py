"""Compiled C and its programs at thousands of inputs, and mutants of the C's text."""

import ctypes
import re
from collections.abc import Iterator, Mapping
from math import nextafter, prod
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

from derive.check.agreement import arithmetic_of
from derive.check.compiler import answer_of, callable_library, find_compiler
from derive.emit.c.batch import batch_file, batch_symbol, is_prepared, own_inputs
from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import component_names
from derive.verify.columns import Supplied, arithmetics, in_columns
from derive.verify.draw import Dice, Sampled, complete, drawn

Columns = Mapping[str, Any]
QUICKLY = ("-std=c99", "-O0", "-w", "-fPIC", "-shared")


def shared(library: Library, precision: Precision, texts: Mapping[str, str], folder: Path) -> Path:
    """Return a shared library of a scene's C of one precision, with its loops; warnings pass."""
    folder.mkdir(parents=True)
    loops, text = batch_file(library, precision)
    for name, own in {**texts, loops: text}.items():
        if f"_{precision.name}" in name:
            (folder / name).write_text(own, encoding="utf-8")
    answer_of((*find_compiler().command, *QUICKLY, loops, "-o", "scene.so", "-lm"), folder)
    return folder / "scene.so"


def inputs_at(library: Library, precision: Precision, count: int) -> Supplied:
    """Return so many inputs of all functions on the declared ranges."""
    of = Sampled(library, precision)
    return complete(of, drawn(of, Dice("bulk"), count))


def replayed_at(library: Library, precision: Precision, at: Supplied, made: Path) -> Columns:
    """Return what programs give, with the sines that a library is linked with."""
    by = arithmetics(precision.dtype)
    plans = Sampled(library, precision).plans
    linked = {**by.own, **arithmetic_of(callable_library(made), precision)}
    found = {}
    with np.errstate(all="ignore"):
        for plan in plans:
            if plan.program.arithmetic == "pairs":
                pairs = {name: (x, x * 0) for name, x in at.own.items()}
                rows = [x[0] for x in in_columns(plan, by.made, pairs)]
            else:
                rows = in_columns(plan, linked, at.own)
            found[plan.program.name] = _table(rows, precision, _count(at))
    return found


def returned_at(library: Library, precision: Precision, at: Supplied, made: Path) -> Columns:
    """Return what the functions of compiled C give."""
    loaded, count, found = callable_library(made), _count(at), {}
    for program in library.printed():
        given = [q.components for q in own_inputs(program)]
        given += [q.components for q in library.setup.inputs] if is_prepared(program) else []
        arrays = [_table([at.own[c] for c in own], precision, count) for own in given]
        steps = (ctypes.c_ssize_t * len(given))(*map(len, given))
        out = [np.zeros((count, prod(q.shape)), precision.dtype) for q in program.outputs]
        loop = loaded[batch_symbol(library, program.name, precision)]
        loop.argtypes = [ctypes.c_ssize_t, *[ctypes.c_void_p] * 5]
        member = ctypes.c_ssize_t()
        loop(count, _places(arrays), steps, _places(out), None, ctypes.byref(member))
        found[program.name] = np.concatenate(out, axis=1)
        assert found[program.name].shape[1] == len(component_names(program))
    return found


def _count(at: Supplied) -> int:
    return len(next(iter(at.own.values())))


def _table(rows: list[Any], precision: Precision, count: int) -> Any:
    every = [np.broadcast_to(x, (count,)).astype(precision.dtype) for x in rows]
    return np.ascontiguousarray(np.array(every).T)


def _places(arrays: list[Any]) -> Any:
    return (ctypes.c_void_p * len(arrays))(*[a.ctypes.data for a in arrays])


def differing(a: Columns, b: Columns) -> list[str]:
    """Return the functions of which a bit differs; one NaN is as good as another."""
    return [n for n in a if not np.all(_bits(a[n]) == _bits(b[n]))]


def _bits(table: Any) -> Any:
    whole = np.where(np.isnan(table), np.nan, table).astype(table.dtype)
    return whole.view(np.uint32 if table.dtype == np.float32 else np.uint64)


STATEMENT = re.compile(r"^ {4,}(?:const \w+ )?\*?[\w\[\]>-]+ = [^;]*;$", re.MULTILINE)
TEMPLATES = re.compile(r"^(?:\w+ )?static [^;]*?\)\n\{.*?^\}", re.MULTILINE | re.DOTALL)
"""Functions that templates hold: operations on pairs, sines."""
DENSE = re.compile(r"^void \w+_dense_f\d\d\(.*?^\}", re.MULTILINE | re.DOTALL)
"""Functions whose lines are those of another (``tests/emit/test_stores.py``)."""
FLIPS = (
    (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" < ", " > "),
    (r"_add_", "_sub_"), (r"_sub_", "_add_"), (r"_mul_", "_div_"), (r"_div_", "_mul_"),
)  # fmt: skip
SWAPS = (
    (r"= ([\w>[\].-]+) ([-/]) ([\w>[\].-]+);", r"= \3 \2 \1;"),
    (r"\? ([\w>[\].-]+) : ([\w>[\].-]+);", r"? \2 : \1;"),
)
NUMBER = re.compile(r"(?<![\w.])(\d+\.\d+(?:e[+-]?\d+)?)(F?)")
INDEX = re.compile(r"(\w+)\[(\d)\]")


def mutants(text: str, dice: Random) -> Iterator[tuple[str, str]]:
    """Yield texts with one statement of a function wrong, and that statement; without an end.

    An operator is another, operands or results are exchanged, a number or an index is the next.
    What templates hold is left as it is: a last place of pi in a sine may change no bit. So are
    dense functions, which have the lines of the sparse ones.
    """
    own = [m.span() for pattern in (TEMPLATES, DENSE) for m in pattern.finditer(text)]
    every = [m.span() for m in STATEMENT.finditer(text)]
    places = [(a, b) for a, b in every if not any(low < a < high for low, high in own)]
    while True:
        begin, end = dice.choice(places)
        wrong = _wrong(text[begin:end], dice)
        if wrong != text[begin:end]:
            yield f"{text[:begin]}{wrong}{text[end:]}", wrong.strip()


def _wrong(line: str, dice: Random) -> str:
    ways = [(p, new) for p, new in (*FLIPS, *SWAPS) if re.search(p, line)]
    ways += [(NUMBER, _next)] * bool(NUMBER.search(line)) + [(INDEX, _neighbour)] * bool(
        INDEX.search(line.partition("=")[2])
    )
    if not ways:
        return line
    pattern, new = dice.choice(ways)
    head, sign, rest = line.partition("=")
    found = list(re.finditer(pattern, sign + rest))
    if not found:
        return line
    one = dice.choice(found)
    whole = sign + rest
    return head + whole[: one.start()] + re.sub(pattern, new, one[0]) + whole[one.end() :]


def _next(found: re.Match[str]) -> str:
    x = float(found[1])
    near = float(np.nextafter(np.float32(x), np.float32(9e9))) if found[2] else nextafter(x, 9e9)
    return f"{near!r}{found[2]}" if x else found[0]


def _neighbour(found: re.Match[str]) -> str:
    return f"{found[1]}[{max(int(found[2]) - 1, 0) or 1}]"
