"""What a scene's C functions are called and given: symbols, prototypes, files."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import prod

from derive.program.precision import Precision
from derive.program.program import MATRIX, Operand, Program, Quantity

WIDTH = 100


@dataclass(frozen=True)
class CNames:
    """What a scene's files and symbols are called."""

    scene: str

    def symbol(self, function: str, precision: Precision) -> str:
        """Return the C symbol of a function."""
        return f"{self.scene}_{function}_{precision.name}"

    def file(self, precision: Precision, ending: str) -> str:
        """Return the name of a C file."""
        return f"{self.scene}_{precision.name}.{ending}"


def parameters(program: Program, scene: str, precision: Precision) -> list[str]:
    """Return the declared parameters of a function, inputs first, in call order."""
    given = [_parameter(q, scene, precision, "const ", "") for q in program.inputs]
    return [*given, *(_parameter(q, scene, precision, "", "*") for q in program.outputs)]


def _parameter(q: Quantity, scene: str, precision: Precision, const: str, pointer: str) -> str:
    if q.role == "constants":
        return f"{const}{scene}_constants_{precision.name} *constants"
    if q.shape:
        return f"{const}{precision.scalar} {q.name}[{prod(q.shape)}]"
    return f"{precision.scalar} {pointer}{q.name}"


def prototype(program: Program, names: CNames, precision: Precision) -> str:
    """Return the declaration of a function without its semicolon."""
    result = "int" if program.makes("constants") else "void"
    arguments = parameters(program, names.scene, precision) or ["void"]
    return declaration(f"{result} {names.symbol(program.name, precision)}", arguments)


def declaration(name: str, arguments: Sequence[str]) -> str:
    """Return ``name(arguments)``, broken after commas where the line would be too long."""
    lines = [f"{name}({arguments[0]}"]
    for argument in arguments[1:]:
        if len(lines[-1]) + len(argument) + 3 > WIDTH:
            lines[-1] += ","
            lines.append(f"    {argument}")
        else:
            lines[-1] += f", {argument}"
    return "\n".join(lines) + ")"


def dense(program: Program) -> Program:
    """Return the dense convenience: the same operations, with the whole matrix last."""
    pattern = next(iter((program.sparsity or {}).values()))
    size = len(pattern.rows) * len(pattern.columns)
    says = "the whole Jacobian, column by column, each in its own unit"
    names = tuple(f"{MATRIX}_{k}" for k in range(size))
    whole = Quantity(MATRIX, names, (size,), "", "", None, None, says)
    first = len(program.results) - len(pattern.row)
    entries: list[Operand] = [Fraction(0)] * size
    for (row, column), value in zip(pattern.places(), program.results[first:], strict=True):
        entries[column * len(pattern.rows) + row] = value
    outputs, results = (*program.outputs[:-1], whole), (*program.results[:first], *entries)
    name = f"{program.name}_dense"
    return replace(program, name=name, outputs=outputs, results=results, sparsity=None)


def dense_size(program: Program) -> int:
    """Return the number of entries of a function's whole Jacobian."""
    return dense(program).outputs[-1].shape[0]
