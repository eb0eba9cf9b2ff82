"""What moves members, as it travels: C as source, compiled where it arrives, once by its content.

Where no compiler is, CasADi runs the scene's own file over all members: slower, the same bits.
"""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from types import ModuleType
from typing import Any, Protocol

import casadi
import numpy as np
from numpy.typing import NDArray

from derive.check.compiler import HOW_TO_GET_ONE, CompilerError, callable_library, find_compiler
from derive.emit.c.batch import is_prepared
from derive.emit.c.members import IN_COMMON
from derive.emit.c.members_file import VECTOR_OPTIONS, members_files
from derive.emit.c.source import c_files
from derive.emit.casadi_module import imported
from derive.emit.casadi_text import casadi_file
from derive.library.library import Library
from derive.program.precision import F64
from derive.program.program import component_names
from derive.program.status import statuses
from derive.solve.members import ByMember, MembersCompiled, shared_members

KITS = 4
"""Kits that a worker keeps ready, those that it used last."""
COMPILING = Lock()
"""Of the threads of a worker, which would else compile the same at once."""


class ByMembers(Protocol):
    """Functions of a scene over members, whatever runs them."""

    def setup(self, parameters: ByMember) -> tuple[ByMember, NDArray[np.int32]]:
        """Return the constants of every member and what set-up says of each."""

    def call(
        self,
        function: str,
        constants: ByMember | None,
        given: Mapping[str, ByMember | float],
        found: Sequence[ByMember],
        members: int,
    ) -> Callable[[float], None]:
        """Return a call that takes the length of a step and fills ``found``."""


@dataclass(frozen=True)
class Kit:
    """The programs that a sweep calls, and their texts in C and for CasADi."""

    library: Library
    texts: Mapping[str, str]
    module: str

    @property
    def content(self) -> str:
        """Return a digest of all texts."""
        every = "\0".join((*(f"{n}\0{t}" for n, t in sorted(self.texts.items())), self.module))
        return hashlib.sha256(every.encode()).hexdigest()


def kit_of(library: Library, names: Sequence[str]) -> Kit:
    """Return what some functions of a scene need to be called anywhere."""
    alone = replace(
        library,
        functions=tuple(p for p in library.functions if p.name in names),
        motions=tuple(p for p in library.motions if p.name in names),
    )
    texts = c_files(alone, ()) | members_files(alone, ())
    own = {name: text for name, text in texts.items() if f"_{F64.name}" in name}
    return Kit(alone, own, casadi_file(alone))


@dataclass(frozen=True)
class Ready:
    """A kit at work, and by what: the compiler's name, or CasADi."""

    functions: ByMembers
    by: str


def ready(kit: Kit) -> Ready:
    """Return a kit compiled, or left to CasADi where there is no compiler.

    Raises CompilerError with what a compiler says against it.
    """
    with COMPILING:
        return _ready(_ByContent(kit))


class _ByContent:
    """A kit that equals another of the same texts."""

    def __init__(self, kit: Kit) -> None:
        self.kit, self.content = kit, kit.content

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _ByContent) and self.content == other.content

    def __hash__(self) -> int:
        return hash(self.content)


@lru_cache(KITS)
def _ready(of: _ByContent) -> Ready:
    kit = of.kit
    with TemporaryDirectory(prefix="derive-", ignore_cleanup_errors=True) as folder:
        try:
            compiler = find_compiler()
        except CompilerError as error:
            if str(error) != HOW_TO_GET_ONE:
                raise
            name = f"{kit.library.scene.name}_{kit.content[:8]}_casadi"
            return Ready(ByCasadi(kit.library, imported(name, kit.module, Path(folder))), "CasADi")
        made = shared_members(kit.texts, Path(folder), compiler, VECTOR_OPTIONS)
        return Ready(MembersCompiled(kit.library, F64, callable_library(made)), compiler.name)


@dataclass(frozen=True)
class ByCasadi:
    """A scene's functions over members, by its CasADi file; each is built once."""

    library: Library
    module: ModuleType
    built: dict[str, Any] = field(default_factory=dict)

    def setup(self, parameters: ByMember) -> tuple[ByMember, NDArray[np.int32]]:
        """Return the constants of every member, (constants, members), and what set-up says."""
        program = self.library.setup
        status = statuses(program, list(parameters), F64.dtype).astype(np.int32)
        made = self.module.setup()(casadi.DM(parameters)) if component_names(program) else None
        shape = (len(component_names(program)), parameters.shape[1])
        return (np.zeros(shape) if made is None else np.array(made.full())), status

    def call(
        self,
        function: str,
        constants: ByMember | None,
        given: Mapping[str, ByMember | float],
        found: Sequence[ByMember],
        members: int,
    ) -> Callable[[float], None]:
        """Return a call that takes the length of a step and fills ``found``."""
        program = self.library[function]
        builder = f"{function}_hot" if is_prepared(program) else function
        if builder not in self.built:
            self.built[builder] = getattr(self.module, builder)()
        called = self.built[builder]

        def column(name: str, role: str, length: float) -> Any:
            if role == "constants":
                own = np.asarray(constants)
                return casadi.DM(own if own.ndim == 1 else own[:, :members])
            if name in IN_COMMON:
                return casadi.DM(length)
            return casadi.DM(np.asarray(given[name])[:, :members])

        def made(length: float) -> None:
            results = called.call([column(q.name, q.role, length) for q in program.inputs])
            for place, result in zip(found, results, strict=True):
                place[:, :members] = result.full()

        return made
