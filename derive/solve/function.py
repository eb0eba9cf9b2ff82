"""A scene's function for NumPy arrays: one sample, or a batch along leading axes."""

from collections import namedtuple
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import prod
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from derive.program.program import Program, Quantity, Sparsity
from derive.program.status import SAYS, refusal
from derive.scene import SceneError
from derive.scene.escape import at_place
from derive.scene.unit import behind
from derive.solve.arguments import named_values, real, shape_text, spread
from derive.solve.compiled import Buffers, Refused

DENSE = "_dense"
"""Ends the name of a function that returns its whole Jacobian, here and in C."""
NAMED: Any = namedtuple  # whose names mypy wants to read
KEPT_TYPES = 1024
"""Types of results that are kept: so many functions may be called in turn, or pickled."""


class Kernel(Protocol):
    """What evaluates a function: compiled C, or CasADi."""

    @property
    def by(self) -> str:
        """Return what it is evaluated by."""

    @property
    def dtype(self) -> type:
        """Return the float type that it takes and gives."""

    def prepared(self, parameters: Sequence[float]) -> Any:
        """Return the constants that set-up makes of parameters, or Refused."""

    def __call__(
        self,
        count: int,
        given: Buffers,
        steps: Sequence[int],
        found: Buffers,
        made: Any,
    ) -> Refused | None:
        """Fill ``found`` with the results for ``count`` members."""


@dataclass(frozen=True, repr=False, eq=False)
class SceneFunction:
    """A function of a scene, called with arrays: inputs in order or by name, parameters by name.

    Every input has the shape that ``print(function)`` shows, or that shape behind leading axes;
    leading axes of inputs and parameters are broadcast as NumPy does, and results have them too.
    One result is returned as an array, several as a named tuple. Of a function ``..._jacobian``
    the result ``jacobian`` holds the nonzeros that ``sparsity`` places; ``..._jacobian_dense``
    returns the whole matrix, (..., rows, columns). What is not finite in an input goes through.

    Raises DeriveError for inputs that are missing, unknown, of a wrong shape or no real numbers,
    and for parameters that set-up refuses.

    fixed : parameters that are given already       made : their constants, if those are all
    again : makes the same function of what is fixed; it goes to another process so
    """

    scene: str
    name: str
    program: Program
    setup: Program
    kernel: Kernel
    inputs: tuple[Quantity, ...]
    parameters: tuple[Quantity, ...]
    fixed: Mapping[str, float]
    made: Any
    again: Callable[..., Any]

    def __reduce__(self) -> Any:
        """Return how another process makes the same function: it reads the scene and compiles."""
        return self.again, (dict(self.fixed),)

    def __call__(self, *given: ArrayLike, **named: ArrayLike) -> Any:
        """Return the result, an array, or a named tuple of several.

        given : inputs, in order                  named : further inputs, and parameters
        """
        label, quantities, dtype = self._label, self._read, self._dtype
        values: Sequence[Any] = given
        if named or len(given) != len(self.inputs) or len(quantities) != len(self.inputs):
            own = named_values(label, self.inputs, self._asked, given, named)
            own |= self.fixed
            values = [own[q.name] for q in quantities]
        arrays = [real(label, q.name, q.shape, v, dtype)
                  for q, v in zip(quantities, values, strict=True)]  # fmt: skip
        lead: tuple[int, ...] = ()
        steps, count = self._still, 1
        if [a.ndim for a in arrays] != self._ranks:
            lead, arrays, steps = spread(label, quantities, arrays)
            count = prod(lead)
        found: list[NDArray[Any]] = [np.empty(lead + q.shape, dtype) for q in self.program.outputs]
        if count and (refused := self.kernel(count, arrays, steps, found, self.made)):
            raise SceneError(self._refusal(refused, lead, arrays, steps))
        if self._dense is not None:
            found[-1] = _matrix(self._dense, found[-1])
        results = [x if x.ndim else x[()] for x in found]
        return results[0] if len(results) == 1 else self._several(*results)

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """Return what a call gives, in order."""
        return self.program.outputs

    @property
    def sparsity(self) -> Sparsity | None:
        """Return where the nonzeros of ``jacobian`` stand, by compressed columns; None without."""
        return next(iter((self.program.sparsity or {}).values()), None)

    def __repr__(self) -> str:
        """Return what it is given and gives, with shapes, units and meanings."""
        own = "double" if self.kernel.dtype is np.float64 else "float"
        head = f"{self.name} of scene '{self.scene}', in {own}, by {self.kernel.by}"
        rows = [("input", q) for q in self.inputs]
        rows += [("parameter", q) for q in self._asked]
        rows += [("result", q) for q in self.outputs]
        wide = max(len(q.name) for _, q in rows)
        lines = [
            f"  {what:9} {q.name:{wide}} {self._shape(q):6}{behind(q.unit)}  {q.meaning}".rstrip()
            for what, q in rows
        ]
        set_ = [f"  fixed     {name} = {value:g}" for name, value in self.fixed.items()]
        return "\n".join([head, f"  {self.program.says}", *lines, *set_])

    def _shape(self, q: Quantity) -> str:
        pattern = (self.program.sparsity or {}).get(q.name)
        whole = pattern is not None and self.name.endswith(DENSE)
        return shape_text(pattern.shape if whole and pattern else q.shape)

    @cached_property
    def _dtype(self) -> np.dtype[Any]:
        return np.dtype(self.kernel.dtype)

    @cached_property
    def _dense(self) -> Sparsity | None:
        return self.sparsity if self.name.endswith(DENSE) else None

    @cached_property
    def _label(self) -> str:
        return f"scene '{self.scene}': '{self.name}'"

    @cached_property
    def _read(self) -> tuple[Quantity, ...]:
        return self.inputs if self.made is not None else (*self.inputs, *self.parameters)

    @cached_property
    def _asked(self) -> tuple[Quantity, ...]:
        return tuple(q for q in self.parameters if q.name not in self.fixed)

    @cached_property
    def _ranks(self) -> list[int]:
        return [len(q.shape) for q in self._read]

    @cached_property
    def _still(self) -> list[int]:
        return [0] * len(self._read)

    @cached_property
    def _several(self) -> Callable[..., Any]:
        return result_type(self.name, tuple(q.name for q in self.outputs))

    def _refusal(
        self, refused: Refused, lead: tuple[int, ...], arrays: Buffers, steps: Sequence[int]
    ) -> str:
        first = len(self.inputs)
        at = [refused.member if step else 0 for step in steps[first:]]
        values = [float(a.flat[k]) for a, k in zip(arrays[first:], at, strict=True)]
        place = tuple(map(int, np.unravel_index(refused.member, lead))) if lead else ()
        return refused_by(self.scene, self.setup, values, refused.status, place)


