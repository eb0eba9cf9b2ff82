"""A scene as something to read numbers from: its emitted CasADi functions, called by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

import casadi

from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import Library, library
from derive.program.program import Program, Quantity
from derive.program.status import refusal
from derive.scene import SceneError, load
from derive.scene.machine import Tensor
from derive.scene.numbers import member_doubts

LATEST = 64
"""Sets of parameters whose constants are kept: those that were asked for last."""


@dataclass(frozen=True)
class Instrument:
    """A scene's programs and the CasADi functions that were printed from them."""

    library: Library
    module: ModuleType
    built: dict[str, Any] = field(default_factory=dict, compare=False)
    """The functions that were asked for, each made once."""

    @property
    def name(self) -> str:
        """Return the scene's name."""
        return self.library.scene.name

    def quantities(self) -> tuple[Quantity, ...]:
        """Return everything that may be set."""
        return self.library.vocabulary.given()

    def needed(self, function: str) -> tuple[str, ...]:
        """Return the components that a function changes with."""
        if function in self.library.problems:
            return self.library.mechanism.depends_on(function)
        program = self.library[function]
        own = [c for q in program.inputs if q.role != "constants" for c in q.components]
        return (*(c for q in self.library.setup.inputs for c in q.components), *own)

    def answer(self, function: str, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the components of a function's results; a value may be a number or CasADi's SX.

        Raises SceneError if something that the function needs is not given.
        """
        program = self.library[function]
        missing = [c for c in self.needed(function) if c not in given]
        if missing:
            raise SceneError(f"scene '{self.name}': '{function}' needs {', '.join(missing)}")
        self.require_admissible(given)
        found = self._called(program, given)
        return dict(zip([c for q in program.outputs for c in q.components], found, strict=True))

    def require_admissible(self, given: Mapping[str, Any]) -> None:
        """Raise SceneError for parameters that set-up refuses; symbols are not tried."""
        values = self._parameters(given)
        if all(isinstance(x, int | float) for x in values) and (why := self._refusal(values)):
            raise SceneError(f"scene '{self.name}': {why}")

    def doubts(self, given: Mapping[str, Any]) -> tuple[str, ...]:
        """Return warnings about parameters that set-up takes: inertias that no masses can have."""
        scene = self.library.scene
        pinned = tuple(
            replace(p, low=Fraction(x), high=Fraction(x))
            if isinstance(x := given.get(p.name), int | float) and p.value is None
            else replace(p, low=(p.low + p.high) / 2, high=(p.low + p.high) / 2)
            for p in scene.parameters
        )
        tensors = [d for d in scene.demands if isinstance(d, Tensor)]
        each = ((d.label.split(" inertia")[0], d.whole) for d in tensors)
        found = tuple(says for label, own in each for says in member_doubts(label, own, pinned))
        told = [p.name for p in scene.parameters if p.value is None]
        linear = "linearised" in self.library.problems
        whole = linear and {*told, *self.needed("linearised")} <= given.keys()
        own = {n: x for n, x in given.items() if n not in scene.about or scene.about[n].name == n}
        return (*found, *self.library.mechanism.doubts_at(own)) if whole else found

    @cached_property
    def _refusal(self) -> Callable[[tuple[float, ...]], str]:
        return lru_cache(LATEST)(partial(refusal, self.library.setup))

    @cached_property
    def _constants(self) -> Callable[[tuple[float, ...]], Any]:
        return lru_cache(LATEST)(self._constants_of)

    def _constants_of(self, parameters: tuple[Any, ...]) -> Any:
        return self._made("setup")(casadi.vertcat(*parameters))

    def _made(self, builder: str) -> Any:
        """Return a function of the scene's CasADi file, built once."""
        if builder not in self.built:
            self.built[builder] = getattr(self.module, builder)()
        return self.built[builder]

    def _parameters(self, given: Mapping[str, Any]) -> tuple[Any, ...]:
        return tuple(self._value(q, q.name, given) for q in self.library.setup.inputs)

    def _called(self, program: Program, given: Mapping[str, Any]) -> list[Any]:
        arguments = [self._column(q, given) for q in program.inputs if q.role != "constants"]
        prepared = len(arguments) < len(program.inputs)
        if prepared:
            values = self._parameters(given)
            known = all(isinstance(x, int | float) for x in values)
            make = self._constants if known else self._constants_of
            arguments.insert(0, make(values))
        function = self._made(f"{program.name}_hot" if prepared else program.name)
        results = function.call(arguments)
        sparse = program.sparsity or {}
        found = [
            x
            for q, r in zip(program.outputs, results, strict=True)
            for x in (r.nonzeros() if q.name in sparse else casadi.vertsplit(r))
        ]
        numbers = all(isinstance(r, casadi.DM) for r in results)
        return [float(x) for x in found] if numbers else found

    def _column(self, q: Quantity, given: Mapping[str, Any]) -> Any:
        return casadi.vertcat(*(self._value(q, c, given) for c in q.components))

    def _value(self, q: Quantity, component: str, given: Mapping[str, Any]) -> Any:
        """Return a value; what does not matter to the function but stands beside it, in range."""
        middle = float(((q.low or 0) + (q.high or 0)) / 2)
        return given.get(component, middle)


def opened(source: str) -> Instrument:
    """Return the instrument of a catalogue name or of a file."""
    return instrument(library(load(source)))


def instrument(made: Library) -> Instrument:
    """Return the instrument of a scene's programs."""
    name = f"{made.scene.name}_casadi"
    with TemporaryDirectory(prefix="derive-") as folder:
        return Instrument(made, imported(name, casadi_file(made), Path(folder)))
