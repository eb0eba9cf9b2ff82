"""Emitted C called from Python, by what the scene's JSON says and nothing else."""

import ctypes
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from derive.check.compiler import callable_library

SCALARS = {"f32": ctypes.c_float, "f64": ctypes.c_double}


@dataclass(frozen=True)
class Argument:
    """One argument of a C function: a scalar by value, or so many scalars behind a pointer."""

    name: str
    kind: str  # "scalar" | "array" | "struct" | "pointer"
    length: int
    output: bool


@dataclass(frozen=True)
class CFunction:
    """A loaded C function with its arguments in order; all outputs come last."""

    name: str
    scalar: Any
    symbol: Any
    arguments: tuple[Argument, ...]
    returns_status: bool

    def __call__(self, given: Mapping[str, Sequence[float]]) -> dict[str, list[float]]:
        """Return the outputs by name, from inputs by name; every value a list of components."""
        return self.called({a.name: self._memory(a, given) for a in self.arguments})

    def over(
        self, given: Mapping[str, Sequence[float]], output: str, over: str
    ) -> dict[str, list[float]]:
        """Return the outputs where ``output`` is written over the input ``over``."""
        memory = {a.name: self._memory(a, given) for a in self.arguments}
        larger = max(len(memory[output]), len(memory[over]))
        joint = (self.scalar * larger)(*memory[over])
        return self.called(memory | {output: joint, over: joint})

    def called(self, memory: Mapping[str, Any]) -> dict[str, list[float]]:
        """Call the function with the memory of each argument; return that of the outputs."""
        passed = [
            memory[a.name][0] if a.kind == "scalar" else memory[a.name] for a in self.arguments
        ]
        status = self.symbol(*passed)
        found = {a.name: list(memory[a.name])[: a.length] for a in self.arguments if a.output}
        return found | ({"status": [float(status)]} if self.returns_status else {})

    def _memory(self, argument: Argument, given: Mapping[str, Sequence[float]]) -> Any:
        array = self.scalar * argument.length
        return array() if argument.output else array(*given[argument.name])


def c_functions(manifest: Mapping[str, Any], library: Path, precision: str) -> dict[str, CFunction]:
    """Return the functions that a manifest describes, from a compiled library."""
    shared = callable_library(library)
    return {f["name"]: _function(f, shared, precision) for f in manifest["functions"]}


def _function(described: Mapping[str, Any], loaded: Any, precision: str) -> CFunction:
    scalar = SCALARS[precision]
    arguments = tuple(
        Argument(
            a["name"],
            a["type"],
            len(a["components"]) or math.prod(a["shape"]),
            a["direction"] == "out",
        )
        for a in described["arguments"]
    )
    symbol = loaded[described["symbols"][precision]]
    symbol.argtypes = [scalar if a.kind == "scalar" else ctypes.POINTER(scalar) for a in arguments]
    status = described["returns"].startswith("int")
    symbol.restype = ctypes.c_int if status else None
    return CFunction(described["name"], scalar, symbol, arguments, status)
