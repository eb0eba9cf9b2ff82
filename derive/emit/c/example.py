"""A few lines of C that use a scene's first function, for the head of its header."""

from fractions import Fraction

from derive.emit.c.aside import is_put_aside
from derive.emit.c.signature import CNames
from derive.emit.operators import literal
from derive.library.library import Library
from derive.program.precision import Precision
from derive.program.program import Quantity


def example(library: Library, names: CNames, precision: Precision) -> list[str]:
    """Return a few lines of C that use the first function."""
    program = library.printed()[0]
    lines = []
    if any(q.role == "constants" for q in program.inputs) and not library.fixed:
        given = [literal(_middle(q), precision) for q in library.setup.inputs]
        call = f"{names.symbol('setup', precision)}({', '.join([*given, '&constants'])})"
        lines.append(f"{names.scene}_constants_{precision.name} constants;")
        lines.append(f"if ({call} != 0) {{ return 1; }}")
    arrays = [q for q in program.inputs if q.shape and q.role != "constants"]
    if arrays:
        lines.append(
            " ".join(
                f"{precision.scalar} {variable(q)}[{len(q.components)}] = {_values(q, precision)};"
                for q in arrays
            )
        )
    outputs = [variable(q) + (f"[{len(q.components)}]" if q.shape else "") for q in program.outputs]
    lines.append(f"{precision.scalar} {', '.join(outputs)};")
    constants = f"{names.scene}_fixed_{precision.name}" if library.fixed else "constants"
    passed = [_passed(q, precision, constants) for q in program.inputs]
    passed += [variable(q) if q.shape else f"&{variable(q)}" for q in program.outputs]
    lines.append(f"{names.symbol(program.name, precision)}({', '.join(passed)});")
    return lines


def variable(q: Quantity) -> str:
    """Return what a user's file calls a quantity: nothing that is a macro there."""
    return f"own_{q.name}" if is_put_aside(q.name) else q.name


def _middle(q: Quantity) -> Fraction:
    return ((q.low or Fraction(0)) + (q.high or Fraction(0))) / 2


def _values(q: Quantity, precision: Precision) -> str:
    first = literal(Fraction(1), precision)
    rest = [literal(Fraction(0), precision)] * (len(q.components) - 1)
    return "{" + ", ".join([first, *rest]) + "}"


def _passed(q: Quantity, precision: Precision, constants: str) -> str:
    if q.role == "constants":
        return f"&{constants}"
    return variable(q) if q.shape else literal(_middle(q), precision)
