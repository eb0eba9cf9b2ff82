"""Names that headers of boards may have as macros, which generated C puts aside for itself.

A name of a scene stands in a struct and in prototypes, after whatever its user includes: Arduino.h
brings all registers of a board (SP, PB0), others call bits of a status register C or N, and
<complex.h> has I. All these are written in capitals, or begin with two.
"""

import re
from collections.abc import Iterable

from derive.program.program import Program

_LIKE_A_MACRO = re.compile(r"[A-Z][A-Z]\w*|[^a-z]+")


def is_put_aside(name: str) -> bool:
    """Tell whether a name looks like a macro.

    >>> [name for name in ("I", "TIM1", "ADC_vect", "I_xx", "m") if is_put_aside(name)]
    ['I', 'TIM1', 'ADC_vect']
    """
    return _LIKE_A_MACRO.fullmatch(name) is not None


def put_aside(programs: Iterable[Program]) -> list[str]:
    """Return the names like macros in declarations of functions and in the struct of constants."""
    return sorted({name for program in programs for name in _declared(program)
                   if is_put_aside(name)})  # fmt: skip


def _declared(program: Program) -> set[str]:
    every = (*program.inputs, *program.outputs)
    members = {c for q in every if q.role == "constants" for c in q.components}
    return members | {q.name for q in every}
