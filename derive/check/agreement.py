"""Emitted C beside its program, beside CasADi, beside the reference, and over its own inputs.

Bits are compared where both sides run the same operations: what the C asks its library (atan2, and
sines of large angles) is taken from there, all other operations are IEEE's.
"""

import ctypes
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from statistics import median
from typing import Any

import casadi
import numpy as np

from derive.check.emitted import Emitted, errors_of, from_parameters, inputs, verdict
from derive.check.verdict import JUDGED, Verdict
from derive.program.arithmetic import LIBM, TURNS, of_turns, working
from derive.program.largest import largest
from derive.program.precision import Precision
from derive.program.program import MATRIX, Program
from derive.scene.formula import Arithmetic
from derive.verify.draw import Sampled
from derive.verify.measure import Errors, replayed, should, should_move
from derive.verify.sample import Sample

MEDIAN_BOUND, LARGEST_BOUND = 2.0, 16.0
"""In u: what half of the errors keep, and all at a few samples where no largest one is stated."""
USUAL = 1.5  # the median of a few samples may be so much above that of all
MORE = 1.1  # other samples than the printed figure's may find an error this much larger
ABSURD = 1e6
"""In u: a larger figure says nothing of a result, or is a part of a scale that vanishes."""


def same_bits(a: Sequence[float], b: Sequence[float]) -> bool:
    """Tell whether two rows of numbers are the same to the last bit, signs of zeros included.

    >>> same_bits([0.0], [-0.0])
    False
    """
    return struct.pack(f"{len(a)}d", *a) == struct.pack(f"{len(b)}d", *b)


def same_values(a: Sequence[float], b: Sequence[float]) -> bool:
    """Tell whether two rows are the same to the last bit, but for the signs of zeros.

    CasADi makes a choice by adding a zero, and so loses the sign of another.

    >>> same_values([0.0], [-0.0]), same_values([1.0], [1.0000000000000002])
    (True, False)
    """
    return same_bits([x + 0.0 for x in a], [x + 0.0 for x in b])


def linked_arithmetic(emitted: Emitted) -> Arithmetic:
    """Return the file's arithmetic with the functions that the C is linked with."""
    return arithmetic_of(ctypes.CDLL(str(emitted.shared)), emitted.precision)


def arithmetic_of(loaded: ctypes.CDLL, precision: Precision) -> Arithmetic:
    """Return the arithmetic of a precision with the functions of a loaded library."""
    dtype, functions = precision.dtype, precision.functions
    linked = {name: _linked(loaded, functions[name], dtype) for name in sorted(LIBM | TURNS)}
    turns = {name: partial(of_turns, name, far=linked[name]) for name in sorted(TURNS)}
    return {**working(dtype), **linked, **turns}


def _linked(loaded: ctypes.CDLL, symbol: str, dtype: type) -> Callable[..., Any]:
    def each(*given: Any) -> Any:
        function = loaded[symbol]
        function.restype = ctypes.c_double if dtype is np.float64 else ctypes.c_float
        function.argtypes = [function.restype] * len(given)
        several = np.broadcast_arrays(*given)
        flat = zip(*(np.ravel(x) for x in several), strict=True)
        results = [function(*(float(v) for v in values)) for values in flat]
        return np.array(results, dtype).reshape(several[0].shape)

    return each


