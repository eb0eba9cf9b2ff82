"""Functions as their C computes them, with no C: programs replayed in doubles."""

from dataclasses import dataclass, replace

import numpy as np

from derive.library.library import Library
from derive.program.arithmetic import working
from derive.program.precision import F64, Precision
from derive.program.program import Program
from derive.verify.measure import replayed
from derive.verify.sample import Sample


@dataclass(frozen=True)
class Replayed:
    """A scene, and the functions that are emitted for it: its own, or a mutant's."""

    library: Library
    emitted: Library
    precision: Precision = F64

    def results(self, program: Program, sample: Sample) -> list[float]:
        """Return all components that a function gives at a sample."""
        emitted = replace(self.emitted, motions=())
        found = replayed(emitted, [sample], F64, working(np.float64))[program.name]
        return [float(np.ravel(column)[0]) for column in found]