@lru_cache(KEPT_TYPES)
def result_type(name: str, fields: tuple[str, ...]) -> Callable[..., Any]:
    """Return the named tuple of several results, which another process makes by its names."""

    def names_and_values(found: tuple[Any, ...]) -> Any:
        return several_results, (name, fields, tuple(found))

    made: type[Any] = NAMED(name, fields)
    setattr(made, "__reduce__", names_and_values)  # noqa: B010 - of a type that is made here
    return made


def several_results(name: str, fields: tuple[str, ...], values: tuple[Any, ...]) -> Any:
    """Return several results by their names, as a call gives them."""
    return result_type(name, fields)(*values)


def _matrix(pattern: Sparsity, nonzeros: NDArray[Any]) -> NDArray[Any]:
    """Return whole matrices, (..., rows, columns), of their nonzeros."""
    whole = np.zeros(
        (*nonzeros.shape[:-1], len(pattern.rows), len(pattern.columns)), nonzeros.dtype
    )
    rows, columns = np.array(pattern.places()).T
    whole[..., rows, columns] = nonzeros
    return whole


def refused_by(
    scene: str, setup: Program, values: Sequence[float], status: int, place: tuple[int, ...] = ()
) -> str:
    """Return the sentence on parameters that set-up refuses, of a member of a batch or of all."""
    at = at_place(dict(zip([q.name for q in setup.inputs], values, strict=True)))
    in_float = f"{SAYS[status]}{at} (status {status})"
    member = f" in member {place if len(place) > 1 else place[0]}" if place else ""
    return f"scene '{scene}': {refusal(setup, values) or in_float}{member}"
