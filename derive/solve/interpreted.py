"""A scene's function as CasADi runs it, where no C compiler is: slower, and of the same bits."""

from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from derive.emit.c.batch import is_prepared, own_inputs
from derive.library.library import Library
from derive.program.precision import F64
from derive.program.program import Program
from derive.program.status import RIGHT, statuses
from derive.solve.compiled import Buffers, Refused


@dataclass(frozen=True)
class Interpreted:
    """A function of a scene's CasADi file, and its set-up, if it reads any constants.

    of_parameters, of_constants : the same function, of either      makes : parameters -> constants
    """

    by: str
    dtype: type
    program: Program
    tried: Program
    of_parameters: Any
    of_constants: Any
    makes: Any

    def prepared(self, parameters: Sequence[float]) -> NDArray[Any] | Refused:
        """Return the constants that set-up makes of parameters."""
        status = int(statuses(self.tried, [np.array([x]) for x in parameters], F64.dtype)[0])
        made: NDArray[Any] = np.array(self.makes(casadi.DM(parameters))).ravel()
        return made if status == RIGHT else Refused(status, 0)

    def __call__(
        self,
        count: int,
        given: Buffers,
        steps: Sequence[int],
        found: Buffers,
        made: NDArray[Any] | None,
    ) -> Refused | None:
        """Fill ``found`` with the results for ``count`` members, as compiled C does."""
        columns = [a.reshape(count if n else 1, -1).T for a, n in zip(given, steps, strict=True)]
        size = len(own_inputs(self.program))
        own, parameters = columns[:size], columns[size:]
        if parameters and (refused := self._refused(parameters)):
            return refused
        function = self.of_parameters if made is None else self.of_constants
        results = function.call([casadi.DM(x) for x in (*self._first(parameters, made), *own)])
        sparse = self.program.sparsity or {}
        for q, result, place in zip(self.program.outputs, results, found, strict=True):
            values = np.array(result.nonzeros() if q.name in sparse else result.full().T)
            rows = place.reshape(count, -1)
            rows[:] = values.reshape(-1, rows.shape[1])
        return None

    def _first(self, parameters: Buffers, made: NDArray[Any] | None) -> Buffers:
        """Return constants, or parameters, even none, from which they are made; or nothing."""
        if made is not None:
            return [made]
        if not is_prepared(self.program):
            return []
        return [np.vstack(np.broadcast_arrays(*parameters)) if parameters else np.empty((0, 1))]

    def _refused(self, parameters: Buffers) -> Refused | None:
        columns = [p.ravel() for p in np.broadcast_arrays(*parameters)]
        found = statuses(self.tried, columns, F64.dtype)
        wrong = np.flatnonzero(found)
        return Refused(int(found[wrong[0]]), int(wrong[0])) if wrong.size else None


def interpreted_function(library: Library, program: Program, module: ModuleType) -> Interpreted:
    """Return one function of a scene's CasADi file."""
    prepared = is_prepared(program)
    return Interpreted(
        "CasADi",
        F64.dtype,
        program,
        library.setup,
        getattr(module, program.name)(),
        getattr(module, f"{program.name}_hot")() if prepared else None,
        module.setup() if prepared else None,
    )
