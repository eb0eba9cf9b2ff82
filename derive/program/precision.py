"""The two precisions that programs are emitted and measured in."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from derive.program.arithmetic import OPERATORS


@dataclass(frozen=True)
class Precision:
    """A C scalar type with the names and the suffixes that go with it."""

    name: str
    scalar: str
    dtype: type
    suffix: str
    digits: int
    bits: int
    functions: Mapping[str, str]

    @property
    def unit_roundoff(self) -> float:
        """Return u, half the distance from one to the next float."""
        return 2.0**-self.bits


# The functions of <math.h> by operator; in float each takes an f at its end.
MATH = {name: row.libc for name, row in OPERATORS.items() if row.libc}


F64 = Precision("f64", "double", np.float64, "", 17, 53, MATH)


F32 = Precision(
    "f32", "float", np.float32, "F", 9, 24, {name: f"{symbol}f" for name, symbol in MATH.items()}
)


PRECISIONS = (F32, F64)
