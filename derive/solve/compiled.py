"""A scene's function as compiled C, called for whole arrays: no value is copied on its way.

The C is what ``derive generate`` writes, alone in a folder that is gone before the first call: no
library can be out of date, and no two processes can meet in one.
"""

from collections.abc import Mapping, Sequence
from ctypes import byref, c_int, c_ssize_t, c_void_p
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import local
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.check.compiler import Compiler, callable_library, compiled
from derive.emit.c.batch import batch_file, batch_symbol, is_prepared, own_inputs
from derive.emit.c.signature import CNames
from derive.emit.c.source import c_files
from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Program, component_names

Buffers = Sequence[NDArray[Any]]


@dataclass(frozen=True)
class Refused:
    """What set-up says of parameters, and the number of the member whose parameters they are."""

    status: int
    member: int


@dataclass(frozen=True)
class Slot:
    """Memory for one member, and the addresses of its inputs and results as C takes them.

    A single call is copied into it and out of it: quicker than to ask arrays for addresses.
    """

    given: list[NDArray[Any]]
    found: list[NDArray[Any]]
    at: Any
    to: Any
    steps: Any


@dataclass(frozen=True)
class Compiled:
    """A loaded function: its loop, and the set-up that makes its constants, if it reads any.

    constants    : how many set-up makes
    given, found : shapes of inputs, with all parameters behind them, and of results
    shared       : the loaded library, which must live as long as its functions
    places       : memory for single calls, of each thread its own
    """

    by: str
    dtype: type
    loop: Any
    setup: Any
    constants: int
    given: tuple[tuple[int, ...], ...]
    found: tuple[tuple[int, ...], ...]
    shared: Any
    places: local = field(default_factory=local)

    def prepared(self, parameters: Sequence[float]) -> Any:
        """Return the constants that set-up makes of parameters, or Refused."""
        made = (np.ctypeslib.as_ctypes_type(self.dtype) * self.constants)()
        status = int(self.setup(*parameters, made))
        return Refused(status, 0) if status else made

    def __call__(
        self, count: int, given: Buffers, steps: Sequence[int], found: Buffers, made: Any
    ) -> Refused | None:
        """Fill ``found`` with the results for ``count`` members.

        given : (count * step,) of each input, contiguous; one member's values if its step is 0
        made  : constants; without them parameters follow the other inputs
        """
        if count > 1:
            at, to = _addresses(given), _addresses(found)
            return self._looped(count, at, (c_ssize_t * len(given))(*steps), to, made)
        place = self._place(len(given))
        for own, value in zip(place.given, given, strict=True):
            own[...] = value
        refused = self._looped(1, place.at, place.steps, place.to, made)
        for value, own in zip(found, place.found, strict=True):
            value[...] = own
        return refused

    def _looped(self, count: int, at: Any, steps: Any, to: Any, made: Any) -> Refused | None:
        member = c_ssize_t()
        status = self.loop(count, at, steps, to, made, byref(member))
        return Refused(status, member.value) if status else None

    def _place(self, count: int) -> Slot:
        """Return this thread's memory for a call with so many inputs, parameters among them."""
        kept = self.places.__dict__
        if str(count) not in kept:
            given: list[NDArray[Any]] = [np.empty(s, self.dtype) for s in self.given[:count]]
            found: list[NDArray[Any]] = [np.empty(s, self.dtype) for s in self.found]
            steps = (c_ssize_t * count)()
            kept[str(count)] = Slot(given, found, _addresses(given), _addresses(found), steps)
        place: Slot = kept[str(count)]
        return place


def _addresses(arrays: Buffers) -> Any:
    return (c_void_p * len(arrays))(*[a.ctypes.data for a in arrays])


def compiled_function(
    library: Library, program: Program, precision: Precision, with_: Compiler
) -> Compiled:
    """Return one function of a scene, compiled with set-up and nothing else.

    Raises CompilerError with what the compiler says against it.
    """
    alone = _alone(library, program)
    loops, text = batch_file(alone, precision)
    texts = c_files(alone, ()) | {loops: text}
    with TemporaryDirectory(prefix="derive-", ignore_cleanup_errors=True) as folder:
        shared = callable_library(compiled(_of(precision, texts), loops, Path(folder), with_))
    loop = shared[batch_symbol(library, program.name, precision)]
    loop.restype = c_int
    loop.argtypes = [c_ssize_t, *[c_void_p] * 5]
    given = [q.shape for q in (*own_inputs(program), *library.setup.inputs)]
    found = [q.shape for q in program.outputs]
    setup = _setup(library, shared, precision) if is_prepared(program) else None
    count = len(component_names(library.setup))
    return Compiled(
        with_.name, precision.dtype, loop, setup, count, tuple(given), tuple(found), shared
    )


def _alone(library: Library, program: Program) -> Library:
    """Return a library of one function: what else there is would only be compiled with it."""
    functions = tuple(p for p in library.functions if p is program)
    return replace(
        library, functions=functions, motions=tuple(p for p in library.motions if p is program)
    )


def _of(precision: Precision, texts: Mapping[str, str]) -> dict[str, str]:
    return {name: text for name, text in texts.items() if f"_{precision.name}" in name}


def _setup(library: Library, shared: Any, precision: Precision) -> Any:
    setup = shared[CNames(library.scene.name).symbol("setup", precision)]
    scalar = np.ctypeslib.as_ctypes_type(precision.dtype)
    setup.argtypes = [*[scalar] * len(library.setup.inputs), c_void_p]
    setup.restype = c_int
    return setup
