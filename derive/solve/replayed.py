"""A scene's function as NumPy runs its program, where no C compiler is and CasADi rounds otherwise.

So it does in float, and in steps whose loops it unrolls. Every operation is one of IEEE, on columns
with a row a member; sines and their like are taken from the platform's library, as C takes them.
"""

import ctypes
from collections.abc import Sequence
from ctypes.util import find_library
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.check.agreement import arithmetic_of
from derive.emit.c.batch import own_inputs
from derive.library.library import Library
from derive.program.arithmetic import extended, paired
from derive.program.precision import Precision
from derive.program.program import Program
from derive.program.run import run
from derive.program.status import statuses
from derive.scene.formula import Arithmetic
from derive.solve.compiled import Buffers, Refused


@dataclass(frozen=True)
class Replayed:
    """A program of a scene, its set-up, and the arithmetic that both run in."""

    by: str
    dtype: type
    program: Program
    setup: Program
    arithmetic: Arithmetic

    def prepared(self, parameters: Sequence[float]) -> Any:
        """Return the constants that set-up makes of parameters, or Refused."""
        columns: Buffers = [np.array([x], self.dtype) for x in parameters]
        return self._refused(columns) or self._constants(columns)

    def __call__(
        self, count: int, given: Buffers, steps: Sequence[int], found: Buffers, made: Any
    ) -> Refused | None:
        """Fill ``found`` with the results for ``count`` members, as compiled C does."""
        rows = [a.reshape(count if n else 1, -1) for a, n in zip(given, steps, strict=True)]
        size = len(own_inputs(self.program))
        parameters = [own.ravel() for own in rows[size:]]
        if parameters:
            if refused := self._refused(parameters):
                return refused
            made = self._constants(parameters)
        values = [*(made or ()), *(column for own in rows[:size] for column in own.T)]
        results = iter(self._run(self.program, [np.broadcast_to(x, count) for x in values]))
        for place in found:
            for column in place.reshape(count, -1).T:
                column[:] = next(results)
        return None

    def _refused(self, parameters: Buffers) -> Refused | None:
        found = statuses(self.setup, list(np.broadcast_arrays(*parameters)), self.dtype)
        wrong = np.flatnonzero(found)
        return Refused(int(found[wrong[0]]), int(wrong[0])) if wrong.size else None

    def _constants(self, parameters: Buffers) -> list[NDArray[Any]]:
        whole = list(np.broadcast_arrays(*parameters))
        pairs = run(self.setup, extended(self.dtype), paired(np.array(whole)))
        return [np.asarray(high, self.dtype) for high, _ in pairs]

    def _run(self, program: Program, values: Buffers) -> list[Any]:
        if program.arithmetic != "pairs":
            return run(program, self.arithmetic, values)
        return [high for high, _ in run(program, extended(self.dtype), paired(np.array(values)))]


def replayed_function(library: Library, program: Program, precision: Precision) -> Replayed:
    """Return one function of a scene, as its program."""
    platform = ctypes.CDLL(find_library("m"))
    arithmetic = arithmetic_of(platform, precision)
    return Replayed("NumPy", precision.dtype, program, library.setup, arithmetic)
