"""A scene's functions over many members, compiled and called: an array of components a quantity."""

from collections.abc import Callable, Mapping, Sequence
from ctypes import c_int, c_ssize_t, c_void_p
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derive.check.compiler import Compiler, answer_of, callable_library
from derive.emit.c.batch import is_prepared
from derive.emit.c.members import IN_COMMON, Sets, members_symbol
from derive.emit.c.members_file import OVER_MEMBERS, VECTOR_OPTIONS, members_files
from derive.emit.c.source import c_files
from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Program, component_names

ByMember = NDArray[Any]
ALWAYS = ("-std=c99", "-fPIC", "-shared", "-w")


class NoLibraryError(RuntimeError):
    """A compiler that made nothing, and did not say why."""


@dataclass(frozen=True)
class MembersCompiled:
    """A scene's functions over members, loaded."""

    library: Library
    precision: Precision
    shared: Any
    symbols: dict[str, Any] = field(default_factory=dict)

    def setup(self, parameters: ByMember) -> tuple[ByMember, NDArray[np.int32]]:
        """Return the constants of every member, (constants, members), and what set-up says.

        parameters : (parameters, members), in set-up's order
        """
        program, members = self.library.setup, parameters.shape[1]
        made: ByMember = np.zeros((len(component_names(program)), members), self.precision.dtype)
        status = np.zeros(members, np.int32)
        rows: ByMember = np.ascontiguousarray(parameters, self.precision.dtype)
        call = self._symbol("setup")
        call.restype = c_ssize_t
        call(c_ssize_t(members), c_ssize_t(members),
             *(_at(row) for row in rows), _at(made), _at(status))  # fmt: skip
        return made, status

    def __call__(
        self,
        function: str,
        constants: ByMember | None,
        given: Mapping[str, ByMember | float],
        found: Sequence[ByMember],
        members: int,
    ) -> None:
        """Fill ``found`` with what a function gives for so many members.

        constants    : (constants, stride), or (constants,) that all have in common
        given, found : (components, stride) of each quantity, one stride for all; results may lie
                       over inputs
        """
        length = given.get(IN_COMMON[0], 0.0)
        self.call(function, constants, given, found, members)(float(length))

    def call(
        self,
        function: str,
        constants: ByMember | None,
        given: Mapping[str, ByMember | float],
        found: Sequence[ByMember],
        members: int,
    ) -> Callable[[float], None]:
        """Return a call that is ready to be made many times: it takes the length of a step alone.

        What it is given must live as long as it does.
        """
        program = self.library[function]
        stride = next(a.shape[-1] for a in (*found, *given.values()) if isinstance(a, np.ndarray))
        arguments: list[Any] = [c_ssize_t(members), c_ssize_t(stride)]
        scalar = np.ctypeslib.as_ctypes_type(self.precision.dtype)
        common: list[Any] = []
        for q in program.inputs:
            if q.role == "constants":
                arguments.append(_at(constants))
            elif q.name in IN_COMMON:
                common.append(scalar())
                arguments.append(common[-1])
            else:
                arguments.append(_at(given[q.name]))
        arguments += map(_at, found)
        each = is_prepared(program) and constants is not None and constants.ndim > 1
        symbol = self._symbol(function, "each" if each else "shared")

        def made(seconds: float) -> None:
            for one in common:
                one.value = seconds
            symbol(*arguments)

        return made

    def results(self, program: Program, members: int) -> list[ByMember]:
        """Return memory for the results of a function."""
        return [np.zeros((len(q.components), members), self.precision.dtype)
                for q in program.outputs]  # fmt: skip

    def _symbol(self, function: str, sets: Sets = "shared") -> Any:
        name = members_symbol(self.library.scene.name, function, self.precision, sets)
        if name not in self.symbols:
            self.symbols[name] = self.shared[name]
            self.symbols[name].restype = c_int if function == "setup" else None
        return self.symbols[name]


def _at(array: Any) -> Any:
    return c_void_p(array.ctypes.data)


def members_compiled(
    library: Library,
    precision: Precision,
    with_: Compiler,
    options: Sequence[str] = VECTOR_OPTIONS,
) -> MembersCompiled:
    """Return a scene's functions over members, compiled beside its own.

    Raises CompilerError with what the compiler says against it.
    """
    texts = c_files(library, ()) | members_files(library, ())
    own = {name: text for name, text in texts.items() if f"_{precision.name}" in name}
    with TemporaryDirectory(prefix="derive-", ignore_cleanup_errors=True) as folder:
        made = shared_members(own, Path(folder), with_, options)
        return MembersCompiled(library, precision, callable_library(made))


def shared_members(
    texts: Mapping[str, str], folder: Path, with_: Compiler, options: Sequence[str]
) -> Path:
    """Return a shared library of C files, written to a folder first."""
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    sources = sorted(name for name in texts if name.endswith(".c"))
    answer_of(
        (*with_.command, *ALWAYS, *options, *sources, "-o", f"{OVER_MEMBERS}.so", "-lm"), folder
    )
    if not (folder / f"{OVER_MEMBERS}.so").exists():
        raise NoLibraryError("the compiler made no library, and did not say why")
    return folder / f"{OVER_MEMBERS}.so"
