"""A scene's function by its name: looked for, compiled or left to CasADi, parameters fixed."""

from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, Literal

from numpy.typing import ArrayLike

from derive.check.compiler import HOW_TO_GET_ONE, CompilerError, find_compiler
from derive.emit.c.batch import is_prepared, own_inputs
from derive.library.library import Library
from derive.program.precision import F32, F64
from derive.program.program import Program
from derive.scene import SceneError
from derive.scene.table import nearest, one_of, shown
from derive.solve.arguments import by_name, one_number
from derive.solve.compiled import Refused, compiled_function
from derive.solve.function import DENSE, Kernel, SceneFunction, refused_by
from derive.solve.interpreted import interpreted_function
from derive.solve.replayed import replayed_function
from derive.solve.told import met

By = Literal["any", "compiler", "casadi"]
"""What evaluates a function: a C compiler's code and, where there is none, CasADi; or one alone."""
Accuracy = Literal["double", "float"]
"""The float type of a function."""
PRECISION = {"double": F64, "float": F32}


def program_of(library: Library, name: object) -> Program:
    """Return the program of a wanted function, its whole Jacobian's being the same.

    Raises SceneError for a name that the scene does not want.
    """
    programs = {p.name: p for p in library.printed()}
    programs |= {f"{p.name}{DENSE}": p for p in library.printed() if p.sparsity}
    if not isinstance(name, str) or name not in programs:
        hint = nearest(name, programs) if isinstance(name, str) else ""
        raise SceneError(f"scene '{library.scene.name}' has no function {met(name)}{hint}")
    return programs[name]


def evaluation(scene: str, precision: object, by: object) -> tuple[str, str]:
    """Return a float type and what is to evaluate. Raises SceneError for words that are none."""
    return (
        one_of(precision, f"scene '{scene}': precision", PRECISION),
        one_of(by, f"scene '{scene}': by", ("any", "compiler", "casadi")),
    )


def kernel_of(
    library: Library,
    program: Program,
    module: Callable[[], ModuleType],
    name: str,
    precision: str,
    by: str,
) -> Kernel:
    """Return what evaluates a function.

    module : returns the scene's CasADi file, if it is needed
    Raises CompilerError if a compiler is needed and there is none, or if it refuses the C.
    """
    of, scene = PRECISION[precision], library.scene.name
    if by != "casadi":
        try:
            return compiled_function(library, program, of, find_compiler())
        except CompilerError as error:
            if by == "compiler" or str(error) != HOW_TO_GET_ONE:
                raise CompilerError(f"scene '{scene}': {error}") from None
    if of is F64 and program.unrolled is None:
        return interpreted_function(library, program, module())
    if by == "casadi":
        what = f"'{name}' in float" if of is not F64 else f"'{name}', whose loops it unrolls"
        mend = 'by = "any" takes what does'
        raise SceneError(f"scene '{scene}': CasADi does not give the bits of {what}; {mend}")
    return replayed_function(library, program, of)


def bound(
    library: Library,
    program: Program,
    name: str,
    kernel: Kernel,
    values: Mapping[str, ArrayLike],
    again: Callable[..., SceneFunction],
) -> SceneFunction:
    """Return a function whose parameters have the values that are given.

    again : makes the same function of such values in another process
    """
    setup, scene = library.setup, library.scene.name
    label = f"scene '{scene}': '{name}'"
    parameters = setup.inputs if is_prepared(program) else ()
    known = {q.name: q for q in parameters}
    for given in (values := by_name(label, values)):
        if given not in known:
            raise SceneError(f"{label} has no parameter {shown(given)}{nearest(given, known)}")
    fixed = {n: one_number(label, n, x, kernel.dtype) for n, x in values.items()}
    made: Any = None
    if parameters and fixed.keys() == known.keys():
        made = kernel.prepared([fixed[n] for n in known])
        if isinstance(made, Refused):
            raise SceneError(refused_by(scene, setup, [fixed[n] for n in known], made.status))
    return SceneFunction(
        scene, name, program, setup, kernel, own_inputs(program), parameters, fixed, made, again
    )
