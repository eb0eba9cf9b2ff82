"""The constants of fixed parameters as C: a table in the place of set-up."""

from fractions import Fraction
from math import copysign

from derive.emit.operators import literal
from derive.library.fixed import fixed_constants
from derive.library.library import Library
from derive.program.precision import Precision


def fixed_symbol(library: Library, precision: Precision) -> str:
    """Return what C calls the constants of fixed parameters, "" where none are."""
    return f"{library.scene.name}_fixed_{precision.name}" if library.fixed else ""


def fixed_definition(library: Library, precision: Precision) -> str:
    """Return the definition of the constants of fixed parameters, "" where none are."""
    if not library.fixed:
        return ""
    rows = (
        f"    {_signed(x, precision)}, /* {name} */"
        for name, x in fixed_constants(library, precision).items()
    )
    kind = f"const {library.scene.name}_constants_{precision.name}"
    return "\n".join([f"{kind} {fixed_symbol(library, precision)} = {{", *rows, "};"])


def _signed(x: float, precision: Precision) -> str:
    zero = literal(Fraction(0), precision)
    return f"(-{zero})" if x == 0 and copysign(1, x) < 0 else literal(Fraction(x), precision)
