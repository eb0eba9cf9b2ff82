"""The C that calls a scene's functions over and over, for arrays of other languages.

It includes the scene's own source, so that the compiler sees both; no scene's files hold it.
"""

from math import prod

from derive.emit.c.signature import CNames
from derive.emit.templates import TEMPLATES
from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Program, Quantity


def batch_symbol(library: Library, function: str, precision: Precision) -> str:
    """Return the C symbol that calls a function over and over."""
    return f"{CNames(library.scene.name).symbol(function, precision)}_batch"


def is_prepared(program: Program) -> bool:
    """Tell whether a function reads constants, which set-up makes of parameters."""
    return any(q.role == "constants" for q in program.inputs)


def own_inputs(program: Program) -> tuple[Quantity, ...]:
    """Return what a function is given beside the constants."""
    return tuple(q for q in program.inputs if q.role != "constants")


def batch_file(library: Library, precision: Precision) -> tuple[str, str]:
    """Return name and text of a C file that includes the scene's, with a loop a function.

    A loop is given an address and a step, 0 for one value for all, of each of the function's own
    inputs and then of each parameter; with constants already ``made`` it reads no parameters. It
    returns 0, or what set-up says of the parameters of ``member``, where it stops.
    """
    names = CNames(library.scene.name)
    text = TEMPLATES.get_template("batch.c.jinja").render(
        source=names.file(precision, "c"),
        scalar=precision.scalar,
        struct=f"{names.scene}_constants_{precision.name}",
        setup=names.symbol("setup", precision),
        functions=[_loop(library, program, precision) for program in library.printed()],
    )
    return f"{names.scene}_{precision.name}_batch.c", text


def _loop(library: Library, program: Program, precision: Precision) -> dict[str, object]:
    own = own_inputs(program)
    parameters = library.setup.inputs if is_prepared(program) else ()
    read = [_read(q, place) for place, q in enumerate((*own, *parameters))]
    found = [f"found[{j}] + k * {prod(q.shape)}" for j, q in enumerate(program.outputs)]
    return {
        "name": batch_symbol(library, program.name, precision),
        "symbol": CNames(library.scene.name).symbol(program.name, precision),
        "prepared": is_prepared(program),
        "arguments": [*read[: len(own)], *found],
        "prepares": [*read[len(own) :], "&own"],
        "varies": [f"step[{len(own) + place}] != 0" for place in range(len(parameters))],
    }


def _read(q: Quantity, place: int) -> str:
    at = f"k * step[{place}]"
    return f"given[{place}] + {at}" if q.shape else f"given[{place}][{at}]"