def replay(emitted: Emitted, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether the C of every function gives the bits of its program."""
    uses_libm = any(kind in LIBM | TURNS for f in emitted.library.printed() for kind in f.count)
    own = linked_arithmetic(emitted) if uses_libm else working(emitted.precision.dtype)
    expected = replayed(emitted.library, each, emitted.precision, own)
    for program in emitted.library.printed():
        rows = np.array([np.broadcast_to(r, len(each)) for r in expected[program.name]]).T
        worst = [
            s.number
            for s, row in zip(each, rows.tolist(), strict=True)
            if not same_bits(row, emitted.results(program, s))
        ]
        says = f"{len(each)} samples" if not worst else f"{len(worst)} differ, first {worst[0]}"
        yield verdict(emitted, program.name, "bits of the program", JUDGED[not worst], says)


def accuracy(
    emitted: Emitted, each: Sequence[Sample], few: Sequence[Sample], printed: Mapping[str, Any]
) -> Iterator[Verdict]:
    """Yield whether the C is as close as promised to the reference, motions to their formulas.

    few : those at which the functions of motion are tried
    """
    library = emitted.library
    of = Sampled(library, emitted.precision)
    lectured = ((program, each, true) for program, true in should(of, library.functions, each))
    moving = ((program, few, should_move(of, program, few)) for program in library.motions)
    for program, own, true in chain(lectured, moving):
        for found in errors_of(emitted, program, own, true):
            yield _accurate(emitted, program, found, own, printed.get(program.name, {}))


def _accurate(
    emitted: Emitted,
    program: Program,
    found: Errors,
    each: Sequence[Sample],
    printed: Mapping[str, Any],
) -> Verdict:
    each_worst = found.largest()
    most = largest(each_worst)
    middle = median([error for row in found.rows for error in row] or [0.0])
    sample = each[each_worst.index(most)]
    stated = _stated(printed, emitted, found.output, "largest_ulp")
    usual = _stated(printed, emitted, found.output, "median_ulp") or 0.0
    allowed = min(ABSURD, LARGEST_BOUND if stated is None else MORE * max(1.0, stated))
    half = max(MEDIAN_BOUND, USUAL * usual)
    half = half if program in emitted.library.functions else allowed
    holds = middle <= half and most <= allowed
    says = (
        f"{found.output}: median {middle:.2g} u, largest {most:.2g} u at sample {sample.number} "
        f"({sample.kind}), the worst of {len(each)} tried; the header as made says "
    )
    says += "nothing" if stated is None else f"{stated:.2g} u"
    says += "" if holds else f"; allowed {half:.2g} u and {allowed:.2g} u"
    check_ = "error" if program in emitted.library.functions else "rounding"
    return verdict(emitted, program.name, check_, JUDGED[holds], says)


def _stated(printed: Mapping[str, Any], emitted: Emitted, output: str, figure: str) -> float | None:
    """Return a figure that the header and the JSON state of an error, None if they state none."""
    stated = printed.get(emitted.precision.name, {}).get(output)
    return float(stated[figure]) if stated else None


def casadi_bits(emitted: Emitted, module: Any, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether CasADi's functions give the bits of double C, from parameters on."""
    library = emitted.library
    for program in [library.setup] * bool(library.constants) + list(library.printed()):
        if program.unrolled is not None:
            says = "the C has loops and rounds elsewhere; CasADi's is the unrolled step"
            yield verdict(emitted, program.name, "CasADi's bits", "skipped", says)
            continue
        whole = getattr(module, program.name)()
        from_constants = any(q.role == "constants" for q in program.inputs)
        hot = getattr(module, f"{program.name}_hot")() if from_constants else None
        differ = []
        for s in each:
            found = [from_parameters(module, whole, program, s)]
            found += [_from_constants(emitted, hot, program, s)] if hot else []
            ours = emitted.results(program, s)
            if not all(same_values([x for own in outputs for x in own], ours) for outputs in found):
                differ.append(s.number)
        says = _differing(differ, each)
        yield verdict(emitted, program.name, "CasADi's bits", JUDGED[not differ], says)
        yield from _same_patterns(emitted, program, whole)


def _differing(differ: Sequence[int], each: Sequence[Sample]) -> str:
    return f"{len(differ)} differ, first {differ[0]}" if differ else f"{len(each)} samples"


def _from_constants(
    emitted: Emitted, hot: Any, program: Program, sample: Sample
) -> list[list[float]]:
    given = inputs(program, sample, emitted.constants(sample))
    return [y.nonzeros() for y in hot.call([casadi.DM(v) for v in given.values()])]


def _same_patterns(emitted: Emitted, program: Program, function: Any) -> Iterator[Verdict]:
    for name, pattern in (program.sparsity or {}).items():
        own = function.sparsity_out(name)
        shape = (len(pattern.rows), len(pattern.columns))
        same = (own.shape, list(own.colind()), list(own.row())) == (
            shape,
            list(pattern.colind),
            list(pattern.row),
        )
        says = f"{name}: {own.nnz()} nonzeros of {shape[0]} x {shape[1]}"
        yield verdict(emitted, program.name, "sparsity", JUDGED[same], says)


def aliasing(emitted: Emitted, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether outputs written over inputs, Jacobians apart, are those written elsewhere."""
    for program in emitted.library.printed():
        function = emitted.functions[program.name]
        given = [inputs(program, s, emitted.constants(s)) for s in each]
        pairs = [
            (o.name, i.name)
            for o in function.arguments
            for i in function.arguments
            if o.output and o.name != MATRIX and i.kind == "array" and not i.output
        ]
        if not pairs:
            says = "no output and input are arrays that could share their place"
            yield verdict(emitted, program.name, "outputs over inputs", "skipped", says)
            continue
        bad = [
            f"{o} over {i}"
            for o, i in pairs
            if any(not _same_over(function, values, o, i) for values in given)
        ]
        says = f"{len(pairs)} pairs" if not bad else f"{', '.join(bad)} changes the result"
        yield verdict(emitted, program.name, "outputs over inputs", JUDGED[not bad], says)


def _same_over(function: Any, values: Mapping[str, Any], output: str, over: str) -> bool:
    apart, joint = function(values), function.over(values, output, over)
    return all(same_bits(apart[name], joint[name]) for name in apart)


def dense_agrees(emitted: Emitted, each: Sequence[Sample]) -> Iterator[Verdict]:
    """Yield whether the whole matrices hold the nonzeros in their places, and zeros elsewhere."""
    for program in emitted.library.printed():
        for name, pattern in (program.sparsity or {}).items():
            bad = [s.number for s in each if not _same_matrix(emitted, program, name, s)]
            says = _differing(bad, each) + f", {len(pattern.rows)} x {len(pattern.columns)}"
            yield verdict(emitted, program.name, "whole matrix", JUDGED[not bad], says)


def _same_matrix(emitted: Emitted, program: Program, name: str, sample: Sample) -> bool:
    given = inputs(program, sample, emitted.constants(sample))
    sparse = emitted.functions[program.name](given)[name]
    whole = emitted.functions[f"{program.name}_dense"](given)[name]
    pattern = (program.sparsity or {})[name]
    expected = [0.0] * len(whole)
    for (row, column), x in zip(pattern.places(), sparse, strict=True):
        expected[column * len(pattern.rows) + row] = x
    return same_bits(expected, whole)
