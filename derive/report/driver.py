"""The functions of a scene called many times at once: in C where there is a compiler, else NumPy.

Arguments are rows of numbers, a row a sample. A step whose results go where its state lies moves
the state on at every round.
"""

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.check.compiler import Compiler, CompilerError, callable_library, compiled, find_compiler
from derive.emit.c.signature import CNames
from derive.emit.c.source import c_files
from derive.emit.templates import TEMPLATES
from derive.library.library import Library
from derive.motion.runge_kutta.system import NEXT
from derive.program.arithmetic import LIBM, extended, working
from derive.program.precision import Precision
from derive.program.program import Program, Quantity
from derive.scene.formula import Arithmetic
from derive.verify.columns import in_columns, planned
from derive.verify.operators import IN_DOUBLES

Storage = dict[str, NDArray[Any]]
"""Numbers by the name of a quantity: (samples, components), of the precision at hand."""
WITHOUT = "no compiler"


@dataclass(frozen=True)
class Driver:
    """A scene's functions in one precision.

    shared : the compiled library, None where NumPy runs the programs instead
    path   : where it lies
    """

    library: Library
    precision: Precision
    shared: Any
    path: Path = Path()

    def call(self, program: Program, at: Storage, into: Storage, rounds: int = 1) -> None:
        """Call a function at every row of its inputs, ``rounds`` times; results go ``into``."""
        if self.shared is None:
            for _ in range(rounds):
                _in_numpy(program, self.precision, at, into)
            return
        every = [*(at[q.name] for q in program.inputs), *(into[q.name] for q in program.outputs)]
        places = (ctypes.c_void_p * len(every))(*(x.ctypes.data for x in every))
        apart = [x.shape[1] if x.shape[0] > 1 else 0 for x in every]
        count = max(x.shape[0] for x in every)
        loop = self.shared[f"{self.library.scene.name}_loop_{program.name}"]
        loop(places, (ctypes.c_long * len(every))(*apart), ctypes.c_long(count),
             ctypes.c_long(rounds))  # fmt: skip

    def room(self, program: Program, count: int) -> Storage:
        """Return rows for what a function gives."""
        dtype = self.precision.dtype
        return {q.name: np.zeros((count, len(q.components)), dtype) for q in program.outputs}

    def over(self, program: Program, at: Storage) -> Storage:
        """Return rows for what a step gives, its new state over the old one."""
        count = max(x.shape[0] for x in at.values())
        own = {q.name: at.get(q.name.removesuffix(NEXT)) for q in program.outputs}
        rest = self.room(program, count)
        return {name: rest[name] if x is None else x for name, x in own.items()}

    def with_constants(self, at: Storage) -> Storage:
        """Return inputs with the constants that set-up makes of their parameters."""
        setup = self.library.setup
        if not self.library.constants:
            return at
        count = max([1, *(at[q.name].shape[0] for q in setup.inputs)])
        made = self.room(setup, count)
        self.call(setup, at, made)
        return at | made


def _in_numpy(program: Program, precision: Precision, at: Storage, into: Storage) -> None:
    wide = program.makes("constants") or program.arithmetic == "pairs"
    by = extended(precision.dtype) if wide else _of_platform(precision.dtype)
    own = {c: at[q.name][:, k] for q in program.inputs for k, c in enumerate(q.components)}
    given: Mapping[str, Any] = {c: (x, x * 0) for c, x in own.items()} if wide else own
    found = iter([x[0] if wide else x for x in in_columns(planned(program), by, given)])
    results = [(q, [next(found) for _ in q.components]) for q in program.outputs]
    for q, each in results:
        for k, x in enumerate(each):
            into[q.name][:, k] = x


@cache
def _of_platform(dtype: type) -> Arithmetic:
    """Return floats with NumPy's own sines: a motion's error is far above what they leave."""

    def rounded_to(name: str) -> Any:
        return lambda *given: IN_DOUBLES[name](*given).astype(dtype)

    own = working(dtype)
    return {**own, "number": cache(own["number"]), **{name: rounded_to(name) for name in LIBM}}


def drivers(library: Library, precisions: tuple[Precision, ...], folder: Path) -> list[Driver]:
    """Return a scene's functions in each precision, compiled if there is a compiler."""
    try:
        with_ = find_compiler()
    except CompilerError:
        return [Driver(library, precision, None) for precision in precisions]
    return [_compiled(library, p, folder, with_) for p in precisions]


def _compiled(library: Library, precision: Precision, folder: Path, with_: Compiler) -> Driver:
    scene = library.scene.name
    text = TEMPLATES.get_template("report_loops.c.jinja").render(
        scene=scene,
        source=CNames(scene).file(precision, "c"),
        scalar=precision.scalar,
        functions=[_loop(p, CNames(scene), precision) for p in library.emitted()],
    )
    texts = c_files(library, ()) | {f"{scene}_loops.c": text}
    path = compiled(texts, f"{scene}_loops.c", folder, with_)
    shared = callable_library(path)
    for p in library.emitted():
        shared[f"{scene}_loop_{p.name}"].restype = None
    return Driver(library, precision, shared, path)


def _loop(program: Program, names: CNames, precision: Precision) -> dict[str, Any]:
    """Return what the template needs to call a function in a loop."""
    struct = f"{names.scene}_constants_{precision.name}"
    given = [_argument(q, f"const {struct if q.role == 'constants' else precision.scalar}")
             for q in program.inputs]  # fmt: skip
    made = [(f"{struct if q.role == 'constants' else precision.scalar} *", "")
            for q in program.outputs]  # fmt: skip
    return {
        "name": program.name,
        "symbol": names.symbol(program.name, precision),
        "result": "int" if program.makes("constants") else "void",
        "arguments": [*given, *made],
    }


def _argument(q: Quantity, kind: str) -> tuple[str, str]:
    """Return the type of an input, and what takes its value from where it lies."""
    if q.shape or q.role == "constants":
        return f"{kind} *", ""
    return kind.removeprefix("const "), "*"
